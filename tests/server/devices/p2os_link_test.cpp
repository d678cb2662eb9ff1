#include "server/devices/p2os_link.hpp"

#include <gmock/gmock.h>

#include "robot/geometry/random.hpp"
#include "tests/server/devices/line_bench.hpp"

namespace devices {
namespace {

using robot::BaseState;
using robot::Device;
using robot::Odometry;

TEST(P2osLink, OpensTheBaseRaisesTheRateAndListens) {
  BaseBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.count<Odometry>() >= 5; })) << bench.state(Device::base);
  EXPECT_EQ(bench.base->baud(), 115200);
  EXPECT_EQ(bench.link->statistics().baud, 115200);
  EXPECT_EQ(bench.link->statistics().identity, "Docent Pioneer peoplebot-sh");
  const BaseState state = bench.all<BaseState>().back();
  EXPECT_NEAR(state.battery_volts, 12.6, 0.06);
  EXPECT_NEAR(state.battery_fraction, 0.8, 0.006);
  EXPECT_FALSE(state.motors_enabled);
  const auto sonars = bench.all<robot::SonarScan>().back();
  ASSERT_EQ(sonars.readings.size(), 2u);
  EXPECT_EQ(sonars.readings[0].sonar, 3);
  EXPECT_NEAR(sonars.readings[0].range, 1.5f, 0.001f);
  EXPECT_TRUE(std::isnan(sonars.readings[1].range));
}

TEST(P2osLink, StaysAtTheHostRateWhenTheBaseCannotSwitch) {
  BaseBench bench({.may_switch_baud = false});
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.count<Odometry>() >= 5; })) << bench.state(Device::base);
  EXPECT_EQ(bench.base->baud(), 9600);
}

TEST(P2osLink, TheWheelsTurnOnlyWithMotorsOn) {
  BaseBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.listening(); }));
  bench.drive({0.4, 0.0}, 300ms);
  EXPECT_EQ(bench.twist, robot::Twist{});
  bench.link->enable({true});
  bench.drive({0.4, 0.2}, 1500ms);
  EXPECT_NEAR(bench.twist.linear, 0.4, 0.0011);
  EXPECT_NEAR(bench.twist.angular, 0.2, robot::radians(1.0));
  EXPECT_GT(bench.pose.x, 0.1);
  const Odometry odometry = bench.all<Odometry>().back();
  EXPECT_NEAR(odometry.odom_from_base.x, bench.pose.x, 0.1);
  EXPECT_NEAR(odometry.twist.linear, 0.4, 0.002);
}

TEST(P2osLink, MeanTurningIsFinerThanTheWiresDegrees) {
  BaseBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.listening(); }));
  bench.link->enable({true});
  // 0.3 deg/s: the wire only knows 0 and 1.
  const double wanted = robot::radians(0.3);
  bench.drive({0.0, wanted}, 500ms);
  const double from = bench.pose.theta;
  const Instant begin = std::chrono::steady_clock::now();
  bench.drive({0.0, wanted}, 3s);
  const double rate =
      (bench.pose.theta - from) / std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_NEAR(robot::degrees(rate), 0.3, 0.12);
}

TEST(P2osLink, WithoutFreshCommandsTheWheelsStop) {
  BaseBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.listening(); }));
  bench.link->enable({true});
  bench.drive({0.4, 0.0}, 1s);
  ASSERT_GT(bench.twist.linear, 0.3);
  EXPECT_TRUE(bench.run_until([&] { return bench.base->wanted() == robot::Twist{}; }, 1500ms));
  EXPECT_TRUE(bench.run_until([&] { return bench.twist == robot::Twist{}; }));
}

TEST(P2osLink, CommandsOutOfLimitsOrNotFiniteNeverReachTheWheels) {
  BaseBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.listening(); }));
  bench.link->enable({true});
  bench.drive({50.0, -9.0}, 100ms);
  EXPECT_NEAR(bench.base->wanted().linear, 1.63, 0.0011);
  EXPECT_NEAR(bench.base->wanted().angular, -1.2, robot::radians(1.0));
  bench.drive({NAN, 0.1}, 100ms);
  EXPECT_EQ(bench.base->wanted(), robot::Twist{});
  bench.drive({-1.0, INFINITY}, 100ms);
  EXPECT_EQ(bench.base->wanted(), robot::Twist{});
}

TEST(P2osLink, ABumperStopsAtOnce) {
  BaseBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.listening(); }));
  bench.link->enable({true});
  bench.drive({1.0, 0.0}, 2s);
  ASSERT_GT(bench.twist.linear, 0.8);
  bench.state_now.bumper_front = true;
  ASSERT_TRUE(bench.run_until([&] { return bench.all<BaseState>().back().bumper_front; }));
  bench.link->drive({{}, robot::GateReason::bumper});
  EXPECT_TRUE(bench.run_until([&] { return bench.base->reference() == robot::Twist{}; }, 200ms));
}

TEST(P2osLink, UnpluggedWhileMovingItIsLostAndTheBaseStopsByItself) {
  BaseBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.listening(); }));
  bench.link->enable({true});
  bench.drive({0.4, 0.0}, 1s);
  bench.line->unplug();
  ASSERT_TRUE(bench.run_until([&] { return !bench.connected(Device::base); }));
  EXPECT_GT(bench.twist.linear, 0.3);  // nobody can tell it
  EXPECT_TRUE(bench.run_until([&] { return bench.twist == robot::Twist{}; }, 6s));
  bench.line->plug();
  ASSERT_TRUE(bench.run_until([&] { return bench.connected(Device::base); }));
  // What was commanded before is over, and the motors wait to be asked for.
  bench.run_for(300ms);
  EXPECT_EQ(bench.twist, robot::Twist{});
  EXPECT_EQ(bench.base->wanted(), robot::Twist{});
  EXPECT_FALSE(bench.all<BaseState>().back().motors_enabled);
}

TEST(P2osLink, OdometryGoesOnWhereItWasAfterABreak) {
  BaseBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.listening(); }));
  bench.link->enable({true});
  bench.drive({0.5, 0.5}, 1s);
  bench.line->unplug();
  ASSERT_TRUE(bench.run_until([&] { return !bench.connected(Device::base); }));
  const Odometry before = bench.all<Odometry>().back();
  const auto heard = bench.count<Odometry>();
  ASSERT_TRUE(bench.run_until([&] { return bench.twist == robot::Twist{}; }, 6s));
  bench.line->plug();
  ASSERT_TRUE(bench.run_until([&] { return bench.count<Odometry>() > heard; }));
  const Odometry after = bench.all<Odometry>().back();
  EXPECT_NEAR(after.odom_from_base.x, before.odom_from_base.x, 1e-9);
  EXPECT_NEAR(after.odom_from_base.theta, before.odom_from_base.theta, 1e-9);
}

TEST(P2osLink, ASilentBaseIsLost) {
  BaseBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.listening(); }));
  bench.base->set_silent(true);
  ASSERT_TRUE(bench.run_until([&] { return !bench.connected(Device::base); }));
  EXPECT_THAT(bench.state(Device::base), testing::HasSubstr("said nothing"));
  bench.base->set_silent(false);
  EXPECT_TRUE(bench.run_until([&] { return bench.connected(Device::base); }));
}

TEST(P2osLink, AConnectionLeftOpenByACrashedHostIsTakenOver) {
  BaseBench bench;
  // Somebody shook hands at 9600 and vanished.
  const Instant now = std::chrono::steady_clock::now();
  for (const auto step : {0, 1, 2, 1})
    bench.base->receive(serial::p2os::encode(static_cast<serial::p2os::Command>(step)), now);
  ASSERT_TRUE(bench.base->open());
  bench.base->take_output();
  bench.link->start();
  EXPECT_TRUE(bench.run_until([&] { return bench.listening(); })) << bench.state(Device::base);
}

TEST(P2osLink, AHandshakeCutInTheMiddleStartsOver) {
  BaseBench bench;
  const Instant now = std::chrono::steady_clock::now();
  for (const auto step : {0, 1})
    bench.base->receive(serial::p2os::encode(static_cast<serial::p2os::Command>(step)), now);
  bench.base->take_output();
  bench.link->start();
  EXPECT_TRUE(bench.run_until([&] { return bench.listening(); })) << bench.state(Device::base);
}

TEST(P2osLink, GarbageOnTheLineNeverBecomesOdometry) {
  BaseBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.listening(); }));
  robot::Random random(3);
  for (int i = 0; i < 15; ++i) {
    serial::Bytes noise(1 + random.index(40));
    for (auto& byte : noise) byte = static_cast<std::uint8_t>(random());
    if (i % 3 == 0) noise.insert(noise.end(), {0xFA, 0xFB, 0x21, 0x33});  // the head of a packet that never ends
    bench.line->inject(noise);
    const auto before = bench.count<Odometry>();
    ASSERT_TRUE(bench.run_until([&] { return bench.count<Odometry>() > before; })) << "after noise " << i;
  }
  for (const Odometry& odometry : bench.all<Odometry>()) EXPECT_EQ(odometry.odom_from_base, robot::Pose{});
}

TEST(P2osLink, APacketThatNoBaseCouldMeanIsNotBelieved) {
  BaseBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.listening(); }));
  serial::p2os::Sip far_away;
  far_away.x = 9000;
  bench.line->inject(serial::p2os::encode_sip(far_away));
  serial::p2os::Sip too_fast;
  too_fast.left = too_fast.right = 20000;
  bench.line->inject(serial::p2os::encode_sip(too_fast));
  const auto before = bench.count<Odometry>();
  ASSERT_TRUE(bench.run_until([&] { return bench.count<Odometry>() > before + 5; }));
  for (const Odometry& odometry : bench.all<Odometry>()) {
    EXPECT_EQ(odometry.odom_from_base, robot::Pose{});
    EXPECT_EQ(odometry.twist, robot::Twist{});
  }
}

TEST(P2osLink, ABaseThatBeganItsOdometryAnewIsFollowed) {
  BaseBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.listening(); }));
  bench.pose = {5.0, 5.0, 0.0};
  const auto before = bench.count<Odometry>();
  ASSERT_TRUE(bench.run_until([&] { return bench.count<Odometry>() > before + 5; }));
  EXPECT_TRUE(bench.connected(Device::base));
  EXPECT_EQ(bench.all<Odometry>().back().odom_from_base, robot::Pose{});
}

TEST(P2osLink, ALineFullOfDamageIsGivenUp) {
  BaseBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.listening(); }));
  serial::Bytes damaged = serial::p2os::encode_sip({});
  damaged[8] ^= 0x10;
  EXPECT_TRUE(bench.run_until([&] {
    bench.line->inject(damaged);
    return !bench.connected(Device::base);
  }));
  EXPECT_THAT(bench.state(Device::base), testing::HasSubstr("too noisy"));
}

TEST(P2osLink, StoppingHaltsAndClosesTheBase) {
  BaseBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.listening(); }));
  bench.link->enable({true});
  bench.drive({0.4, 0.0}, 500ms);
  bench.link->stop();
  EXPECT_TRUE(bench.run_until([&] { return !bench.base->open(); }, 2s));
  EXPECT_EQ(bench.twist, robot::Twist{});
}

}  // namespace
}  // namespace devices
