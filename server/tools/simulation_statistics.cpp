#include "server/tools/simulation_statistics.hpp"

#include <algorithm>
#include <cmath>

#include "protocols/web/names.hpp"
#include "server/tools/report.hpp"

namespace tools {
namespace {

using nlohmann::json;
using protocols::web::name_of;

constexpr double moves_from = 0.03;      // m/s or rad/s / 3
constexpr double wrong_from = 0.5;       // m of error that would matter
constexpr double unnoticed_after = 3.0;  // s

const char* name_of_gate(robot::GateReason reason) {
  switch (reason) {
    case robot::GateReason::none:
      return "none";
    case robot::GateReason::slowed:
      return "slowed";
    case robot::GateReason::stopped_by_hand:
      return "stopped_by_hand";
    case robot::GateReason::obstacle:
      return "obstacle";
    case robot::GateReason::hazard:
      return "hazard";
    case robot::GateReason::bumper:
      return "bumper";
    case robot::GateReason::emergency_stop:
      return "emergency_stop";
    case robot::GateReason::sensor_stale:
      return "sensor_stale";
    case robot::GateReason::base_lost:
      return "base_lost";
    case robot::GateReason::pose_unknown:
      return "pose_unknown";
    case robot::GateReason::motors_off:
      return "motors_off";
  }
  return "unknown";
}

const char* name_of_contact(robot::simulation::ContactKind kind) {
  switch (kind) {
    case robot::simulation::ContactKind::fixed:
      return "static";
    case robot::simulation::ContactKind::hazard:
      return "hazard";
    case robot::simulation::ContactKind::person_robot_fault:
      return "person_robot_fault";
    case robot::simulation::ContactKind::person_own_fault:
      return "person_own_fault";
  }
  return "unknown";
}

json contacts_of(const robot::simulation::World& world, json& list) {
  json counts{{"static", 0}, {"hazard", 0}, {"person_robot_fault", 0}, {"person_own_fault", 0}};
  list = json::array();
  for (const auto& contact : world.contacts()) {
    const char* kind = name_of_contact(contact.kind);
    counts[kind] = counts[kind].get<int>() + 1;
    list.push_back({{"time", robot::to_seconds(contact.time)},
                    {"kind", kind},
                    {"with", contact.with},
                    {"place", {contact.place.x, contact.place.y}},
                    {"robot", {contact.robot.x, contact.robot.y, contact.robot.theta}},
                    {"speed_mps", contact.twist.linear},
                    {"turn_radps", contact.twist.angular}});
  }
  return counts;
}

}  // namespace

void SimulationStatistics::see_truth(robot::Time now, const robot::Pose& pose, robot::Twist twist) {
  if (started_) {
    const double dt = robot::to_seconds(now) - robot::to_seconds(last_time_);
    distance_ += robot::distance(pose.position(), last_.position());
    const bool moves = std::abs(twist.linear) > moves_from || std::abs(twist.angular) > 3.0 * moves_from;
    if (moves) moving_seconds_ += dt;
    if (moving_ && !moves && activity_ == robot::Activity::driving) ++stops_;
    moving_ = moves;
    fastest_ = std::max(fastest_, std::abs(twist.linear));
  }
  started_ = true;
  last_ = pose;
  last_time_ = now;
  truth_.push_back({now, pose});
  while (now - truth_.front().time > robot::Seconds(1.0)) truth_.pop_front();
}

void SimulationStatistics::see(const robot::Output& output, robot::Time now) {
  if (const auto* estimate = std::get_if<robot::PoseEstimate>(&output)) {
    judge(*estimate);
  } else if (const auto* status = std::get_if<robot::Status>(&output)) {
    see_status(*status, now);
  } else if (const auto* changed = std::get_if<robot::RequestChanged>(&output)) {
    requests_[changed->request.id] = changed->request;
  } else if (const auto* answer = std::get_if<robot::Answer>(&output)) {
    if (answer->refusal != robot::Refusal::none) ++refused_[answer->refusal];
  } else if (const auto* speech = std::get_if<robot::Speech>(&output)) {
    ++cues_[speech->cue];
  } else if (const auto* visit = std::get_if<robot::VisitEnded>(&output)) {
    ++(visit->complete ? exhibits_ : cut_short_);
  } else if (const auto* command = std::get_if<robot::WheelCommand>(&output)) {
    gated_[command->reason] += 0.05;
  } else if (const auto* note = std::get_if<robot::Note>(&output)) {
    if (note->severity != robot::Severity::info) ++notes_[note->code];
  }
}

// The estimate against the truth at its own time, between the two samples round it.
void SimulationStatistics::judge(const robot::PoseEstimate& estimate) {
  const double dt = std::clamp(robot::to_seconds(estimate.time) - robot::to_seconds(last_estimate_), 0.0, 0.2);
  last_estimate_ = estimate.time;
  if (!estimate.localized) {
    lost_seconds_ += dt;
    wrong_seconds_ = 0.0;
    return;
  }
  const auto after = std::ranges::find_if(truth_, [&](const Sample& s) { return s.time >= estimate.time; });
  if (after == truth_.end()) return;
  robot::Pose truth = after->pose;
  if (after != truth_.begin() && after->time > estimate.time) {
    const Sample& before = *(after - 1);
    const double share = robot::Seconds(estimate.time - before.time) / robot::Seconds(after->time - before.time);
    const robot::Pose step = robot::relative(before.pose, after->pose);
    truth = before.pose * robot::Pose{share * step.x, share * step.y, share * step.theta};
  }
  const double error = robot::distance(truth.position(), estimate.map_from_base.position());
  errors_.push_back(static_cast<float>(error));
  turns_.push_back(static_cast<float>(std::abs(robot::wrap_angle(truth.theta - estimate.map_from_base.theta))));
  const double before = wrong_seconds_;
  wrong_seconds_ = error > wrong_from ? wrong_seconds_ + dt : 0.0;
  if (before < unnoticed_after && wrong_seconds_ >= unnoticed_after) ++lost_unnoticed_;
}

void SimulationStatistics::see_status(const robot::Status& status, robot::Time now) {
  activity_seconds_[activity_] += robot::to_seconds(now) - robot::to_seconds(activity_since_);
  activity_since_ = now;
  if (status.activity == activity_) return;
  if (activity_ == robot::Activity::waiting) {
    waits_.push_back(robot::to_seconds(now) - robot::to_seconds(waiting_since_));
  }
  if (status.activity == robot::Activity::waiting) waiting_since_ = now;
  activity_ = status.activity;
}

json SimulationStatistics::requests(robot::Time now, robot::Seconds open_for) const {
  int fulfilled = 0, failed = 0, cancelled = 0, young = 0, overdue = 0, tours = 0;
  std::map<std::string, int> reasons;
  for (const auto& [id, request] : requests_) {
    switch (request.state) {
      case robot::RequestState::fulfilled:
        ++fulfilled;
        break;
      case robot::RequestState::failed:
        ++failed;
        ++reasons[request.reason];
        break;
      case robot::RequestState::cancelled:
        ++cancelled;
        break;
      default:
        ++(now - request.asked > open_for ? overdue : young);
    }
  }
  // A tour's requests share its name and the moment it was asked for.
  std::map<std::pair<std::string, robot::Time>, std::pair<int, int>> groups;
  for (const auto& [id, request] : requests_) {
    if (request.tour.empty()) continue;
    auto& [all, done] = groups[{request.tour, request.asked}];
    ++all;
    done += request.state == robot::RequestState::fulfilled;
  }
  for (const auto& [key, group] : groups) tours += group.first == group.second;
  const int judged = fulfilled + failed + overdue;
  return {{"requests", requests_.size()},
          {"fulfilled", fulfilled},
          {"success_rate", judged > 0 ? json(static_cast<double>(fulfilled) / judged) : json(nullptr)},
          {"failed", failed},
          {"failed_reasons", reasons},
          {"cancelled", cancelled},
          {"open", young},
          {"overdue", overdue},
          {"tours", tours},
          {"tours_begun", groups.size()}};
}

json SimulationStatistics::report(const robot::simulation::World& world, robot::Seconds open_for) const {
  json report = requests(world.now(), open_for);
  const std::vector<double> errors(errors_.begin(), errors_.end()), turns(turns_.begin(), turns_.end());
  const auto in_degrees = [](std::optional<double> value) {
    return value ? std::optional(robot::degrees(*value)) : value;
  };
  report["hours"] = robot::to_seconds(world.now()) / 3600.0;
  report["distance_m"] = distance_;
  report["speed_mean_mps"] = moving_seconds_ > 0.0 ? distance_ / moving_seconds_ : 0.0;
  report["speed_max_mps"] = fastest_;
  report["moving_hours"] = moving_seconds_ / 3600.0;
  report["contacts"] = contacts_of(world, report["contact_list"]);
  report["localization"] = {{"median_m", or_null(percentile(errors, 0.5))},
                            {"p95_m", or_null(percentile(errors, 0.95))},
                            {"p99_m", or_null(percentile(errors, 0.99))},
                            {"max_m", or_null(percentile(errors, 1.0))},
                            {"median_deg", or_null(in_degrees(percentile(turns, 0.5)))},
                            {"p99_deg", or_null(in_degrees(percentile(turns, 0.99)))},
                            {"lost_seconds", lost_seconds_},
                            {"lost_unnoticed", lost_unnoticed_}};
  report["exhibits"] = exhibits_;
  report["exhibits_cut_short"] = cut_short_;
  report["stops"] = stops_;
  int refusals = 0;
  for (const auto& [why, count] : refused_) refusals += count;
  report["refused"] = refusals;
  report["cues"] = json::object();
  for (const auto& [cue, count] : cues_) report["cues"][name_of(cue)] = count;
  const auto horn = cues_.find(robot::Cue::horn);
  report["horn"] = horn == cues_.end() ? 0 : horn->second;
  report["waiting"] = {{"times", waits_.size()},
                       {"median_s", or_null(percentile(waits_, 0.5))},
                       {"max_s", or_null(percentile(waits_, 1.0))}};
  for (const auto& [activity, seconds] : activity_seconds_) report["activity_s"][name_of(activity)] = seconds;
  for (const auto& [reason, seconds] : gated_) report["gate_s"][name_of_gate(reason)] = seconds;
  report["incidents"] = notes_;
  return report;
}

}  // namespace tools
