// The database's tables, as the steps that lead from an empty file to today's. PRAGMA user_version counts the steps a
// file has taken: never change a step that was released, add one.
#pragma once

#include <array>

namespace server {

inline constexpr std::array<const char*, 1> schema_steps{
    R"sql(
CREATE TABLE request(
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL,
  channel TEXT NOT NULL,
  session TEXT NOT NULL,
  exhibit TEXT, viewpoint INTEGER,       -- either an exhibit
  x REAL, y REAL, theta REAL,            -- or a point of the map, in metres
  tour TEXT,
  state TEXT NOT NULL,
  reason TEXT,
  asked REAL NOT NULL,                   -- seconds since 1970
  changed REAL NOT NULL);
CREATE INDEX request_by_state ON request(state, changed);
CREATE TABLE visit(
  id INTEGER PRIMARY KEY,
  exhibit TEXT NOT NULL,
  seconds REAL NOT NULL,
  complete INTEGER NOT NULL,
  ended REAL NOT NULL);
CREATE INDEX visit_by_exhibit ON visit(exhibit);
CREATE TABLE total(
  id INTEGER PRIMARY KEY CHECK(id = 1),
  since REAL NOT NULL,
  distance REAL NOT NULL,                -- metres
  seconds REAL NOT NULL);                -- of operation
CREATE TABLE answer(
  key TEXT PRIMARY KEY,
  fingerprint TEXT NOT NULL,
  status INTEGER NOT NULL,
  body TEXT NOT NULL,
  location TEXT NOT NULL,
  given REAL NOT NULL);
CREATE TABLE session(
  id TEXT PRIMARY KEY,
  name TEXT NOT NULL,
  seen REAL NOT NULL);
CREATE TABLE note(
  id INTEGER PRIMARY KEY,
  severity TEXT NOT NULL,
  code TEXT NOT NULL,
  text TEXT NOT NULL,
  noted REAL NOT NULL);
)sql"};

}  // namespace server
