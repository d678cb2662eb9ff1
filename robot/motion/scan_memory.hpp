// The newest sweep of each laser as points, carried along by odometry: what is round the robot now, seen from the base.
// What slips out of both lasers' sight beside the body, between them, is remembered for a while.
// Shared by the dynamic window and, in its own copy, by the safety gate.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "robot/body.hpp"
#include "robot/inputs.hpp"
#include "robot/outputs.hpp"
#include "robot/time.hpp"

namespace robot {

// Something to keep clear of, base frame.
struct Obstacle {
  Point position;  // m
  Point velocity;  // m/s over ground, along the base's axes
};

class ScanMemory {
 public:
  explicit ScanMemory(const Body& body) : body_(body) {}

  void add(const Odometry& odometry);
  // Beams that did not return, are not finite or lie beyond the laser's range are left out.
  void add(const LaserScan& scan);

  // Points of all lasers within reach (m) of the base, in the base frame at the newest odometry.
  std::vector<Point> points(double reach) const;
  // Where the base was in the odom frame, between (or near) the odometry known; none before the first.
  std::optional<Pose> odom_from_base(Time time) const;
  const Odometry& odometry() const { return newest_; }
  bool has_odometry() const { return count_ > 0; }
  // Time of the newest sweep of a laser.
  std::optional<Time> scanned(LaserId laser) const;

 private:
  struct Sweep {
    bool seen = false;
    Time time;
    std::vector<Point> points;  // odom frame
  };
  struct Unseen {
    Time time;
    Point point;  // odom frame
  };
  static constexpr std::size_t history = 32;

  bool hidden(Point base_point) const;
  void remember_hidden(const Sweep& old, const Pose& base_from_odom, Time now);

  Body body_;
  std::array<Odometry, history> odometry_{};  // ring
  std::size_t count_ = 0;
  Odometry newest_;
  std::array<Sweep, 2> sweeps_;
  std::vector<Unseen> unseen_;
};

// Lasers see legs; the body above them is wider. Points round each person's body, map frame (m).
std::vector<Point> body_outline(const PersonSeen& person);

// Points near tracked people get those people's motion, all others stand still; and the people's bodies are added.
std::vector<Obstacle> with_motion(std::span<const Point> base_points, const People& people, const Pose& map_from_base);

}  // namespace robot
