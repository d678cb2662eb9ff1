#include "robot/tasks/guide.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace robot {
namespace {

Text make_way_words() {
  return {{"en", "Excuse me, may I come through?"}, {"de", "Entschuldigung, darf ich bitte durch?"}};
}
Text horn_words() {
  return {{"en", "Please let me through, two steps are enough."},
          {"de", "Bitte lasst mich durch, zwei Schritte genügen."}};
}

Answer answer(Ticket ticket, Refusal refusal, std::vector<RequestId> requests = {}) {
  return {.ticket = ticket, .refusal = refusal, .requests = std::move(requests)};
}

}  // namespace

Guide::Guide(const Museum& museum, GuideConfig config, std::function<Refusal(Point)> refuse, Travel travel)
    : museum_(&museum), config_(config), refuse_(std::move(refuse)), travel_(std::move(travel)), queue_(config.queue) {}

Refusal Guide::refuse_target(const Target& target) const {
  if (const auto* at = std::get_if<ExhibitTarget>(&target)) {
    const Exhibit* exhibit = find_exhibit(*museum_, at->exhibit);
    if (!exhibit) return Refusal::unknown_exhibit;
    const bool known =
        !at->viewpoint || (*at->viewpoint >= 0 && *at->viewpoint < static_cast<int>(exhibit->viewpoints.size()));
    return known ? Refusal::none : Refusal::unknown_viewpoint;
  }
  const auto& place = std::get<PointTarget>(target);
  if (!is_finite(place.point) || (place.theta && !std::isfinite(*place.theta))) return Refusal::not_finite;
  return refuse_(place.point);
}

void Guide::handle(const RequestVisit& wish, Time now, std::vector<Output>& out) {
  Refusal refusal = refuse_target(wish.target);
  if (refusal == Refusal::none) refusal = queue_.room_for(wish.requester, 1);
  if (refusal != Refusal::none) return out.push_back(answer(wish.ticket, refusal));
  const RequestId id = queue_.add(wish.requester, wish.target, now);
  reorder(here_, now);
  report(last_, out);
  out.push_back(answer(wish.ticket, Refusal::none, {id}));
}

void Guide::handle(const CancelRequest& wish, Time now, std::vector<Output>& out) {
  bool visit_is_gone = false;
  const Refusal refusal = queue_.cancel(wish, visit_is_gone);
  if (visit_is_gone && (state_ == State::telling || state_ == State::asking)) {
    visit_.left = now;
    visit_.complete = false;
    out.push_back(visit_);
  }
  if (visit_is_gone && state_ != State::homing) enter(State::idle, now);
  reorder_due_ = true;
  report(last_, out);
  out.push_back(answer(wish.ticket, refusal, {wish.id}));
}

void Guide::handle(const StartTour& wish, Time now, std::vector<Output>& out) {
  const Tour* tour = find_tour(*museum_, wish.tour);
  if (!tour) return out.push_back(answer(wish.ticket, Refusal::unknown_tour));
  if (const Refusal refusal = queue_.room_for(wish.requester, tour->exhibits.size()); refusal != Refusal::none) {
    return out.push_back(answer(wish.ticket, refusal));
  }
  const auto ids = queue_.add_tour(wish.requester, *tour, now);
  reorder(here_, now);
  report(last_, out);
  out.push_back(answer(wish.ticket, Refusal::none, ids));
}

void Guide::handle(const AnswerTour& wish, Time now, std::vector<Output>& out) {
  const bool here = state_ == State::telling || state_ == State::asking;
  if (wish.answer == TourAnswer::end_tour) {
    if (tour_run_ == 0) return out.push_back(answer(wish.ticket, Refusal::nothing_to_answer));
    if (here) leave(now, out);
    queue_.cancel_tour(std::exchange(tour_run_, 0), "The tour was ended.");
    if (state_ == State::driving) enter(State::idle, now);
    report(last_, out);
    return out.push_back(answer(wish.ticket, Refusal::none));
  }
  if (!here) return out.push_back(answer(wish.ticket, Refusal::nothing_to_answer));
  const Exhibit* exhibit = exhibit_here();
  if (wish.answer == TourAnswer::more) {
    const bool more = exhibit && narration_ + 1 < static_cast<int>(exhibit->narrations.size());
    if (!more) return out.push_back(answer(wish.ticket, Refusal::nothing_to_answer));
    tell(narration_ + 1, now, out);
  } else {
    leave(now, out);
    report(last_, out);
  }
  out.push_back(answer(wish.ticket, Refusal::none));
}

void Guide::handle(const Remember& memory, Time now, std::vector<Output>& out) {
  Remember known = memory;  // a museum may have changed since
  std::erase_if(known.open, [&](const RememberedRequest& old) { return refuse_target(old.target) != Refusal::none; });
  for (const RememberedRequest& old : memory.open) {
    if (refuse_target(old.target) == Refusal::none) continue;
    Request request{.id = old.id,
                    .requester = old.requester,
                    .target = old.target,
                    .state = RequestState::failed,
                    .reason = {},
                    .asked = now,
                    .tour = {}};
    request.reason = "The museum changed while the robot was off, and this place cannot be reached any more.";
    out.push_back(RequestChanged{std::move(request)});
  }
  queue_.remember(known, now);
  reorder_due_ = true;
  report(last_, out);
}

std::vector<Pose> Guide::places(const Target& target) const {
  if (const auto* at = std::get_if<ExhibitTarget>(&target)) {
    const Exhibit* exhibit = find_exhibit(*museum_, at->exhibit);
    if (!exhibit) return {};
    if (at->viewpoint) return {exhibit->viewpoints.at(static_cast<std::size_t>(*at->viewpoint)).pose};
    std::vector<Pose> poses;
    for (const Viewpoint& viewpoint : exhibit->viewpoints) poses.push_back(viewpoint.pose);
    return poses;
  }
  const auto& place = std::get<PointTarget>(target);
  return {{place.point.x, place.point.y, place.theta.value_or(0.0)}};
}

void Guide::set_goal(std::optional<Goal> goal) {
  goal_ = std::move(goal);
  ++goal_version_;
  blocked_since_.reset();
  unreachable_since_.reset();
  last_word_.reset();
  words_said_ = 0;
}

void Guide::enter(State state, Time now) {
  state_ = state;
  since_ = now;
  if (state == State::homing) {
    set_goal(Goal{{museum_->home}, true});
  } else if (state != State::driving) {
    set_goal(std::nullopt);
  }
}

const Exhibit* Guide::exhibit_here() const {
  if (queue_.empty()) return nullptr;
  const auto* at = std::get_if<ExhibitTarget>(&queue_.visits().front().target);
  return at ? find_exhibit(*museum_, at->exhibit) : nullptr;
}

void Guide::reorder(const Pose& here, Time now) {
  const bool under_way = state_ == State::driving || state_ == State::telling || state_ == State::asking;
  queue_.reorder(PointTarget{here.position(), {}}, tour_run_, under_way && !queue_.empty(), travel_, now);
  reorder_due_ = false;
}

void Guide::choose_next(const Progress& progress, Time now) {
  reorder(progress.map_from_base, now);
  if (queue_.empty()) {
    const bool away = distance(progress.map_from_base.position(), museum_->home.position()) > 0.5;
    if (away && now - since_ > config_.idle_before_homing) enter(State::homing, now);
    return;
  }
  const Visit& visit = queue_.front();
  tour_run_ = visit.tour_run;
  enter(State::driving, now);
  const auto* place = std::get_if<PointTarget>(&visit.target);
  set_goal(Goal{places(visit.target), !place || place->theta.has_value()});
  queue_.activate_front();
}

void Guide::tick(const Progress& progress, Time now, std::vector<Output>& out) {
  here_ = progress.map_from_base;
  last_ = progress;
  if (reorder_due_) reorder(here_, now);
  switch (state_) {
    case State::idle:
      choose_next(progress, now);
      break;
    case State::homing:
      if (!queue_.empty()) {
        choose_next(progress, now);
      } else if (progress.arrived) {
        enter(State::idle, now);
      } else {
        drive_on(progress, now, out);
      }
      break;
    case State::driving:
      drive_on(progress, now, out);
      break;
    case State::telling:
      if (now >= until_) {
        const Exhibit* exhibit = exhibit_here();
        const bool more = exhibit && narration_ + 1 < static_cast<int>(exhibit->narrations.size());
        if (!more) {
          leave(now, out);
        } else {
          enter(State::asking, now);
          until_ = now + config_.ask;
        }
      }
      break;
    case State::asking:
      if (now >= until_) leave(now, out);
      break;
  }
  report(progress, out);
}

void Guide::drive_on(const Progress& progress, Time now, std::vector<Output>& out) {
  if (!progress.blocked) {
    blocked_since_.reset();
  } else if (!blocked_since_) {
    blocked_since_ = now;
  }
  if (progress.reachable) {
    unreachable_since_.reset();
  } else if (!unreachable_since_) {
    unreachable_since_ = now;
  }
  const Seconds blocked = blocked_since_ ? Seconds(now - *blocked_since_) : Seconds(0);
  const bool near = progress.goal_distance < config_.near_enough && blocked > config_.near_enough_after;
  if (state_ == State::driving && (progress.arrived || (near && exhibit_here()))) return arrive(now, out);
  if (blocked > config_.polite_after) ask_to_make_way(progress, now, out);
  const bool no_way = unreachable_since_ && now - *unreachable_since_ > config_.unreachable_after;
  if (state_ == State::driving && (no_way || blocked > config_.postpone_after)) put_off(progress, now);
}

void Guide::ask_to_make_way(const Progress& progress, Time now, std::vector<Output>& out) {
  if (progress.people_ahead == 0 && progress.people_near == 0) return;
  if (last_word_ && now - *last_word_ < config_.word_again_after) return;
  const bool horn = words_said_ > 0 && now - *blocked_since_ > config_.horn_after;
  out.push_back(Speech{.cue = horn ? Cue::horn : Cue::make_way,
                       .exhibit = {},
                       .text = horn ? horn_words() : make_way_words(),
                       .duration = Seconds(2.5)});
  last_word_ = now;
  ++words_said_;
}

void Guide::put_off(const Progress& progress, Time now) {
  Visit& visit = queue_.front();
  const Seconds tried = now - since_;
  const bool others = queue_.visits().size() > 1;
  if (visit.tries >= 3 || tried > config_.fail_after || (!others && visit.tries >= 1 && !progress.reachable)) {
    queue_.finish_front(RequestState::failed, progress.reachable ? "People blocked the way for too long."
                                                                 : "There is no way there at the moment.");
  } else if (others) {
    queue_.postpone_front();
  } else {
    ++visit.tries;  // nothing else to do: wait on, and count
    blocked_since_.reset();
    unreachable_since_.reset();
    return;
  }
  enter(State::idle, now);
}

void Guide::arrive(Time now, std::vector<Output>& out) {
  visit_ = {.exhibit = {}, .requests = {}, .arrived = now, .left = now};
  if (const Exhibit* exhibit = exhibit_here()) {
    visit_.exhibit = exhibit->id;
    return tell(0, now, out);
  }
  enter(State::telling, now);
  narration_ = 0;
  until_ = now + config_.stay_at_point;
  const Text words = {{"en", "I have arrived."}, {"de", "Ich bin angekommen."}};
  out.push_back(Speech{.cue = Cue::arrived, .exhibit = {}, .text = words, .duration = Seconds(2)});
}

void Guide::tell(int narration, Time now, std::vector<Output>& out) {
  const Exhibit* exhibit = exhibit_here();
  enter(State::telling, now);
  narration_ = narration;
  Speech speech{.cue = Cue::narration,
                .exhibit = exhibit->id,
                .narration = narration,
                .text = exhibit->summary,
                .duration = Seconds(10)};
  if (narration < static_cast<int>(exhibit->narrations.size())) {
    const Narration& words = exhibit->narrations[static_cast<std::size_t>(narration)];
    speech.text = words.text;
    speech.duration = words.duration;
  }
  until_ = now + speech.duration;
  out.push_back(std::move(speech));
}

void Guide::leave(Time now, std::vector<Output>& out) {
  visit_.requests = queue_.front().requests;
  visit_.left = now;
  visit_.complete = true;
  const std::uint64_t run = queue_.front().tour_run;
  queue_.finish_front(RequestState::fulfilled, "");
  const bool tour_goes_on = run != 0 && std::ranges::count(queue_.visits(), run, &Visit::tour_run) > 0;
  if (!tour_goes_on) tour_run_ = 0;
  out.push_back(visit_);
  enter(State::idle, now);
}

// Of travel to the first stop: along the path once there is one, before that as the travel table has it.
double Guide::metres_to_front(const Progress& progress) const {
  if (queue_.empty() || state_ == State::telling || state_ == State::asking) return 0.0;
  if (state_ == State::driving && progress.distance_to_go > 0.0) return progress.distance_to_go;
  return travel_(PointTarget{here_.position(), {}}, queue_.visits().front().target);
}

void Guide::report(const Progress& progress, std::vector<Output>& out) {
  queue_.estimate(metres_to_front(progress), travel_);
  for (Request& request : queue_.take_changes()) out.push_back(RequestChanged{std::move(request)});
}

void Guide::describe(Status& status, Time now) const {
  const bool blocked = blocked_since_ && now - *blocked_since_ > config_.waiting_after;
  const bool unreachable = unreachable_since_ && now - *unreachable_since_ > config_.waiting_after;
  switch (state_) {
    case State::idle:
      status.activity = Activity::idle;
      status.why = Why::nothing_to_do;
      return;
    case State::homing:
      status.activity = Activity::homing;
      status.why = Why::nothing_to_do;
      status.distance_to_go = last_.distance_to_go;
      return;
    case State::driving:
      status.activity = blocked || unreachable ? Activity::waiting : Activity::driving;
      status.why = unreachable                    ? Why::way_blocked
                   : blocked && last_.people_near ? Why::people_in_the_way
                   : blocked                      ? Why::way_blocked
                   : tour_run_ != 0               ? Why::tour
                                                  : Why::requested;
      status.distance_to_go = last_.distance_to_go;
      status.seconds_to_go = last_.distance_to_go / config_.queue.speed;
      break;
    case State::telling:
    case State::asking:
      status.activity = state_ == State::telling ? Activity::explaining : Activity::asking;
      status.why = tour_run_ != 0 ? Why::tour : Why::requested;
      status.seconds_to_go = Seconds(until_ - now).count();
      break;
  }
  if (queue_.empty()) return;
  const Visit& visit = queue_.visits().front();
  if (const auto* at = std::get_if<ExhibitTarget>(&visit.target)) status.exhibit = at->exhibit;
  if (const auto* place = std::get_if<PointTarget>(&visit.target)) status.point = place->point;
  if (!visit.requests.empty() && queue_.has(visit.requests.front())) {
    status.requester = queue_.request(visit.requests.front()).requester.name;
  }
  status.tour = visit.tour;
  status.stop_number = visit.number;
  status.stop_count = visit.count;
}

}  // namespace robot
