// What people asked for and did not get yet: stops in the order of visits. The same exhibit asked by several is one
// stop (RHINO 5.2); a tour's stops keep the tour's order, the others go by least travel from here.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "robot/outputs.hpp"

namespace robot {

struct QueueConfig {
  std::size_t open_limit = 60;    // requests in all
  std::size_t session_limit = 5;  // a person's own, tours not counted (MINERVA 6.3: five pending target points)
  Seconds patience{600};          // a stop asked longer ago than this goes before nearer ones
  double speed = 0.4;             // m/s on average, for the estimated time of arrival
  Seconds dwell{35};              // at each stop, for the same
};

// One place to go, with everybody who wants it.
struct Visit {
  Target target;
  std::vector<RequestId> requests;
  std::uint64_t tour_run = 0;  // 0: no tour
  std::string tour;
  int number = 0;  // of the tour, from 1
  int count = 0;
  Time asked;
  int tries = 0;
};

// Travel in metres from one place to another; infinite where there is no way.
using Travel = std::function<double(const Target& from, const Target& to)>;

class RequestQueue {
 public:
  explicit RequestQueue(QueueConfig config = {}) : config_(config) {}

  void remember(const Remember& memory, Time now);
  RequestId next_id() const { return next_id_; }

  // Why this person may not ask for this now; Refusal::none when they may.
  Refusal room_for(const Requester& requester, std::size_t more) const;
  RequestId add(const Requester& requester, const Target& target, Time now);
  std::vector<RequestId> add_tour(const Requester& requester, const Tour& tour, Time now);
  // Refusal::none, or why not. A cancelled request's stop goes with its last request.
  Refusal cancel(const CancelRequest& wish, bool& visit_is_gone);
  void cancel_tour(std::uint64_t tour_run, const std::string& reason);

  // Order the stops behind the first `fixed` ones: running tour, then the rest by least travel from `here`.
  void reorder(const Target& here, std::uint64_t running_tour, bool keep_first, const Travel& travel, Time now);

  bool empty() const { return visits_.empty(); }
  const std::deque<Visit>& visits() const { return visits_; }
  Visit& front() { return visits_.front(); }
  const Request& request(RequestId id) const { return open_.at(id); }
  bool has(RequestId id) const { return open_.contains(id); }

  void activate_front();
  // Ends all requests of the front stop with this state and removes it.
  void finish_front(RequestState state, const std::string& reason);
  // The front stop goes to the back, to be tried again later.
  void postpone_front();

  // Positions and times of arrival anew, `metres_to_front` away from the first stop.
  void estimate(double metres_to_front, const Travel& travel);

  // Requests whose state, position or estimate changed since the last call, in order of id.
  std::vector<Request> take_changes();

 private:
  void end(RequestId id, RequestState state, const std::string& reason);
  void touch(const Request& request) { changed_[request.id] = request; }

  QueueConfig config_;
  RequestId next_id_ = 1;
  std::uint64_t next_tour_run_ = 1;
  std::map<RequestId, Request> open_;
  std::deque<Visit> visits_;
  std::map<RequestId, Request> changed_;
};

bool same_place(const Target& a, const Target& b);

}  // namespace robot
