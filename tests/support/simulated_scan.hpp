// Scans as a laser at a known pose would take them, with noise and people of the test's choice.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "robot/geometry/random.hpp"
#include "robot/geometry/ray_cast.hpp"
#include "robot/inputs.hpp"

namespace robot::testing {

struct ScanSetup {
  double angle_min = -pi / 2;    // rad
  double angle_step = pi / 180;  // rad
  int beams = 181;
  float max_range = 30.0f;  // m
  double sigma = 0.0;       // m
  LaserId laser = LaserId::front;
};

// Somebody: a disc, map frame.
struct Somebody {
  Point center;
  double radius = 0.2;  // m
};

inline double range_to(const Somebody& who, Point from, Point direction) {
  const Point to = who.center - from;
  const double along = dot(to, direction), across = cross(direction, to);
  if (along <= 0.0 || std::abs(across) >= who.radius) return 1e9;
  return along - std::sqrt(who.radius * who.radius - across * across);
}

inline LaserScan take_scan(const RayCaster& world, const Pose& map_from_laser, const ScanSetup& setup, Random& random,
                           Time time = {}, const std::vector<Somebody>& people = {}) {
  LaserScan scan{time, setup.laser, setup.angle_min, setup.angle_step, setup.max_range, {}};
  for (int i = 0; i < setup.beams; ++i) {
    const double angle = map_from_laser.theta + setup.angle_min + i * setup.angle_step;
    const Point direction{std::cos(angle), std::sin(angle)};
    double range = world.cast(map_from_laser.position(), direction, setup.max_range);
    for (const auto& who : people) range = std::min(range, range_to(who, map_from_laser.position(), direction));
    const bool met = range < setup.max_range;
    scan.ranges.push_back(met ? static_cast<float>(range + random.normal(setup.sigma)) : setup.max_range);
  }
  return scan;
}

}  // namespace robot::testing
