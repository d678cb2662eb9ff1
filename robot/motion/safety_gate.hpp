// The safety gate: the last stage before the wheels. It knows nothing of plans; it looks at raw scans, odometry, the
// base's own state and the virtual readings, and lets through as much of a wanted motion as is safe.
//
//   passing --(cause)--> ramping down --> standing --(cause gone, and its hold is over)--> passing
//
//   cause, in this order   answer            held
//   base lost, or silent   zero at once      until it speaks again
//   emergency stop         zero at once      until released
//   motors off             zero at once      until on
//   bumper                 zero at once      until released and 1 s; only creeping away from it passes
//   stalled                zero at once      0.5 s
//   Stop by hand           ramp              until Resume
//   a laser stale or lost  ramp              until fresh
//   pose unknown           ramp              until known; turning slowly on the spot passes. Only where hazards exist
//   hazard ahead           slowed to what can stop in time; inside a hazard only turning and outward motion pass
//   obstacle in the way    slowed to what can stop in time; a stop is held for 0.3 s against the same direction
//
// The first cause that holds is the reason given. Whatever the cause, what passes always leaves a way to stop that is
// clear of hazards and obstacles (see stopping.hpp); when nothing does, the robot brakes.
#pragma once

#include <optional>
#include <vector>

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
  Seconds people_stale{0.5};
  Seconds pose_stale{0.5};  // virtual readings older than this do not count
  Seconds bumper_hold{1.0};
  Seconds stall_hold{0.5};
  Seconds stop_hold{0.3};      // an obstacle's stop stays at least this long
  Seconds latency{0.1};        // from a command to force on the wheels
  Seconds hold{0.05};          // from one command to the next
  double margin = 0.03;        // m round the footprint that stays free
  double hazard_margin = 0.0;  // m; the readings' own 99 % are the margin
  double reach = 3.0;          // m; a stop from full speed is shorter
  double creep_speed = 0.1;    // m/s, away from a pressed bumper
  double blind_turn = 0.4;     // rad/s, on the spot with an unknown pose
};

class SafetyGate {
 public:
  // hazards: whether the museum has places that must not be entered and that no sensor sees.
  SafetyGate(const Body& body, bool hazards, const SafetyGateConfig& config = {});

  // Each with the time at which it was heard of: Input::now.
  void add(const LaserScan& scan, Time now);
  void add(const Odometry& odometry, Time now);
  void add(const BaseState& state, Time now);
  void add(const DeviceState& state);
  // Virtual readings of the newest belief; localized: whether the belief can be trusted at all.
  void add(const VirtualReadings& readings, bool localized, Time now);
  // People as they are tracked: their bodies are wider than the legs that the lasers see.
  void add(const People& people, const Pose& map_from_base, Time now);
  void stop() { stopped_ = true; }  // by hand
  void resume() { stopped_ = false; }
  bool stopped() const { return stopped_; }
  void set_speed_limit(double linear);  // m/s

  // What of the wanted motion may go to the wheels now. Call it on every tick, and at once after stop() or a lost
  // device.
  WheelCommand limit(const Twist& wanted, Time now);

 private:
  enum class Answer { pass, ramp, zero };
  struct Verdict {
    GateReason reason = GateReason::none;
    Answer answer = Answer::pass;
    Twist allowed;  // when it passes
  };
  bool bumper_held(std::size_t side, Time now) const;
  Verdict body_verdict(const Twist& wanted, Time now) const;
  Verdict verdict(const Twist& wanted, Time now) const;
  Twist ramp_down(Seconds step) const;
  WheelCommand clear_ahead(const Twist& wanted, Time now);
  double share_that_can_stop(const Twist& twist, double contact_seconds) const;
  GateReason in_the_way(const Twist& twist, const std::vector<Point>& seen, const VirtualReadings* hazards,
                        Time now) const;
  VirtualReadings readings_now() const;
  std::vector<Point> obstacles_now(Time now) const;

  Body body_;
  SafetyGateConfig config_;
  bool hazards_ = false;
  ScanMemory scans_;
  BaseState base_;
  std::optional<Time> base_heard_, odometry_heard_, laser_heard_[2];
  bool base_connected_ = true;
  bool laser_connected_[2] = {true, true};
  VirtualReadings readings_;
  Pose readings_at_;  // odom frame
  bool localized_ = false;
  std::optional<Time> readings_heard_;
  std::vector<Point> bodies_;  // odom frame
  std::optional<Time> bodies_heard_;
  bool stopped_ = false;
  double speed_limit_ = 0.7;
  std::optional<Time> bumped_[2];  // front, rear: when it was last pressed
  std::optional<Time> stalled_;    // since when its hold runs
  std::optional<Time> held_;       // since when an obstacle stopped us
  double held_direction_ = 0.0;    // sign of the linear velocity that was stopped
  GateReason held_reason_ = GateReason::none;
  Twist last_;
  std::optional<Time> last_time_;
  struct Sent {
    Time time;
    Twist twist;
  };
  std::vector<Sent> sent_;  // what may not have reached the wheels yet
};

}  // namespace robot
