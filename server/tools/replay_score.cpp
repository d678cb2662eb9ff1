#include "server/tools/replay_score.hpp"

#include <algorithm>
#include <cmath>

#include "server/tools/report.hpp"

namespace tools {

void ReplayScore::add(const ReplayStep& step) {
  ++scans_;
  weighed_ += step.weighed;
  if (!first_time_) first_time_ = step.time;
  // Stamps may run backwards: no time passes then.
  const double elapsed = std::max(0.0, step.time - last_time_.value_or(step.time));
  last_time_ = std::max(step.time, last_time_.value_or(step.time));
  path_ = step.path_m;
  scan_ms_.push_back(step.scan_ms);
  if (step.weighed) weighed_ms_.push_back(step.scan_ms);
  search_ms_.push_back(step.search_ms);
  particles_.push_back(step.pose.particles);
  sigmas_.push_back(step.pose.sigma_position);
  track_.push_back({step.time, step.pose.map_from_base});
  for (const auto kind : step.scan.kinds) {
    beams_map_ += kind == robot::BeamKind::map;
    beams_near_ += kind == robot::BeamKind::person;
    beams_far_ += kind == robot::BeamKind::unexpected_far;
  }
  add_error(step, elapsed);
}

void ReplayScore::add_error(const ReplayStep& step, double elapsed) {
  with_truth_ += step.truth.has_value();
  bool off = false;
  double metres = 0.0, degrees = 0.0;
  if (step.truth) {
    metres = robot::distance(step.truth->position(), step.pose.map_from_base.position());
    degrees = std::abs(robot::degrees(robot::wrap_angle(step.pose.map_from_base.theta - step.truth->theta)));
    off = !(metres <= lost_metres && degrees <= lost_degrees);
    final_error_ = metres;
  }
  const bool sure = step.pose.localized && !step.lost;
  if (!converged_seconds_) {
    if (!sure || off) return;
    converged_seconds_ = step.time - *first_time_;
    converged_metres_ = step.path_m;
  }
  if (off || step.lost) lost_seconds_ += elapsed;
  if (!sure) unsure_seconds_ += elapsed;
  if (sure && off) lost_unnoticed_seconds_ += elapsed;
  if (!step.truth) return;
  metres_.push_back(metres);
  degrees_.push_back(degrees);
}

nlohmann::json ReplayScore::report() const {
  const auto greatest = [](const std::vector<double>& values) { return or_null(percentile(values, 1.0)); };
  const auto at = [](const std::vector<double>& values, double share) { return or_null(percentile(values, share)); };
  const double returns = static_cast<double>(std::max<std::size_t>(1, beams_map_ + beams_near_ + beams_far_));
  nlohmann::json report = {
      {"scans", scans_},
      {"scans_weighed", weighed_},
      {"scans_with_truth", with_truth_},
      {"log_seconds", first_time_ ? *last_time_ - *first_time_ : 0.0},
      {"path_m", path_},
      {"translation", {{"median_m", at(metres_, 0.5)}, {"p95_m", at(metres_, 0.95)}, {"max_m", greatest(metres_)}}},
      {"rotation",
       {{"median_deg", at(degrees_, 0.5)}, {"p95_deg", at(degrees_, 0.95)}, {"max_deg", greatest(degrees_)}}},
      {"scan_ms",
       {{"median", at(scan_ms_, 0.5)}, {"p99", at(scan_ms_, 0.99)}, {"weighed_median", at(weighed_ms_, 0.5)}}},
      {"search_ms", {{"p99", at(search_ms_, 0.99)}, {"max", greatest(search_ms_)}}},
      {"converged", nullptr},
      {"lost_seconds", lost_seconds_},
      {"lost_unnoticed_seconds", lost_unnoticed_seconds_},
      {"unsure_seconds", unsure_seconds_},
      {"final_error_m", or_null(final_error_)},
      {"sigma_m", {{"median", at(sigmas_, 0.5)}, {"max", greatest(sigmas_)}}},
      {"particles", {{"median", at(particles_, 0.5)}, {"max", greatest(particles_)}}},
      {"beams",
       {{"map", static_cast<double>(beams_map_) / returns},
        {"before_map", static_cast<double>(beams_near_) / returns},
        {"behind_map", static_cast<double>(beams_far_) / returns}}}};
  if (converged_seconds_) report["converged"] = {{"seconds", *converged_seconds_}, {"metres", *converged_metres_}};
  return report;
}

}  // namespace tools
