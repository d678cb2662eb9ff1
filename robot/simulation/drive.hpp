// The base's wheels and motors: what becomes of a commanded twist. Velocity loops with a short time constant and
// limited torque (body.hpp), and two wheels that slip: the ground moves a little less, or more, than the wheels say, so
// that dead reckoning drifts by 2 to 5 per cent and a few degrees in 10 m.
#pragma once

#include "robot/body.hpp"
#include "robot/geometry/random.hpp"

namespace robot::simulation {

// Standard deviations; each base draws its own systematic errors once. All zero: the wheels tell the truth.
struct DriveNoise {
  double wheel_scale = 0.02;         // both wheels, share of the way (worn tyres, carpet)
  double wheel_difference = 0.0012;  // left against right, share of the way
  double turn_scale = 0.02;          // share of the angle (effective track)
  double slip = 0.004;               // share of each wheel's way, wandering
  double slip_length = 0.5;          // m of way over which it wanders
};

class Drive {
 public:
  Drive(const DriveLimits& limits, const DriveNoise& noise, Random random);

  void command(Twist wanted) { wanted_ = wanted; }
  // Moves the wheels on by dt seconds; returns how the body moved over the ground, in its own frame.
  Pose step(double dt);
  // Something holds the body: the motors stall.
  void block() { wheels_ = ground_ = Twist{}; }

  Twist wanted() const { return wanted_; }
  Twist wheels() const { return wheels_; }  // as the encoders measure
  Twist ground() const { return ground_; }  // as the body really moves
  Pose odometry() const { return odometry_; }

 private:
  DriveLimits limits_;
  DriveNoise noise_;
  Random random_;
  double left_scale_, right_scale_, turn_scale_;
  double left_slip_ = 0.0, right_slip_ = 0.0;
  Twist wanted_, wheels_, ground_;
  Pose odometry_;
};

}  // namespace robot::simulation
