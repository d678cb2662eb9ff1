#include "robot/localization/beams.hpp"

namespace robot {

Beams beams_of(const LaserScan& scan, const Pose& base_from_laser, int first, int stride) {
  Beams result{base_from_laser.position(), {}};
  const int count = static_cast<int>(scan.ranges.size());
  result.beams.reserve(static_cast<std::size_t>(count / stride) + 1);
  for (int i = first; i < count; i += stride) {
    const float range = scan.ranges[static_cast<std::size_t>(i)];
    if (!is_return(range, scan.max_range)) continue;
    const double angle = base_from_laser.theta + scan.angle_min + i * scan.angle_step;
    const Point direction{std::cos(angle), std::sin(angle)};
    result.beams.push_back({i, range, result.origin + static_cast<double>(range) * direction, direction});
  }
  return result;
}

}  // namespace robot
