#include "robot/motion/safety_gate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "robot/geometry/random.hpp"
#include "tests/support/driven_robot.hpp"
#include "tests/support/matchers.hpp"

namespace robot {
namespace {

// A gate that is fed by healthy sensors until the test says otherwise.
class SafetyGateTest : public ::testing::Test {
 protected:
  SafetyGateTest() { state_.motors_enabled = true; }

  // Lets time pass with a wanted motion; returns the last command. The wheels follow at once.
  WheelCommand run(const Twist& wanted, double seconds = 0.05) {
    WheelCommand command;
    for (double end = seconds_ + seconds - 0.01; seconds_ < end;) {
      seconds_ += 0.05;
      feed();
      command = gate_.limit(wanted, now());
      wheels_ = command.twist;
    }
    return command;
  }
  void feed() {
    if (odometry_on_) gate_.add(Odometry{now(), pose_, wheels_}, now());
    if (base_on_) gate_.add(state_, now());
    if (front_on_) gate_.add(front_scan(), now());
    if (rear_on_) gate_.add(scan(LaserId::rear, 10.0f), now());
    if (pose_on_) gate_.add(readings_, localized_, now());
  }
  LaserScan scan(LaserId id, float range) const {
    return {now(), id, -pi / 2, pi / 180, 32.0f, std::vector<float>(181, range)};
  }
  // Something right ahead, 30 degrees wide.
  LaserScan front_scan() const {
    LaserScan ahead = scan(LaserId::front, 10.0f);
    for (std::size_t i = 75; i <= 105; ++i) ahead.ranges[i] = front_range_;
    return ahead;
  }
  Time now() const { return from_seconds(seconds_); }

  SafetyGate gate_{standard_body(), true};
  double seconds_ = 1.0;
  Pose pose_;
  Twist wheels_;
  BaseState state_;
  VirtualReadings readings_;
  bool localized_ = true;
  bool odometry_on_ = true, base_on_ = true, front_on_ = true, rear_on_ = true, pose_on_ = true;
  float front_range_ = 10.0f;
};

const Twist forward{0.5, 0.0};

TEST_F(SafetyGateTest, LetsAWantedMotionPass) {
  const auto command = run({0.5, 0.3});
  EXPECT_EQ(command.twist, (Twist{0.5, 0.3}));
  EXPECT_EQ(command.reason, GateReason::none);
}

TEST_F(SafetyGateTest, SpeedLimitsKeepTheArc) {
  gate_.set_speed_limit(0.25);
  const auto command = run({0.5, 0.4});
  EXPECT_NEAR(command.twist.linear, 0.25, 1e-9);
  EXPECT_NEAR(command.twist.angular, 0.2, 1e-9);
  EXPECT_EQ(command.reason, GateReason::slowed);
  EXPECT_NEAR(run({-1.0, 0.0}).twist.linear, -0.2, 1e-9);
  EXPECT_NEAR(run({0.0, 9.0}).twist.angular, 1.2, 1e-9);
}

TEST_F(SafetyGateTest, NumbersThatAreNoneStandStill) {
  EXPECT_EQ(run({std::numeric_limits<double>::quiet_NaN(), 0.0}).twist, Twist{});
  EXPECT_EQ(run({0.1, std::numeric_limits<double>::infinity()}).twist, Twist{});
}

TEST_F(SafetyGateTest, NothingPassesBeforeTheBaseHasSpoken) {
  base_on_ = odometry_on_ = false;
  EXPECT_EQ(run(forward).reason, GateReason::base_lost);
  EXPECT_EQ(run(forward).twist, Twist{});
}

TEST_F(SafetyGateTest, StopByHandRampsDownAndHoldsUntilResume) {
  run(forward, 0.5);
  gate_.stop();
  const auto first = gate_.limit(forward, now());  // in the same call, before any tick
  EXPECT_EQ(first.reason, GateReason::stopped_by_hand);
  double before = 0.5;
  for (int i = 0; i < 12; ++i) {
    const double speed = run(forward).twist.linear;
    EXPECT_GE(before - speed, -1e-9);
    EXPECT_LE(before - speed, 0.05 + 1e-9);  // 1 m/s2
    before = speed;
  }
  EXPECT_EQ(before, 0.0);
  EXPECT_EQ(run(forward, 5.0).reason, GateReason::stopped_by_hand);
  gate_.resume();
  EXPECT_EQ(run(forward).reason, GateReason::none);
}

TEST_F(SafetyGateTest, ASilentFrontLaserStops) {
  run(forward, 0.5);
  front_on_ = false;
  EXPECT_EQ(run(forward, 0.25).reason, GateReason::none);
  EXPECT_EQ(run(forward, 0.15).reason, GateReason::sensor_stale);
  EXPECT_EQ(run(forward, 1.0).twist, Twist{});
  front_on_ = true;
  EXPECT_EQ(run(forward).reason, GateReason::none);
}

TEST_F(SafetyGateTest, ASilentRearLaserAndALostLineStop) {
  run(forward, 0.5);
  rear_on_ = false;
  EXPECT_EQ(run(forward, 0.4).reason, GateReason::sensor_stale);
  rear_on_ = true;
  EXPECT_EQ(run(forward, 0.1).reason, GateReason::none);
  gate_.add(DeviceState{Device::laser_rear, false, "unplugged"});
  EXPECT_EQ(gate_.limit(forward, now()).reason, GateReason::sensor_stale);  // at once
}

TEST_F(SafetyGateTest, ALostBaseAndStaleOdometryStopHard) {
  run(forward, 0.5);
  gate_.add(DeviceState{Device::base, false, "unplugged"});
  EXPECT_EQ(gate_.limit(forward, now()).twist, Twist{});
  EXPECT_EQ(gate_.limit(forward, now()).reason, GateReason::base_lost);
  gate_.add(DeviceState{Device::base, true, ""});
  EXPECT_EQ(run(forward).reason, GateReason::none);
  odometry_on_ = false;
  EXPECT_EQ(run(forward, 0.4).reason, GateReason::base_lost);
}

TEST_F(SafetyGateTest, EmergencyStopAndMotorsOff) {
  run(forward, 0.5);
  state_.emergency_stop = true;
  EXPECT_EQ(run(forward).reason, GateReason::emergency_stop);
  EXPECT_EQ(run(forward).twist, Twist{});
  state_.emergency_stop = false;
  state_.motors_enabled = false;
  EXPECT_EQ(run(forward).reason, GateReason::motors_off);
  state_.motors_enabled = true;
  EXPECT_EQ(run(forward).reason, GateReason::none);
}

TEST_F(SafetyGateTest, APressedBumperAllowsOnlyCreepingAway) {
  run(forward, 0.5);
  state_.bumper_front = true;
  const auto hit = run(forward);
  EXPECT_EQ(hit.twist, Twist{});
  EXPECT_EQ(hit.reason, GateReason::bumper);
  EXPECT_EQ(run({0.0, 0.5}).twist, Twist{});
  const auto away = run({-0.2, 0.4});
  EXPECT_NEAR(away.twist.linear, -0.1, 1e-9);
  EXPECT_EQ(away.twist.angular, 0.0);
  EXPECT_EQ(away.reason, GateReason::bumper);
  state_.bumper_front = false;
  EXPECT_EQ(run(forward, 0.9).reason, GateReason::bumper);  // held for a second after release
  EXPECT_EQ(run(forward, 0.2).reason, GateReason::none);
  state_.bumper_front = state_.bumper_rear = true;
  EXPECT_EQ(run({-0.2, 0.0}).twist, Twist{});
}

TEST_F(SafetyGateTest, StalledWheelsRestForAMoment) {
  run(forward, 0.5);
  state_.stalled = true;
  EXPECT_EQ(run(forward).twist, Twist{});
  state_.stalled = false;
  EXPECT_EQ(run(forward, 0.4).twist, Twist{});
  EXPECT_EQ(run(forward, 0.2).twist, forward);
}

TEST_F(SafetyGateTest, AnUnknownPoseNearHazardsAllowsOnlySlowTurning) {
  localized_ = false;
  EXPECT_EQ(run(forward, 1.0).twist, Twist{});
  EXPECT_EQ(run(forward).reason, GateReason::pose_unknown);
  EXPECT_NEAR(run({0.0, 1.0}).twist.angular, 0.4, 1e-9);
  localized_ = true;
  EXPECT_EQ(run(forward).reason, GateReason::none);
  pose_on_ = false;
  EXPECT_EQ(run(forward, 0.7).reason, GateReason::pose_unknown);
}

TEST_F(SafetyGateTest, WhereThereAreNoHazardsThePoseDoesNotMatter) {
  gate_ = SafetyGate(standard_body(), false);
  pose_on_ = false;
  EXPECT_EQ(run(forward, 1.0).reason, GateReason::none);
}

TEST_F(SafetyGateTest, AnObstacleInTheWaySlowsThenStopsAndHolds) {
  front_range_ = 0.55f;  // from the laser 0.22 m ahead: 0.47 m before the front edge
  const auto near = run({0.7, 0.0});
  EXPECT_EQ(near.reason, GateReason::none);
  run({0.3, 0.0}, 0.2);
  front_range_ = 0.35f;
  const auto nearer = run({0.7, 0.0});
  EXPECT_EQ(nearer.reason, GateReason::slowed);
  EXPECT_LT(nearer.twist.linear, 0.6);
  EXPECT_GT(nearer.twist.linear, 0.2);
  front_range_ = 0.11f;
  EXPECT_EQ(run({0.7, 0.0}).reason, GateReason::obstacle);
  front_range_ = 10.0f;
  EXPECT_EQ(run({0.7, 0.0}, 0.25).twist, Twist{});  // held for 0.3 s
  EXPECT_EQ(run({0.7, 0.0}, 0.1).reason, GateReason::none);
  front_range_ = 0.11f;
  EXPECT_EQ(run({0.7, 0.0}, 0.2).reason, GateReason::obstacle);
  EXPECT_EQ(run({-0.2, 0.0}).reason, GateReason::none);  // away is free at once
}

TEST_F(SafetyGateTest, WhatLiesBesideTheWayDoesNotMatter) {
  // Points 0.30 m to both sides: the body is 0.26 m wide on each side.
  seconds_ += 0.05;
  feed();
  LaserScan corridor = scan(LaserId::front, 0.0f);
  for (std::size_t i = 0; i < corridor.ranges.size(); ++i) {
    const double across = std::abs(std::sin(-pi / 2 + static_cast<double>(i) * pi / 180));
    corridor.ranges[i] = across > 0.05 ? static_cast<float>(0.30 / across) : 10.0f;
  }
  gate_.add(corridor, now());
  EXPECT_EQ(gate_.limit({0.7, 0.0}, now()).reason, GateReason::none);
  EXPECT_NE(gate_.limit({0.0, 1.0}, now()).reason, GateReason::none);  // but the corners would sweep it
}

TEST_F(SafetyGateTest, AHazardAheadStopsAndInsideOneOnlyTheWayOutPasses) {
  readings_.clearance = 0.5;
  readings_.outward = {-1.0, 0.0};
  readings_.points = {{0.301, 0.0}};
  EXPECT_EQ(run(forward).reason, GateReason::hazard);
  EXPECT_EQ(run({-0.2, 0.0}).reason, GateReason::none);
  readings_.clearance = -0.2;
  readings_.points = {{0.0, 0.0}};
  EXPECT_EQ(run(forward, 0.5).twist, Twist{});
  EXPECT_EQ(run(forward).reason, GateReason::hazard);
  EXPECT_EQ(run({-0.2, 0.0}).reason, GateReason::none);
  EXPECT_EQ(run({0.0, 0.5}).reason, GateReason::none);
}

// The promise: whatever is wanted, with commands up to 0.1 s late and scans 20 times a second, a robot never touches
// what stands still.
RC_GTEST_PROP(SafetyGateProperty, StopsBeforeContactWhateverIsWanted, (std::uint64_t seed)) {
  Random random(seed);
  OccupancyGrid room(120, 120, 0.05, {-3.0, -3.0}, free_cell);
  for (int i = 0; i < 120; ++i) room[{i, 0}] = room[{i, 119}] = room[{0, i}] = room[{119, i}] = occupied_cell;
  testing::DrivenRobot robot(room, {0.0, 0.0, random.uniform(-pi, pi)}, random.uniform(0.0, 0.1));
  for (int i = 0; i < 6; ++i) {
    const Point p{random.uniform(-2.5, 2.5), random.uniform(-2.5, 2.5)};
    if (norm(p) > 0.8) robot.discs().push_back({p, {}, random.uniform(0.06, 0.3)});
  }
  SafetyGate gate(robot.body(), false);
  gate.set_speed_limit(random.uniform(0.3, 1.63));
  Twist wanted;
  for (int tick = 0; tick < 200; ++tick) {
    if (tick % 20 == 0) wanted = {random.uniform(-0.3, 1.7), random.chance(0.4) ? 0.0 : random.uniform(-1.2, 1.2)};
    BaseState state;
    state.motors_enabled = true;
    gate.add(robot.odometry(), robot.now());
    gate.add(state, robot.now());
    gate.add(robot.scan(LaserId::front), robot.now());
    gate.add(robot.scan(LaserId::rear), robot.now());
    robot.drive(gate.limit(wanted, robot.now()).twist, 0.05);
    RC_ASSERT(robot.gap_to_people() > 0.0);
    RC_ASSERT(!robot.touches_wall());
  }
}

}  // namespace
}  // namespace robot
