#include "robot/simulation/drive.hpp"

#include <algorithm>
#include <cmath>

namespace robot::simulation {
namespace {

constexpr double loop_time = 0.06;  // s, of the velocity loops
constexpr double least = 1e-4;      // m/s or rad/s that friction swallows
constexpr double track = 0.40;      // m between the wheels

// One axis of the velocity loop: speeding up and slowing down have their own limits; a change of sign brakes first.
double pursue(double now, double wanted, double speed_up, double slow_down, double dt) {
  const bool braking = now * wanted < 0.0 || std::abs(wanted) < std::abs(now);
  const double limit = braking ? slow_down : speed_up;
  const double rate = std::clamp((wanted - now) / loop_time, -limit, limit);
  const double next = now + rate * dt;
  if (std::abs(wanted - next) < least) return wanted;
  return braking && now * next < 0.0 ? 0.0 : next;
}

}  // namespace

Drive::Drive(const DriveLimits& limits, const DriveNoise& noise, Random random)
    : limits_(limits), noise_(noise), random_(random) {
  const double both = random_.normal(noise_.wheel_scale), difference = random_.normal(noise_.wheel_difference);
  left_scale_ = 1.0 + both - 0.5 * difference;
  right_scale_ = 1.0 + both + 0.5 * difference;
  turn_scale_ = 1.0 + random_.normal(noise_.turn_scale);
}

Pose Drive::step(double dt) {
  const double linear = std::clamp(wanted_.linear, -limits_.max_reverse, limits_.max_linear);
  const double angular = std::clamp(wanted_.angular, -limits_.max_angular, limits_.max_angular);
  wheels_.linear = pursue(wheels_.linear, linear, limits_.max_acceleration, limits_.max_deceleration, dt);
  wheels_.angular =
      pursue(wheels_.angular, angular, limits_.max_angular_acceleration, limits_.max_angular_acceleration, dt);
  odometry_ = odometry_ * arc(wheels_, dt);

  const double left = wheels_.linear - 0.5 * track * wheels_.angular;
  const double right = wheels_.linear + 0.5 * track * wheels_.angular;
  const auto wander = [&](double slip, double way) {  // Ornstein-Uhlenbeck over the way rolled
    if (way <= 0.0 || noise_.slip <= 0.0) return slip;
    const double keep = std::exp(-way / noise_.slip_length);
    return keep * slip + random_.normal(noise_.slip * std::sqrt(1.0 - keep * keep));
  };
  left_slip_ = wander(left_slip_, std::abs(left) * dt);
  right_slip_ = wander(right_slip_, std::abs(right) * dt);
  const double left_ground = left * left_scale_ * (1.0 - left_slip_);
  const double right_ground = right * right_scale_ * (1.0 - right_slip_);
  ground_ = {0.5 * (left_ground + right_ground), (right_ground - left_ground) / track * turn_scale_};
  return arc(ground_, dt);
}

}  // namespace robot::simulation
