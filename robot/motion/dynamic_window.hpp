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
#include "robot/motion/path_ahead.hpp"
#include "robot/motion/scan_memory.hpp"
#include "robot/motion/virtual_sensors.hpp"
#include "robot/outputs.hpp"
#include "robot/time.hpp"

namespace robot {

struct DynamicWindowConfig {
  Seconds window{0.25};              // velocities that can be reached within this time are judged
  Seconds latency{0.15};             // from light on the sensor to force on the wheels
  Seconds lookahead{1.6};            // how far ahead the arcs are judged
  Seconds prediction{0.5};           // walking people count where they are and all the way they go in this time
  double margin = 0.05;              // m round the footprint that stays free
  double comfortable = 0.4;          // m of clearance beyond which more is no better
  double goal_distance = 0.08;       // m
  double goal_heading = radians(4);  // rad
  double goal_deceleration = 0.3;    // m/s2 towards the goal
  int linear_samples = 9;
  int angular_samples = 25;
  double turn_speed = 0.9;   // rad/s at most
  double turn_from = 1.05;   // rad off the path from which the robot turns on the spot, to
  double turn_to = 0.3;      // rad
  double back_speed = 0.15;  // m/s
  Seconds back_time{1.6};    // how long it backs out
  Seconds patience{4.0};     // blocked for so long: back out if there is room
  double reach = 3.0;        // m; obstacles farther away do not matter to this
  // Weights of the soft constraints; progress at the speed limit counts 1.
  double offset_weight = 0.9;   // a metre off the path
  double heading_weight = 0.3;  // 1 - cos of the heading off the path
  double clearance_weight = 0.35;
  double haste_weight = 0.8;     // a m/s too fast for the clearance
  double turning_weight = 0.06;  // a rad/s away from the last command
};

struct MotionTask {
  std::vector<Point> path;     // map frame, from the robot to where it shall arrive; empty: stand still
  Pose goal;                   // map frame; the path may end beside it, where the robot can stand
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
  explicit DynamicWindow(const Body& body, const DynamicWindowConfig& config = {}) : body_(body), config_(config) {}

  // current: measured twist. obstacles: base frame, lasers and sonar layer. hazards: virtual readings, base frame.
  MotionChoice choose(const MotionTask& task, const Pose& map_from_base, const Twist& current,
                      std::span<const Obstacle> obstacles, const VirtualReadings& hazards, Time now);
  // Forgets what it was about; call when the goal changes.
  void reset();

 private:
  // What there is to judge arcs by, base frame.
  struct Scene {
    PathAhead path;
    PointColumns solid;  // what stands, and walkers where they are and soon will be
    PointColumns hazard;
    PointColumns near;               // what stands near enough to matter for clearance
    PointColumns walking, velocity;  // who walks there, and how
    const VirtualReadings* readings = nullptr;
    Twist current;
    double speed_limit = 0.0;  // m/s, the goal's distance included
  };
  struct Best {
    Twist twist;
    double score = 0.0;
    double progress = 0.0;  // m
  };

  Scene look(const MotionTask& task, const Pose& map_from_base, const Twist& current,
             std::span<const Obstacle> obstacles, const VirtualReadings& hazards) const;
  double contact(const Scene& scene, const Twist& twist) const;
  bool can_stop(const Twist& twist, double contact_seconds) const;
  double clearance(const Scene& scene, const Twist& twist, double seconds) const;
  std::optional<Best> judge(const Scene& scene, const Twist& twist) const;
  Best best_of_window(const Scene& scene, VelocitySpace& space) const;
  std::optional<Twist> turn_by(const Scene& scene, double angle) const;
  std::optional<Twist> back_out(const Scene& scene) const;
  Twist leave_hazard(const Scene& scene) const;
  void drive(const Scene& scene, double bearing, Time now, MotionChoice& choice);
  void note_progress(bool progress, Time now, MotionChoice& choice);

  Body body_;
  DynamicWindowConfig config_;
  MotionState state_ = MotionState::standing;
  std::optional<Time> blocked_since_;
  std::optional<Time> backing_since_;
  Twist last_;
};

}  // namespace robot
