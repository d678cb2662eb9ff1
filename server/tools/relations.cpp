#include "server/tools/relations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tools {
namespace {

// The element of a sorted track that is nearest in time; the track must not be empty.
const files::TimedPose& nearest(const files::PoseTrack& track, double time) {
  const auto after = std::lower_bound(track.begin(), track.end(), time,
                                      [](const files::TimedPose& timed, double t) { return timed.time < t; });
  if (after == track.begin()) return *after;
  if (after == track.end()) return track.back();
  return time - (after - 1)->time < after->time - time ? *(after - 1) : *after;
}

// How well the steps of a track agree with relations at an offset. Each that agrees to 0.3 m (a radian counting like a
// metre) speaks for it, each that does not against it, none by much.
struct Agreement {
  double votes = 0.0;
  int counted = 0;
  bool sure() const { return counted >= 10 && votes > 0.1 * counted; }
};

Agreement agreement_of(const std::vector<files::Relation>& relations, const files::PoseTrack& track, double offset) {
  Agreement agreement;
  for (const auto& relation : relations) {
    const auto from = files::pose_at(track, relation.from_time - offset);
    const auto to = files::pose_at(track, relation.to_time - offset);
    if (!from || !to) continue;
    const auto error = robot::relative(relation.relative, robot::relative(*from, *to));
    agreement.votes += 0.3 - std::min(1.0, robot::norm(error.position()) + std::abs(error.theta));
    ++agreement.counted;
  }
  return agreement;
}

struct Spread {
  double mean = 0.0, deviation = 0.0;
};

Spread spread_of(const std::vector<double>& values) {
  if (values.empty()) return {};
  double sum = 0.0, squares = 0.0;
  for (const double v : values) sum += v;
  const double mean = sum / static_cast<double>(values.size());
  for (const double v : values) squares += (v - mean) * (v - mean);
  return {mean, std::sqrt(squares / static_cast<double>(values.size()))};
}

}  // namespace

std::optional<robot::Pose> carried_pose(const files::PoseTrack& estimates, const files::PoseTrack& odometry,
                                        double time) {
  if (estimates.empty()) return std::nullopt;
  const auto& estimate = nearest(estimates, time);
  if (std::abs(estimate.time - time) <= 0.1) return estimate.pose;
  if (std::abs(estimate.time - time) > 10.0) return std::nullopt;
  const auto then = files::pose_at(odometry, estimate.time), now = files::pose_at(odometry, time);
  if (!then || !now) return std::nullopt;
  return estimate.pose * robot::relative(*then, *now);
}

RelationsScore score_relations(const std::vector<files::Relation>& relations, const files::PoseTrack& estimates,
                               const files::PoseTrack& odometry, double offset) {
  std::vector<double> translations, rotations;
  for (const auto& relation : relations) {
    const auto from = carried_pose(estimates, odometry, relation.from_time - offset);
    const auto to = carried_pose(estimates, odometry, relation.to_time - offset);
    if (!from || !to) continue;
    const auto error = robot::relative(relation.relative, robot::relative(*from, *to));
    translations.push_back(robot::norm(error.position()));
    rotations.push_back(std::abs(robot::degrees(error.theta)));
  }
  const Spread translation = spread_of(translations), rotation = spread_of(rotations);
  return {static_cast<int>(translations.size()), translation.mean, translation.deviation, rotation.mean,
          rotation.deviation};
}

std::optional<double> find_clock_offset(const std::vector<files::Relation>& relations,
                                        const files::PoseTrack& estimates, const std::vector<double>& likely) {
  if (relations.empty() || estimates.empty()) return std::nullopt;
  for (const double offset : likely) {
    if (agreement_of(relations, estimates, offset).sure()) return offset;
  }
  constexpr std::size_t enough = 300;
  constexpr double slack = 60.0;  // s that one of them may start or end before the other
  const auto by_time = [](const files::Relation& a, const files::Relation& b) {
    return std::min(a.from_time, a.to_time) < std::min(b.from_time, b.to_time);
  };
  const auto first = std::min_element(relations.begin(), relations.end(), by_time);
  const auto last = std::max_element(relations.begin(), relations.end(), by_time);
  std::vector<files::Relation> some;
  for (std::size_t i = 0; i < relations.size(); i += 1 + relations.size() / enough) some.push_back(relations[i]);
  // Relations and estimates each cover most of the drive, or the estimates a part of it.
  double low = std::min(last->from_time - estimates.back().time, first->from_time - estimates.front().time) - slack;
  double high = std::max(first->from_time - estimates.front().time, last->from_time - estimates.back().time) + slack;
  double best = low;
  Agreement most;
  for (const double step : {0.1, 0.02, 0.004}) {
    for (double offset = low; offset <= high; offset += step) {
      const auto agreement = agreement_of(some, estimates, offset);
      if (agreement.votes > most.votes) best = offset, most = agreement;
    }
    low = best - step, high = best + step;
  }
  return most.sure() ? std::optional(best) : std::nullopt;
}

}  // namespace tools
