#include "robot/tasks/request_queue.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "robot/tasks/visit_order.hpp"

namespace robot {
namespace {

Request make_request(RequestId id, const Requester& requester, const Target& target, Time now) {
  Request request;
  request.id = id;
  request.requester = requester;
  request.target = target;
  request.asked = now;
  return request;
}

}  // namespace

bool same_place(const Target& a, const Target& b) {
  if (const auto* x = std::get_if<ExhibitTarget>(&a), *y = std::get_if<ExhibitTarget>(&b); x && y) {
    return x->exhibit == y->exhibit && (x->viewpoint == y->viewpoint || !x->viewpoint || !y->viewpoint);
  }
  const auto *p = std::get_if<PointTarget>(&a), *q = std::get_if<PointTarget>(&b);
  return p && q && distance(p->point, q->point) < 0.1 && p->theta == q->theta;
}

void RequestQueue::remember(const Remember& memory, Time now) {
  next_id_ = std::max(next_id_, memory.next_id);
  for (const RememberedRequest& old : memory.open) {
    if (open_.contains(old.id)) continue;
    next_id_ = std::max(next_id_, old.id + 1);
    const auto [it, added] = open_.emplace(old.id, make_request(old.id, old.requester, old.target, now));
    touch(it->second);
    const auto stop = std::ranges::find_if(visits_, [&](const Visit& s) { return same_place(s.target, old.target); });
    if (stop != visits_.end()) {
      stop->requests.push_back(old.id);
    } else {
      visits_.push_back({.target = old.target, .requests = {old.id}, .tour = {}, .asked = now});
    }
  }
}

Refusal RequestQueue::room_for(const Requester& requester, std::size_t more) const {
  if (open_.size() + more > config_.open_limit) return Refusal::queue_full;
  const auto own = static_cast<std::size_t>(std::ranges::count_if(open_, [&](const auto& entry) {
    return entry.second.tour.empty() && entry.second.requester.session == requester.session;
  }));
  const bool limited = !requester.session.empty() && more == 1;
  return limited && own >= config_.session_limit ? Refusal::queue_full : Refusal::none;
}

RequestId RequestQueue::add(const Requester& requester, const Target& target, Time now) {
  const RequestId id = next_id_++;
  Request request = make_request(id, requester, target, now);
  const auto stop = std::ranges::find_if(visits_, [&](const Visit& s) { return same_place(s.target, target); });
  if (stop != visits_.end()) {
    const Request& other = open_.at(stop->requests.front());
    request.state = other.state;
    stop->requests.push_back(id);
  } else {
    visits_.push_back({.target = target, .requests = {id}, .tour = {}, .asked = now});
  }
  touch(request);
  open_.emplace(id, std::move(request));
  return id;
}

std::vector<RequestId> RequestQueue::add_tour(const Requester& requester, const Tour& tour, Time now) {
  std::vector<RequestId> ids;
  const std::uint64_t run = next_tour_run_++;
  for (const std::string& exhibit : tour.exhibits) {
    const RequestId id = next_id_++;
    Request request = make_request(id, requester, ExhibitTarget{exhibit, {}}, now);
    request.tour = tour.id;
    Visit stop{.target = request.target, .requests = {id}, .tour_run = run, .tour = tour.id, .asked = now};
    stop.number = static_cast<int>(ids.size()) + 1;
    stop.count = static_cast<int>(tour.exhibits.size());
    // Whoever already waits for this exhibit comes along; an active stop is left as it is.
    const auto same = std::ranges::find_if(visits_, [&](const Visit& s) {
      return s.tour_run == 0 && same_place(s.target, stop.target) &&
             open_.at(s.requests.front()).state == RequestState::pending;
    });
    if (same != visits_.end()) {
      stop.requests.insert(stop.requests.end(), same->requests.begin(), same->requests.end());
      visits_.erase(same);
    }
    visits_.push_back(std::move(stop));
    touch(request);
    open_.emplace(id, std::move(request));
    ids.push_back(id);
  }
  return ids;
}

void RequestQueue::end(RequestId id, RequestState state, const std::string& reason) {
  const auto it = open_.find(id);
  if (it == open_.end()) return;
  it->second.state = state;
  it->second.reason = reason;
  it->second.position = 0;
  it->second.eta_seconds = 0.0;
  touch(it->second);
  open_.erase(it);
}

Refusal RequestQueue::cancel(const CancelRequest& wish, bool& visit_is_gone) {
  visit_is_gone = false;
  const auto it = open_.find(wish.id);
  if (it == open_.end()) return wish.id != 0 && wish.id < next_id_ ? Refusal::already_over : Refusal::unknown_request;
  const bool own = !wish.session.empty() && it->second.requester.session == wish.session;
  if (!own && !wish.staff) return Refusal::not_yours;
  end(wish.id, RequestState::cancelled, wish.staff && !own ? "Cancelled by staff." : "Cancelled by its requester.");
  const auto stop =
      std::ranges::find_if(visits_, [&](const Visit& s) { return std::ranges::count(s.requests, wish.id) > 0; });
  if (stop == visits_.end()) return Refusal::none;
  std::erase(stop->requests, wish.id);
  if (stop->requests.empty()) {
    visit_is_gone = stop == visits_.begin();
    visits_.erase(stop);
  }
  return Refusal::none;
}

void RequestQueue::cancel_tour(std::uint64_t tour_run, const std::string& reason) {
  for (Visit& stop : visits_) {
    if (stop.tour_run != tour_run) continue;
    std::erase_if(stop.requests, [&](RequestId id) {
      const bool of_tour = !open_.at(id).tour.empty();
      if (of_tour) end(id, RequestState::cancelled, reason);
      return of_tour;
    });
    stop.tour_run = 0;
    stop.tour.clear();
    stop.number = stop.count = 0;
  }
  std::erase_if(visits_, [](const Visit& stop) { return stop.requests.empty(); });
}

void RequestQueue::reorder(const Target& here, std::uint64_t running_tour, bool keep_first, const Travel& travel,
                           Time now) {
  std::vector<Visit> first, running, plain, tours;
  for (std::size_t i = 0; i < visits_.size(); ++i) {
    Visit& stop = visits_[i];
    auto& group = keep_first && i == 0            ? first
                  : stop.tour_run == 0            ? plain
                  : stop.tour_run == running_tour ? running
                                                  : tours;
    group.push_back(std::move(stop));
  }
  // Whoever waits longest goes first; a stop that was tried in vain waits behind the fresh ones.
  std::ranges::stable_sort(plain, {}, [](const Visit& s) { return std::pair(s.tries, s.asked); });
  const auto late = std::ranges::partition_point(
      plain, [&](const Visit& s) { return s.tries == 0 && now - s.asked > config_.patience; });
  const auto fresh_end = std::ranges::partition_point(late, plain.end(), [](const Visit& s) { return s.tries == 0; });
  std::vector<Visit> sorted(std::make_move_iterator(plain.begin()), std::make_move_iterator(late));
  const Target from = !sorted.empty()    ? sorted.back().target
                      : !running.empty() ? running.back().target
                      : !first.empty()   ? first.back().target
                                         : here;
  const int count = static_cast<int>(fresh_end - late);
  const auto target = [&](int i) -> const Target& { return i == 0 ? from : (late + (i - 1))->target; };
  for (const int i : visit_order(count, [&](int a, int b) { return travel(target(a), target(b)); })) {
    sorted.push_back(*(late + (i - 1)));
  }
  sorted.insert(sorted.end(), fresh_end, plain.end());

  visits_.clear();
  const auto append = [&](std::vector<Visit>& group) { std::ranges::move(group, std::back_inserter(visits_)); };
  append(first);
  append(running);
  const bool tour_first = !tours.empty() && (sorted.empty() || tours.front().asked < sorted.front().asked);
  append(tour_first ? tours : sorted);
  append(tour_first ? sorted : tours);
}

void RequestQueue::activate_front() {
  for (const RequestId id : visits_.front().requests) {
    Request& request = open_.at(id);
    if (request.state == RequestState::active) continue;
    request.state = RequestState::active;
    touch(request);
  }
}

void RequestQueue::finish_front(RequestState state, const std::string& reason) {
  for (const RequestId id : visits_.front().requests) end(id, state, reason);
  visits_.pop_front();
}

void RequestQueue::postpone_front() {
  Visit stop = std::move(visits_.front());
  visits_.pop_front();
  ++stop.tries;
  for (const RequestId id : stop.requests) {
    open_.at(id).state = RequestState::pending;
    touch(open_.at(id));
  }
  visits_.push_back(std::move(stop));
}

void RequestQueue::estimate(double metres_to_front, const Travel& travel) {
  double metres = metres_to_front, dwell = 0.0;
  for (std::size_t i = 0; i < visits_.size(); ++i) {
    if (i > 0) metres += travel(visits_[i - 1].target, visits_[i].target);
    const double eta = std::isfinite(metres) ? metres / config_.speed + dwell : 0.0;
    for (const RequestId id : visits_[i].requests) {
      Request& request = open_.at(id);
      const int position = static_cast<int>(i) + 1;
      if (request.position == position && std::abs(request.eta_seconds - eta) < 5.0) continue;
      request.position = position;
      request.eta_seconds = eta;
      touch(request);
    }
    dwell += config_.dwell.count();
  }
}

std::vector<Request> RequestQueue::take_changes() {
  std::vector<Request> changes;
  for (auto& [id, request] : changed_) changes.push_back(std::move(request));
  changed_.clear();
  return changes;
}

}  // namespace robot
