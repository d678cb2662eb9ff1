// A scan as the localizer uses it: the beams that met something, in the base frame.
#pragma once

#include <vector>

#include "robot/geometry/pose.hpp"
#include "robot/inputs.hpp"

namespace robot {

struct Beam {
  int index = 0;       // in the scan
  float range = 0.0f;  // m
  Point end;           // m, base frame
  Point direction;     // unit, base frame
};

struct Beams {
  Point origin;             // the laser, base frame
  std::vector<Beam> beams;  // valid ones, in the scan's order
};

// A range that says where something is: finite, positive and clearly below the laser's maximum.
inline bool is_return(float range, float max_range) {
  return std::isfinite(range) && range > 0.02f && (!(max_range > 0.0f) || range < 0.995f * max_range);
}

// Every stride-th beam of a scan, beginning with the given one, without those that met nothing.
Beams beams_of(const LaserScan& scan, const Pose& base_from_laser, int first = 0, int stride = 1);

}  // namespace robot
