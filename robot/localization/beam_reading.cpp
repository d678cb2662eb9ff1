#include "robot/localization/beam_reading.hpp"

#include <algorithm>
#include <cmath>

namespace robot {

BeamCounts count_beams(const ScanReading& reading) {
  BeamCounts counts;
  for (const BeamKind kind : reading.kinds) {
    counts.map += kind == BeamKind::map ? 1 : 0;
    counts.person += kind == BeamKind::person ? 1 : 0;
    counts.far += kind == BeamKind::unexpected_far ? 1 : 0;
    counts.none += kind == BeamKind::no_return ? 1 : 0;
  }
  counts.map -= reading.unknown;
  counts.unknown = reading.unknown;
  return counts;
}

BeamReader::BeamReader(const RayCaster& caster, const LikelihoodField& field, BeamReadingConfig config)
    : caster_(caster), field_(field), config_(config) {}

ScanReading BeamReader::read(const LaserScan& scan, const Pose& map_from_laser, double sigma_position,
                             double sigma_theta) const {
  const std::size_t count = scan.ranges.size();
  ScanReading reading{map_from_laser, std::vector<BeamKind>(count, BeamKind::no_return), std::vector<float>(count)};
  const double slack = config_.tolerance + 2.0 * std::min(sigma_position, 1.0);
  const double swing = std::max(radians(0.5), sigma_theta);
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = map_from_laser.theta + scan.angle_min + static_cast<double>(i) * scan.angle_step;
    const float range = scan.ranges[i];
    const Point direction{std::cos(angle), std::sin(angle)};
    reading.expected[i] = static_cast<float>(caster_.cast(map_from_laser.position(), direction, scan.max_range));
    if (!is_return(range, scan.max_range)) continue;
    const double over = range - reading.expected[i];
    const Point end = map_from_laser.position() + static_cast<double>(range) * direction;
    reading.kinds[i] = BeamKind::map;
    if (std::abs(over) <= slack) continue;
    if (!field_.tells(end)) {
      ++reading.unknown;
    } else if (over < 0.0) {
      const bool at_surface = interpolate(field_.distances(), end).value <= slack;
      reading.kinds[i] = at_surface ? BeamKind::map : BeamKind::person;
    } else if (!slips_past(map_from_laser.position(), angle, range - slack, swing)) {
      reading.kinds[i] = BeamKind::unexpected_far;
    }
  }
  return reading;
}

// Whether a beam a little to the side would get as far: then it just passed an edge.
bool BeamReader::slips_past(Point from, double angle, double reach, double swing) const {
  return caster_.cast(from, angle - swing, reach + 0.1) > reach ||
         caster_.cast(from, angle + swing, reach + 0.1) > reach;
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
