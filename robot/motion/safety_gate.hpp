// The safety gate: the last stage before the wheels. It knows nothing of plans; it looks at raw scans, odometry, the
// base's own state and the virtual readings, and lets through as much of a wanted motion as is safe.
//
//   passing --(cause)--> ramping down --> standing --(cause gone, and its hold is over)--> passing
//
//   cause               answer                   held
//   base lost           zero at once             until it is back
//   emergency stop      zero at once             until released
//   bumper              zero at once             until released and 1 s; only motion away from it passes
//   Stop by hand        ramp                     until Resume
//   motors off          zero at once             until on
//   odometry stale      ramp                     until fresh
//   laser stale (front or rear), pose unknown    ramp; until fresh (turning on the spot passes with an unknown pose)
//   obstacle in the swept path                   slowed to what can stop in time; a stop is held for 0.3 s
//   hazard (virtual readings)                    the same; inside a hazard only outward motion passes
//   stalled             zero at once             0.5 s
//
// The first cause that holds, in this order, is the reason given.
#pragma once

#include <optional>

#include "robot/body.hpp"
#include "robot/inputs.hpp"
#include "robot/motion/arc_collision.hpp"
#include "robot/motion/scan_memory.hpp"
#include "robot/motion/virtual_sensors.hpp"
#include "robot/outputs.hpp"
#include "robot/time.hpp"

namespace robot {

struct SafetyGateConfig {
  Seconds laser_stale{0.3};
  Seconds odometry_stale{0.3};
  Seconds pose_stale{0.5};  // virtual readings older than this do not count
  Seconds bumper_hold{1.0};
  Seconds stall_hold{0.5};
  Seconds stop_hold{0.3};  // an obstacle's stop stays at least this long
  Seconds latency{0.15};
  double margin = 0.02;      // m round the footprint that stays free
  double reach = 4.0;        // m
  double creep_speed = 0.1;  // m/s, away from a pressed bumper
};

class SafetyGate {
 public:
  // hazards: whether the museum has places that must not be entered and that no sensor sees.
  SafetyGate(const Body& body, bool hazards, const SafetyGateConfig& config = {});

  void add(const LaserScan& scan);
  void add(const Odometry& odometry);
  void add(const BaseState& state);
  void add(const DeviceState& state);
  // Virtual readings of the newest belief; localized: whether the belief can be trusted at all.
  void add(const VirtualReadings& readings, bool localized, Time now);
  void stop();  // by hand
  void resume();
  bool stopped() const { return stopped_; }
  void set_speed_limit(double linear) { speed_limit_ = linear; }  // m/s

  // What of the wanted motion may go to the wheels now. Call it on every tick, and at once after stop() or a lost
  // device.
  WheelCommand limit(const Twist& wanted, Time now);

 private:
  struct Verdict {
    GateReason reason = GateReason::none;
    bool hard = false;  // zero at once
  };
  Verdict standing_cause(const Twist& wanted, Time now);
  Twist ramp_down(Time now) const;
  Twist clear_of_obstacles(const Twist& wanted, Time now, GateReason& reason);

  Body body_;
  SafetyGateConfig config_;
  bool hazards_ = false;
  ScanMemory scans_;
  BaseState base_;
  bool base_seen_ = false;
  bool base_connected_ = true;
  bool laser_connected_[2] = {true, true};
  VirtualReadings readings_;
  bool localized_ = false;
  std::optional<Time> readings_time_;
  bool stopped_ = false;
  double speed_limit_ = 0.7;
  std::optional<Time> bumper_until_[2];  // front, rear
  std::optional<Time> stalled_until_;
  std::optional<Time> held_until_;  // a stop for an obstacle
  GateReason held_reason_ = GateReason::none;
  Twist last_;
  std::optional<Time> last_time_;
};

}  // namespace robot
