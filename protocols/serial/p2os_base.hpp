// A Pioneer's counts as the robot's values and back: odometry unwrapped, speeds, battery, bumpers, sonars, and wheel
// commands as whole millimetres and degrees a second.
#pragma once

#include <optional>
#include <string_view>

#include "protocols/serial/p2os.hpp"
#include "robot/inputs.hpp"

namespace serial::p2os {

// Conversion constants of a model (from the ARIA parameter files).
struct Model {
  std::string_view subclass;
  double radians_per_count;   // 2 pi / 4096 except on the Pioneer 1
  double mm_per_count;        // odometry
  double mm_per_s_per_count;  // velocities
  double mm_per_sonar_count;
  double turn_per_speed_difference;  // rad/s for (right - left) / 2 in mm/s: 1 / half track
  int vel2_divisor_mm;               // mm/s
};
// By subclass, upper or lower case; an unknown one gets the p3dx-sh's constants.
const Model& model_of(std::string_view subclass);

// Follows the base's 15-bit odometry across its wraps, so that the pose is smooth and unbounded. Its zero is where the
// base was at the first packet.
class OdometryTracker {
 public:
  explicit OdometryTracker(const Model& model) : model_(&model) {}
  // The base's pose and measured twist. Time is left at zero for the caller.
  robot::Odometry update(const Sip& sip);
  // How far the base says to have moved since the last packet, m; 0 for the first.
  double step(const Sip& sip) const;
  // A new connection to the same base: its counts may have started again, the pose goes on from where it was.
  void reconnected(const Model& model);

 private:
  const Model* model_;
  bool started_ = false;
  std::uint16_t last_x_ = 0, last_y_ = 0;
  std::int64_t x_counts_ = 0, y_counts_ = 0;
  robot::Pose odom_from_counts_;  // where the base's own zero lies in the odom frame
  robot::Pose last_;              // odom_from_base of the last packet
};

double fastest_wheel(const Sip& sip, const Model& model);  // m/s, of either
robot::BaseState base_state(const Sip& sip);
robot::SonarScan sonar_scan(const Sip& sip, const Model& model);

// Which set-points go out. VEL and RVEL carry whole mm/s and deg/s; VEL2 would carry both wheels in steps of 20 mm/s,
// which is 3 deg/s on a Pioneer 3, so VEL and RVEL are the finer pair. What rounding leaves over is carried into the
// next command (error diffusion): at 20 commands a second the mean speeds are exact and the heading stays within 0.5
// deg/s * 50 ms = 0.025 degrees of the wanted one. Standing still is always exactly zero.
class VelocityEncoder {
 public:
  // The two packets, VEL first. A speed that is not finite stops the base. Limited to the 16 bits of the wire.
  Bytes encode(const robot::Twist& twist);
  void reset() { left_over_ = {}; }

 private:
  robot::Twist left_over_;  // mm/s and deg/s
};

// The base's side of the same conversions.
struct BaseReading {
  robot::Odometry odometry;
  robot::BaseState state;
  std::vector<robot::SonarReading> sonars;
};
Sip to_sip(const BaseReading& reading, const Model& model);

}  // namespace serial::p2os
