// A drive through one room, written down as a robot's log.
#pragma once

#include <cstdio>
#include <string>

#include "robot/geometry/grid.hpp"
#include "robot/geometry/random.hpp"
#include "robot/geometry/ray_cast.hpp"

namespace testing_support {

// A room of 12 x 8 m with a pillar and a niche, so that every place looks different.
inline robot::OccupancyGrid room() {
  robot::OccupancyGrid map(240, 160, 0.05, {-2.0, -2.0}, robot::free_cell);
  for (int x = 0; x < 240; ++x) {
    for (int y = 0; y < 160; ++y) {
      const bool wall = x < 2 || y < 2 || x > 237 || y > 157;
      const bool pillar = x > 100 && x < 115 && y > 90 && y < 105;
      const bool niche = x > 180 && y < 30;
      if (wall || pillar || niche) map[{x, y}] = robot::occupied_cell;
    }
  }
  return map;
}

// A drive through the room as a CARMEN log with odometry that drifts, and its true poses.
struct Drive {
  std::string log, truth;
};

inline Drive drive() {
  const auto map = room();
  robot::Random random(5);
  robot::Pose pose{1.5, 0.0, 0.0}, odometry{0.0, 0.0, 0.0};
  Drive written;
  char line[128];
  for (int i = 0; i < 300; ++i) {
    const double time = 0.2 * i;
    const robot::Twist twist{0.4, 0.16};  // a circle of 5 m across
    std::string ranges;
    for (int b = 0; b < 180; ++b) {
      const double angle = pose.theta - robot::pi / 2 + b * robot::pi / 180;
      const double range = robot::cast_ray(map, pose.position(), angle, 20.0) + random.normal(0.01);
      std::snprintf(line, sizeof line, " %.3f", range);
      ranges += line;
    }
    std::snprintf(line, sizeof line, " %.6f %.6f %.6f", odometry.x, odometry.y, odometry.theta);
    const std::string at = std::string(line) + line;
    std::snprintf(line, sizeof line, " %.3f host %.3f\n", 1000.0 + time, time);
    written.log += "FLASER 180" + ranges + at + line;
    std::snprintf(line, sizeof line, "%.3f %.6f %.6f %.6f\n", time, pose.x, pose.y, pose.theta);
    written.truth += line;
    pose = pose * robot::arc(twist, 0.2);
    odometry = odometry * robot::arc({twist.linear * 1.03, twist.angular * 0.98}, 0.2);
  }
  return written;
}

}  // namespace testing_support
