// What must survive a crash: accepted requests, visits, how far the robot has driven, names, notes, and answers that
// were given under an Idempotency-Key. SQLite with a write-ahead log, synced at every commit. Blocking: belongs to one
// worker thread. Every function throws std::runtime_error when the disk does not do its part.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "robot/inputs.hpp"
#include "robot/outputs.hpp"

namespace SQLite {
class Database;
}

namespace server {

using WallSeconds = double;  // since 1970, UTC

struct StoredRequest {
  robot::Request request;  // `asked`, position and eta are of an earlier run: not set
  WallSeconds asked = 0.0;
};

struct StoredVisit {
  std::string exhibit;
  double seconds = 0.0;
  bool complete = false;
  WallSeconds ended = 0.0;
};

struct ExhibitVisits {
  std::string exhibit;
  std::uint64_t visits = 0;
  double seconds = 0.0;
};

struct StoredStatistics {
  WallSeconds since = 0.0;
  double distance = 0.0;  // m
  double seconds = 0.0;   // of operation
  std::uint64_t requests = 0;
  std::uint64_t fulfilled = 0;
  std::uint64_t failed = 0;
  std::vector<ExhibitVisits> exhibits;
};

// An answer given under an Idempotency-Key.
struct StoredAnswer {
  std::string fingerprint;  // of what was asked
  int status = 0;
  std::string body;
  std::string location;
};

struct StoredName {
  std::string session;
  std::string name;
};

// Whether an error of the store lies with the disk (full, failing, read-only, locked) and may pass, not with what was
// asked.
bool means_disk_trouble(const std::exception& error);

class Store {
 public:
  // Opens or makes the file (":memory:" for none). A file that is damaged is moved aside and a new one begun; notice()
  // says so. Throws when the place cannot be written, or when the file was made by a newer Docent.
  Store(const std::string& path, WallSeconds now);
  ~Store();

  // What staff should read in the log after opening, or empty.
  const std::string& notice() const { return notice_; }

  // Runs all in one transaction: all or nothing, and on the disk when it returns.
  void transaction(const std::function<void(Store&)>& work);

  void put_request(const robot::Request& request, WallSeconds now);
  // Waiting or active ones, oldest first.
  std::vector<StoredRequest> open_requests();
  // The last that ended, newest first.
  std::vector<StoredRequest> ended_requests(int count);
  std::optional<StoredRequest> find_request(robot::RequestId id);
  robot::RequestId next_request_id();

  void add_visit(const StoredVisit& visit);
  void add_travel(double metres, double seconds);
  void add_note(const robot::Note& note, WallSeconds now);
  StoredStatistics statistics();

  std::optional<StoredAnswer> find_answer(const std::string& key);
  void put_answer(const std::string& key, const StoredAnswer& answer, WallSeconds now);

  void put_name(const StoredName& name, WallSeconds now);
  std::vector<StoredName> names(int count);

  // Forgets what nobody will ask for again: answers after a day, names after 90 days, notes after a year.
  void tidy(WallSeconds now);

 private:
  void open(const std::string& path, WallSeconds now);
  void migrate(WallSeconds now);

  std::unique_ptr<SQLite::Database> database_;
  std::string notice_;
};

}  // namespace server
