// A tiny world for closed-loop tests of motion: a body with inertia and late commands, moving discs, and lasers over a
// map.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <vector>

#include "robot/body.hpp"
#include "robot/geometry/ray_cast.hpp"
#include "robot/inputs.hpp"
#include "robot/motion/arc_collision.hpp"
#include "robot/time.hpp"

namespace robot::testing {

// A person seen from above.
struct Disc {
  Point position;
  Point velocity;
  double radius = 0.22;
};

class DrivenRobot {
 public:
  static constexpr double step = 0.01;  // s

  DrivenRobot(const OccupancyGrid& map, const Pose& start, double command_delay = 0.1)
      : body_(standard_body()), map_(map), caster_(map), pose_(start), delay_(command_delay) {}

  Time now() const { return from_seconds(seconds_); }
  double seconds() const { return seconds_; }
  const Pose& pose() const { return pose_; }
  const Twist& twist() const { return twist_; }
  const Body& body() const { return body_; }
  std::vector<Disc>& discs() { return discs_; }
  const std::vector<Disc>& discs() const { return discs_; }

  // Drives for some seconds with a new command, which reaches the wheels late.
  void drive(const Twist& command, double seconds) {
    commands_.push_back({seconds_ + delay_, command});
    for (const double end = seconds_ + seconds - 0.5 * step; seconds_ < end;) advance();
  }

  Odometry odometry() const { return {now(), pose_, twist_}; }

  LaserScan scan(LaserId id) const {
    const LaserMount& mount = body_.lasers[static_cast<std::size_t>(id)];
    const Pose laser = pose_ * mount.base_from_laser;
    LaserScan scan{now(), id, mount.angle_min, mount.angle_step, static_cast<float>(mount.max_range), {}};
    for (int i = 0; i < mount.beams; ++i) {
      const double angle = laser.theta + mount.angle_min + i * mount.angle_step;
      double range = caster_.cast(laser.position(), angle, 12.0);
      for (const Disc& disc : discs_) range = std::min(range, to_disc(disc, laser.position(), angle));
      scan.ranges.push_back(range < 12.0 ? static_cast<float>(range) : std::numeric_limits<float>::quiet_NaN());
    }
    return scan;
  }

  // Metres between the footprint and the nearest wall cell's centre or person; negative when a person overlaps.
  double gap_to_people() const {
    double gap = 1e9;
    for (const Disc& disc : discs_) {
      gap = std::min(gap, distance_to(body_.footprint, inverse(pose_) * disc.position) - disc.radius);
    }
    return gap;
  }
  bool touches_wall() const {
    const Footprint& f = body_.footprint;
    for (double x = -f.rear; x <= f.front + 1e-9; x += 0.02) {
      for (double y = -f.half_width; y <= f.half_width + 1e-9; y += 0.02) {
        if (is_occupied(map_.at_or(map_.cell(pose_ * Point{x, y}), occupied_cell))) return true;
      }
    }
    return false;
  }

 private:
  struct Command {
    double due;
    Twist twist;
  };

  void advance() {
    while (!commands_.empty() && commands_.front().due <= seconds_ + 1e-9) {
      wanted_ = commands_.front().twist;
      commands_.pop_front();
    }
    const DriveLimits& d = body_.drive;
    const auto approach = [](double from, double to, double up, double down) {
      const bool faster = std::abs(to) > std::abs(from) && to * from >= 0.0;
      const double most = (faster ? up : down) * step;
      return from + std::clamp(to - from, -most, most);
    };
    twist_.linear = approach(twist_.linear, wanted_.linear, d.max_acceleration, d.max_deceleration);
    twist_.angular = approach(twist_.angular, wanted_.angular, d.max_angular_acceleration, d.max_angular_acceleration);
    pose_ = pose_ * arc(twist_, step);
    for (Disc& disc : discs_) disc.position = disc.position + step * disc.velocity;
    seconds_ += step;
  }

  static double to_disc(const Disc& disc, Point from, double angle) {
    const Point ray{std::cos(angle), std::sin(angle)}, center = disc.position - from;
    const double along = dot(center, ray), across = cross(ray, center);
    const double half = disc.radius * disc.radius - across * across;
    if (half < 0.0 || along < 0.0) return std::numeric_limits<double>::infinity();
    return std::max(0.001, along - std::sqrt(half));
  }

  Body body_;
  OccupancyGrid map_;
  RayCaster caster_;
  Pose pose_;
  Twist twist_, wanted_;
  std::deque<Command> commands_;
  std::vector<Disc> discs_;
  double delay_;
  double seconds_ = 1.0;
};

}  // namespace robot::testing
