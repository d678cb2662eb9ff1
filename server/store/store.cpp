#include "server/store/store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "protocols/web/names.hpp"
#include "server/store/schema.hpp"

namespace server {
namespace {

using protocols::web::channel_named;
using protocols::web::name_of;
using protocols::web::request_state_named;

constexpr int application_id = 0x446F6365;  // "Doce": other programs' files are not overwritten

void bind_text_or_null(SQLite::Statement& statement, int index, const std::string& text) {
  if (text.empty()) {
    statement.bind(index);
  } else {
    statement.bind(index, text);
  }
}

// Columns as in `request_columns`.
constexpr const char* request_columns =
    "SELECT id, name, channel, session, exhibit, viewpoint, x, y, theta, tour, state, reason, asked FROM request ";

StoredRequest read_request(SQLite::Statement& row) {
  StoredRequest stored;
  robot::Request& request = stored.request;
  request.id = static_cast<robot::RequestId>(row.getColumn(0).getInt64());
  request.requester.name = row.getColumn(1).getString();
  request.requester.channel = channel_named(row.getColumn(2).getString()).value_or(robot::Channel::web);
  request.requester.session = row.getColumn(3).getString();
  if (row.getColumn(4).isNull()) {
    robot::PointTarget point{{row.getColumn(6).getDouble(), row.getColumn(7).getDouble()}, std::nullopt};
    if (!row.getColumn(8).isNull()) point.theta = row.getColumn(8).getDouble();
    request.target = point;
  } else {
    robot::ExhibitTarget target{row.getColumn(4).getString(), std::nullopt};
    if (!row.getColumn(5).isNull()) target.viewpoint = row.getColumn(5).getInt();
    request.target = target;
  }
  request.tour = row.getColumn(9).getString();
  request.state = request_state_named(row.getColumn(10).getString()).value_or(robot::RequestState::failed);
  request.reason = row.getColumn(11).getString();
  stored.asked = row.getColumn(12).getDouble();
  return stored;
}

std::vector<StoredRequest> read_requests(SQLite::Statement& rows) {
  std::vector<StoredRequest> requests;
  while (rows.executeStep()) requests.push_back(read_request(rows));
  return requests;
}

bool is_sound(SQLite::Database& database) {
  SQLite::Statement check(database, "PRAGMA quick_check(1)");
  return check.executeStep() && check.getColumn(0).getString() == "ok";
}

// Moves the file and its log out of the way; gives the new name.
std::string set_aside(const std::string& path, WallSeconds now) {
  std::string aside = path + ".damaged-" + std::to_string(static_cast<long long>(now));
  for (const char* suffix : {"", "-wal", "-shm"}) {
    std::error_code ignored;
    std::filesystem::rename(path + suffix, aside + suffix, ignored);
  }
  return aside;
}

bool means_damage(const SQLite::Exception& error) {
  constexpr int corrupt = 11, not_a_database = 26;  // SQLITE_CORRUPT, SQLITE_NOTADB
  return error.getErrorCode() == corrupt || error.getErrorCode() == not_a_database;
}

}  // namespace

bool means_disk_trouble(const std::exception& error) {
  const auto* sqlite = dynamic_cast<const SQLite::Exception*>(&error);
  if (!sqlite) return false;
  switch (sqlite->getErrorCode()) {
    case 5:
    case 6:
    case 7:
    case 8:
    case 10:
    case 13:
    case 14:
      return true;  // BUSY LOCKED NOMEM READONLY IOERR FULL CANTOPEN
    default:
      return false;
  }
}

Store::Store(const std::string& path, WallSeconds now) {
  if (path != ":memory:" && std::filesystem::path(path).has_parent_path()) {
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  }
  try {
    open(path, now);
    return;
  } catch (const SQLite::Exception& error) {
    if (!means_damage(error)) throw std::runtime_error("database " + path + ": " + error.what());
    notice_ = "database " + path + " is damaged (" + error.what() + "): ";
  }
  database_.reset();
  notice_ += "it was set aside as " + set_aside(path, now) + " and a new one begun";
  open(path, now);
}

Store::~Store() = default;

void Store::open(const std::string& path, WallSeconds now) {
  database_ = std::make_unique<SQLite::Database>(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, 2000);
  if (path != ":memory:" && !is_sound(*database_)) throw SQLite::Exception("quick_check found errors", 11);
  database_->exec("PRAGMA journal_mode = WAL");
  database_->exec("PRAGMA synchronous = FULL");
  database_->exec("PRAGMA foreign_keys = ON");
  migrate(now);
}

void Store::migrate(WallSeconds now) {
  const int owner = database_->execAndGet("PRAGMA application_id").getInt();
  const int version = database_->execAndGet("PRAGMA user_version").getInt();
  if (owner != 0 && owner != application_id) throw std::runtime_error("database: that file belongs to another program");
  if (version > static_cast<int>(schema_steps.size())) {
    throw std::runtime_error("database: that file was made by a newer Docent (schema " + std::to_string(version) +
                             "); use that one, or name another file");
  }
  for (std::size_t step = static_cast<std::size_t>(version); step < schema_steps.size(); ++step) {
    SQLite::Transaction transaction(*database_);
    database_->exec(schema_steps[step]);
    database_->exec("PRAGMA application_id = " + std::to_string(application_id));
    database_->exec("PRAGMA user_version = " + std::to_string(step + 1));
    if (step == 0) {
      SQLite::Statement begin(*database_, "INSERT INTO total(id, since, distance, seconds) VALUES(1, ?, 0, 0)");
      begin.bind(1, now);
      begin.exec();
    }
    transaction.commit();
  }
}

void Store::transaction(const std::function<void(Store&)>& work) {
  SQLite::Transaction transaction(*database_, SQLite::TransactionBehavior::IMMEDIATE);
  work(*this);
  transaction.commit();
}

void Store::put_request(const robot::Request& request, WallSeconds now) {
  SQLite::Statement put(*database_,
                        "INSERT INTO request(id, name, channel, session, exhibit, viewpoint, x, y, theta, tour, state, "
                        "reason, asked, changed) VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?13,?13) "
                        "ON CONFLICT(id) DO UPDATE SET state = excluded.state, reason = excluded.reason, "
                        "changed = excluded.changed");
  put.bind(1, static_cast<std::int64_t>(request.id));
  put.bind(2, request.requester.name);
  put.bind(3, name_of(request.requester.channel));
  put.bind(4, request.requester.session);
  if (const auto* exhibit = std::get_if<robot::ExhibitTarget>(&request.target)) {
    put.bind(5, exhibit->exhibit);
    if (exhibit->viewpoint) put.bind(6, *exhibit->viewpoint);
  } else if (const auto* point = std::get_if<robot::PointTarget>(&request.target)) {
    put.bind(7, point->point.x);
    put.bind(8, point->point.y);
    if (point->theta) put.bind(9, *point->theta);
  }
  bind_text_or_null(put, 10, request.tour);
  put.bind(11, name_of(request.state));
  bind_text_or_null(put, 12, request.reason);
  put.bind(13, now);
  put.exec();
}

std::vector<StoredRequest> Store::open_requests() {
  SQLite::Statement rows(*database_, std::string(request_columns) + "WHERE state IN ('pending', 'active') ORDER BY id");
  return read_requests(rows);
}

std::vector<StoredRequest> Store::ended_requests(int count) {
  SQLite::Statement rows(
      *database_,
      std::string(request_columns) + "WHERE state NOT IN ('pending', 'active') ORDER BY changed DESC, id DESC LIMIT ?");
  rows.bind(1, count);
  return read_requests(rows);
}

std::optional<StoredRequest> Store::find_request(robot::RequestId id) {
  SQLite::Statement row(*database_, std::string(request_columns) + "WHERE id = ?");
  row.bind(1, static_cast<std::int64_t>(id));
  if (!row.executeStep()) return std::nullopt;
  return read_request(row);
}

robot::RequestId Store::next_request_id() {
  return static_cast<robot::RequestId>(
      database_->execAndGet("SELECT COALESCE(MAX(id), 0) + 1 FROM request").getInt64());
}

void Store::add_visit(const StoredVisit& visit) {
  SQLite::Statement put(*database_, "INSERT INTO visit(exhibit, seconds, complete, ended) VALUES(?, ?, ?, ?)");
  put.bind(1, visit.exhibit);
  put.bind(2, visit.seconds);
  put.bind(3, visit.complete ? 1 : 0);
  put.bind(4, visit.ended);
  put.exec();
}

void Store::add_travel(double metres, double seconds) {
  SQLite::Statement put(*database_, "UPDATE total SET distance = distance + ?, seconds = seconds + ? WHERE id = 1");
  put.bind(1, metres);
  put.bind(2, seconds);
  put.exec();
}

void Store::add_note(const robot::Note& note, WallSeconds now) {
  SQLite::Statement put(*database_, "INSERT INTO note(severity, code, text, noted) VALUES(?, ?, ?, ?)");
  put.bind(1, name_of(note.severity));
  put.bind(2, note.code);
  put.bind(3, note.text);
  put.bind(4, now);
  put.exec();
}

StoredStatistics Store::statistics() {
  StoredStatistics statistics;
  SQLite::Statement total(*database_, "SELECT since, distance, seconds FROM total WHERE id = 1");
  if (total.executeStep()) {
    statistics.since = total.getColumn(0).getDouble();
    statistics.distance = total.getColumn(1).getDouble();
    statistics.seconds = total.getColumn(2).getDouble();
  }
  SQLite::Statement states(*database_, "SELECT state, COUNT(*) FROM request GROUP BY state");
  while (states.executeStep()) {
    const auto count = static_cast<std::uint64_t>(states.getColumn(1).getInt64());
    statistics.requests += count;
    if (states.getColumn(0).getString() == "fulfilled") statistics.fulfilled = count;
    if (states.getColumn(0).getString() == "failed") statistics.failed = count;
  }
  SQLite::Statement exhibits(
      *database_,
      "SELECT exhibit, COUNT(*), SUM(seconds) FROM visit WHERE exhibit <> '' GROUP BY exhibit ORDER BY exhibit");
  while (exhibits.executeStep()) {
    statistics.exhibits.push_back({exhibits.getColumn(0).getString(),
                                   static_cast<std::uint64_t>(exhibits.getColumn(1).getInt64()),
                                   exhibits.getColumn(2).getDouble()});
  }
  return statistics;
}

std::optional<StoredAnswer> Store::find_answer(const std::string& key) {
  SQLite::Statement row(*database_, "SELECT fingerprint, status, body, location FROM answer WHERE key = ?");
  row.bind(1, key);
  if (!row.executeStep()) return std::nullopt;
  return StoredAnswer{row.getColumn(0).getString(), row.getColumn(1).getInt(), row.getColumn(2).getString(),
                      row.getColumn(3).getString()};
}

void Store::put_answer(const std::string& key, const StoredAnswer& answer, WallSeconds now) {
  SQLite::Statement put(
      *database_,
      "INSERT OR REPLACE INTO answer(key, fingerprint, status, body, location, given) VALUES(?, ?, ?, ?, ?, ?)");
  put.bind(1, key);
  put.bind(2, answer.fingerprint);
  put.bind(3, answer.status);
  put.bind(4, answer.body);
  put.bind(5, answer.location);
  put.bind(6, now);
  put.exec();
}

void Store::put_name(const StoredName& name, WallSeconds now) {
  SQLite::Statement put(*database_, "INSERT OR REPLACE INTO session(id, name, seen) VALUES(?, ?, ?)");
  put.bind(1, name.session);
  put.bind(2, name.name);
  put.bind(3, now);
  put.exec();
}

std::vector<StoredName> Store::names(int count) {
  SQLite::Statement rows(*database_, "SELECT id, name FROM session ORDER BY seen DESC LIMIT ?");
  rows.bind(1, count);
  std::vector<StoredName> names;
  while (rows.executeStep()) names.push_back({rows.getColumn(0).getString(), rows.getColumn(1).getString()});
  return names;
}

void Store::tidy(WallSeconds now) {
  constexpr double day = 86400.0;
  const auto forget = [&](const char* sql, double days) {
    SQLite::Statement statement(*database_, sql);
    statement.bind(1, now - days * day);
    statement.exec();
  };
  forget("DELETE FROM answer WHERE given < ?", 1.0);
  forget("DELETE FROM session WHERE seen < ?", 90.0);
  forget("DELETE FROM note WHERE noted < ?", 365.0);
}

}  // namespace server
