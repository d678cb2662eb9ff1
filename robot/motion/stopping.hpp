// Whether the robot can still stop: the way it goes if it follows a command until the next one could take effect and
// then brakes with all its wheels have, and whether that way stays clear of points. Linear and angular velocity come to
// rest at their own times, so this way is no arc; it is walked in small steps.
#pragma once

#include <span>
#include <vector>

#include "robot/body.hpp"
#include "robot/geometry/pose.hpp"

namespace robot {

// Velocity after `seconds` of following a command within the drive's limits.
Twist toward(const Twist& from, const Twist& wanted, const DriveLimits& limits, double seconds);

// A command and when it reaches the wheels, seconds from now.
struct DueCommand {
  double due = 0.0;
  Twist twist;
};

// Poses of the base, seen from where it is now, while it follows commands (in order of their time; until the first one
// is due it goes on as measured) to the end. The last command should be to stand.
std::vector<Pose> way_of(const Twist& measured, std::span<const DueCommand> commands, const DriveLimits& limits);

// Signed metres from a point to the rectangle's edge, negative inside.
double signed_distance(const Footprint& footprint, Point p);

// Does the footprint stay `margin` metres clear of all points on its way? Points that are nearer from the start, or
// even inside, only must not come nearer still: a robot that is touched can always back away.
bool stays_clear(const Footprint& footprint, double margin, std::span<const Point> points, std::span<const Pose> way);

}  // namespace robot
