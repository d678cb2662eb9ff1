#include "robot/localization/beam_reading.hpp"

#include <algorithm>
#include <cmath>

namespace robot {

BeamCounts count_kinds(const std::vector<BeamKind>& kinds) {
  BeamCounts counts;
  for (const BeamKind kind : kinds) {
    counts.map += kind == BeamKind::map ? 1 : 0;
    counts.person += kind == BeamKind::person ? 1 : 0;
    counts.far += kind == BeamKind::unexpected_far ? 1 : 0;
    counts.none += kind == BeamKind::no_return ? 1 : 0;
  }
  return counts;
}

BeamReader::BeamReader(const OccupancyGrid& map, const RayCaster& caster, const LikelihoodField& field,
                       BeamReadingConfig config)
    : map_(map), caster_(caster), field_(field), config_(config) {}

ScanReading BeamReader::read(const LaserScan& scan, const Pose& map_from_laser, double sigma_position,
                             double sigma_theta) const {
  const std::size_t count = scan.ranges.size();
  ScanReading reading{map_from_laser, std::vector<BeamKind>(count, BeamKind::no_return), std::vector<float>(count),
                      false};
  const double slack = config_.tolerance + 2.0 * std::min(sigma_position, 1.0);
  const double swing = std::max(radians(0.5), sigma_theta);
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = map_from_laser.theta + scan.angle_min + static_cast<double>(i) * scan.angle_step;
    const float range = scan.ranges[i];
    reading.expected[i] = static_cast<float>(caster_.cast(map_from_laser.position(), angle, scan.max_range));
    if (!is_return(range, scan.max_range)) continue;
    reading.kinds[i] = kind_of(range, reading.expected[i], map_from_laser, angle, slack, swing);
  }
  return reading;
}

BeamKind BeamReader::kind_of(float range, float expected, const Pose& laser, double angle, double slack,
                             double swing) const {
  const double over = range - expected;
  if (std::abs(over) <= slack) return BeamKind::map;
  const Point end = laser.position() + range * Point{std::cos(angle), std::sin(angle)};
  const Cell cell = map_.cell(end);
  if (!map_.contains(cell) || map_[cell] < 0) return BeamKind::map;
  if (over < 0.0) return field_.distances()[cell] <= slack ? BeamKind::map : BeamKind::person;
  for (const double turn : {-swing, swing}) {
    if (caster_.cast(laser.position(), angle + turn, range) > range - slack) return BeamKind::map;
  }
  return BeamKind::unexpected_far;
}

bool BeamReader::is_short(const Beam& beam, Point laser, std::span<const Pose> belief) const {
  if (belief.empty()) return false;
  const double allowed = 1.0 - config_.surely_short;
  double otherwise = 0.0;  // probability that the map accounts for the reading
  for (const Pose& pose : belief) {
    const Point direction = (pose * beam.direction) - pose.position();
    const double reach = beam.range + 4.0 * config_.sigma;
    const double before = beam.range - caster_.cast(pose * laser, direction, reach);
    // Certain beyond four sigmas: no need of the error function.
    const double hits =
        before <= -4.0 * config_.sigma ? 0.0 : 0.5 * std::erfc(-before / (config_.sigma * std::numbers::sqrt2));
    otherwise += hits / static_cast<double>(belief.size());
    if (otherwise > allowed) return false;
  }
  return true;
}

}  // namespace robot
