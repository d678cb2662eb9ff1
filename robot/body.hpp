// The robot's body: shape, drive limits and where its sensors sit, in the base frame (between the drive wheels).
#pragma once

#include <vector>

#include "robot/geometry/pose.hpp"

namespace robot {

// A rectangle around the base: the footprint.
struct Footprint {
  double front = 0.30;       // m from the base frame's origin
  double rear = 0.30;        // m
  double half_width = 0.26;  // m
  // Radius of the smallest circle round the origin that holds the rectangle.
  double circumscribed() const;
  // Radius of the largest circle round the origin that fits in.
  double inscribed() const;
};

struct DriveLimits {
  double max_linear = 1.63;               // m/s, forward
  double max_reverse = 0.2;               // m/s
  double max_angular = 1.2;               // rad/s
  double max_acceleration = 0.7;          // m/s2, torque limit
  double max_deceleration = 1.0;          // m/s2, comfortable braking that the safety constraint counts on
  double max_angular_acceleration = 2.0;  // rad/s2
};

struct LaserMount {
  Pose base_from_laser;
  double angle_min = -pi / 2;    // rad
  double angle_step = pi / 180;  // rad
  int beams = 181;
  double max_range = 32.0;  // m; SICK LMS in its 32 m mode
};

struct SonarMount {
  Pose base_from_sonar;
  double opening_angle = radians(25);  // rad, full cone
  double max_range = 4.0;              // m
};

struct Body {
  Footprint footprint;
  DriveLimits drive;
  std::vector<LaserMount> lasers;  // 0: front, 1: rear
  std::vector<SonarMount> sonars;  // 24 round the body
};

// The tour guide's standard body: two 180 degree lasers, 24 sonars.
Body standard_body();

}  // namespace robot
