#include "protocols/serial/p2os_base.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace serial::p2os {
namespace {

using robot::Pose;
using robot::Twist;

const Model& dx() { return model_of("p3dx-sh"); }

Sip through_the_wire(const Sip& sip) {
  PacketDecoder decoder;
  decoder.feed(encode_sip(sip));
  return *parse_sip(*decoder.next());
}

TEST(P2osBase, ModelsAreFoundWhateverTheirCase) {
  EXPECT_EQ(model_of("P3AT").subclass, "p3at");
  EXPECT_EQ(model_of("PeopleBot-SH").subclass, "peoplebot-sh");
  EXPECT_EQ(model_of("something else").subclass, "p3dx-sh");
}

TEST(P2osBase, OdometryGoesOnAcrossTheWrap) {
  OdometryTracker tracker(dx());
  Pose last;
  for (int i = 0; i <= 1000; ++i) {
    Sip sip;
    sip.x = static_cast<std::uint16_t>((32000 + 80 * i) & 0x7FFF);
    sip.y = static_cast<std::uint16_t>((100 - 80 * i) & 0x7FFF);
    last = tracker.update(through_the_wire(sip)).odom_from_base;
  }
  EXPECT_NEAR(last.x, 80.0, 1e-9);
  EXPECT_NEAR(last.y, -80.0, 1e-9);
}

TEST(P2osBase, TheFirstPacketIsZeroAndANewConnectionGoesOn) {
  OdometryTracker tracker(dx());
  Sip sip;
  sip.x = 500;
  sip.theta = 1024;
  EXPECT_EQ(tracker.update(sip).odom_from_base.x, 0.0);
  sip.y = 1000;  // along the heading it had at first
  EXPECT_NEAR(tracker.update(sip).odom_from_base.x, 1.0, 1e-9);
  tracker.reconnected(dx());
  EXPECT_NEAR(tracker.update(Sip{}).odom_from_base.x, 1.0, 1e-9);
}

TEST(P2osBase, TurningComesFromTheGyroFieldOrTheWheels) {
  OdometryTracker tracker(dx());
  Sip sip;
  sip.left = -100;
  sip.right = 100;
  EXPECT_NEAR(tracker.update(sip).twist.angular, 0.56, 1e-9);
  sip.rotation_ddeg = 300;
  EXPECT_NEAR(tracker.update(sip).twist.angular, robot::radians(30.0), 1e-9);
}

TEST(P2osBase, StateNamesBumpersStallsAndStops) {
  Sip sip;
  sip.battery_dv = 126;
  sip.front_bumpers = 4;
  sip.right_stall = true;
  sip.flags = flag_motors | flag_stop_button;
  robot::BaseState state = base_state(through_the_wire(sip));
  EXPECT_NEAR(state.battery_volts, 12.6, 1e-9);
  EXPECT_NEAR(state.battery_fraction, 1.6 / 1.7, 1e-9);
  EXPECT_TRUE(state.bumper_front);
  EXPECT_FALSE(state.bumper_rear);
  EXPECT_TRUE(state.stalled);
  EXPECT_TRUE(state.motors_enabled);
  EXPECT_TRUE(state.emergency_stop);
  sip.battery_dv = 0;
  EXPECT_LT(base_state(sip).battery_fraction, 0.0);
}

TEST(P2osBase, SonarsWithoutEchoAreNaN) {
  Sip sip;
  sip.sonars = {{0, 1500}, {7, 5000}};
  const auto scan = sonar_scan(sip, dx());
  ASSERT_EQ(scan.readings.size(), 2u);
  EXPECT_FLOAT_EQ(scan.readings[0].range, 1.5f);
  EXPECT_EQ(scan.readings[1].sonar, 7);
  EXPECT_TRUE(std::isnan(scan.readings[1].range));
}

// The set-points in the two packets.
Twist sent(const Bytes& bytes) {
  PacketDecoder decoder;
  decoder.feed(bytes);
  const auto linear = parse_command(*decoder.next());
  const auto angular = parse_command(*decoder.next());
  EXPECT_TRUE(linear->is(Command::vel));
  EXPECT_TRUE(angular->is(Command::rvel));
  EXPECT_FALSE(decoder.next());
  return {*linear->argument / 1000.0, robot::radians(*angular->argument)};
}

TEST(VelocityEncoder, StandingStillIsExactlyZero) {
  VelocityEncoder encoder;
  encoder.encode({0.3337, 0.1});
  EXPECT_EQ(sent(encoder.encode({})), Twist{});
  EXPECT_EQ(sent(encoder.encode({NAN, INFINITY})), Twist{});
}

RC_GTEST_PROP(VelocityEncoder, TheSumOfWhatWasSentFollowsTheSumOfWhatWasWanted, ()) {
  VelocityEncoder encoder;
  double linear = 0.0, angular = 0.0;
  const int steps = *rc::gen::inRange(1, 200);
  for (int i = 0; i < steps; ++i) {
    const Twist wanted{*rc::gen::inRange(1, 1630000) * 1e-6, *rc::gen::inRange(1, 2000000) * 1e-6};
    const Twist out = sent(encoder.encode(wanted));
    linear += out.linear - wanted.linear;
    angular += out.angular - wanted.angular;
    RC_ASSERT(std::abs(out.linear - wanted.linear) <= 0.001 + 1e-9);
    RC_ASSERT(std::abs(out.angular - wanted.angular) <= robot::radians(1.0) + 1e-9);
    RC_ASSERT(std::abs(linear) <= 0.0005 + 1e-9);
    RC_ASSERT(std::abs(angular) <= robot::radians(0.5) + 1e-9);
  }
}

RC_GTEST_PROP(P2osBase, ReadingsSurviveTheWire, ()) {
  const double x = *rc::gen::inRange(-40000, 40000) * 1e-3, y = *rc::gen::inRange(-40000, 40000) * 1e-3;
  const double theta = *rc::gen::inRange(-3141, 3141) * 1e-3;
  BaseReading before, after;
  // Near enough to the wrap-around that one step leads across it.
  before.odometry.odom_from_base = {x, y, theta};
  after.odometry.odom_from_base = {x + *rc::gen::inRange(-99, 100) * 1e-3, y + *rc::gen::inRange(-99, 100) * 1e-3,
                                   theta};
  after.odometry.twist = {*rc::gen::inRange(-1600, 1600) * 1e-3, *rc::gen::inRange(-2000, 2000) * 1e-3};
  after.state.battery_volts = *rc::gen::inRange(0, 255) / 10.0;
  after.state.motors_enabled = *rc::gen::arbitrary<bool>();
  after.state.bumper_rear = *rc::gen::arbitrary<bool>();
  after.sonars = {{23, *rc::gen::inRange(0, 4999) * 0.001f}};
  OdometryTracker tracker(dx());
  tracker.update(through_the_wire(to_sip(before, dx())));
  const Sip sip = through_the_wire(to_sip(after, dx()));
  const auto odometry = tracker.update(sip);
  const Pose step = robot::relative(before.odometry.odom_from_base, after.odometry.odom_from_base);
  RC_ASSERT(std::abs(odometry.odom_from_base.x - step.x) < 0.0022);
  RC_ASSERT(std::abs(odometry.odom_from_base.y - step.y) < 0.0022);
  RC_ASSERT(std::abs(odometry.twist.linear - after.odometry.twist.linear) < 0.0011);
  RC_ASSERT(std::abs(odometry.twist.angular - after.odometry.twist.angular) < robot::radians(0.051));
  const auto state = base_state(sip);
  RC_ASSERT(std::abs(state.battery_volts - after.state.battery_volts) < 0.051);
  RC_ASSERT(state.motors_enabled == after.state.motors_enabled);
  RC_ASSERT(state.bumper_rear == after.state.bumper_rear);
  RC_ASSERT(sonar_scan(sip, dx()).readings[0].sonar == 23);
}

}  // namespace
}  // namespace serial::p2os
