// The model-based dynamic window (muDWA: Fox, Burgard, Thrun 1998; RHINO 4.1): twenty times a second the best of the
// velocities that the motors can reach by then and from which the robot can still stop, judged by progress along the
// path, heading, clearance and speed.
//
//   standing --task--> driving <--> turning (on the spot, when the path leads far off to a side)
//                       |    \--> blocked --(for a while, and there is room behind)--> backing_out --> driving
//                       v
//                    arriving (turning to the goal's heading) --> arrived
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "robot/body.hpp"
#include "robot/motion/arc_collision.hpp"
#include "robot/motion/scan_memory.hpp"
#include "robot/motion/virtual_sensors.hpp"
#include "robot/outputs.hpp"
#include "robot/time.hpp"

namespace robot {

struct DynamicWindowConfig {
  Seconds window{0.25};         // velocities that can be reached within this time are judged
  Seconds latency{0.15};        // from light on the sensor to force on the wheels
  Seconds lookahead{1.6};       // how far ahead the arcs are judged
  double margin = 0.05;         // m round the footprint that stays free
  double comfortable = 0.45;    // m of side clearance beyond which more is no better
  double goal_distance = 0.08;  // m
  double goal_heading = radians(4);
  int linear_samples = 9;
  int angular_samples = 25;
  double turn_speed = 0.9;   // rad/s at most
  double back_speed = 0.15;  // m/s
  Seconds patience{4.0};     // blocked for so long: back out if there is room
  double reach = 4.0;        // m; obstacles farther away do not matter to this
};

struct MotionTask {
  std::vector<Point> path;     // map frame, from the robot to the goal; empty: stand still
  Pose goal;                   // map frame
  bool final_heading = false;  // whether goal.theta matters
  double speed_limit = 0.7;    // m/s
};

enum class MotionState { standing, driving, turning, blocked, backing_out, arriving, arrived };

struct MotionChoice {
  Twist twist;
  MotionState state = MotionState::standing;
  Seconds blocked_for{0};  // since progress was last possible
  VelocitySpace space;     // what was judged, for the console
};

class DynamicWindow {
 public:
  explicit DynamicWindow(const Body& body, const DynamicWindowConfig& config = {});

  // current: measured twist. obstacles: base frame, lasers and sonar layer. hazards: virtual readings, base frame.
  MotionChoice choose(const MotionTask& task, const Pose& map_from_base, const Twist& current,
                      std::span<const Obstacle> obstacles, const VirtualReadings& hazards, Time now);
  // Forgets what it was about; call when the goal changes.
  void reset();

 private:
  struct Scene;
  struct Judged;

  Body body_;
  DynamicWindowConfig config_;
  MotionState state_ = MotionState::standing;
  std::optional<Time> blocked_since_;
  Time backing_until_;
  Twist last_;
};

}  // namespace robot
