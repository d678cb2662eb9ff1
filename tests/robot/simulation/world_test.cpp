#include "robot/simulation/world.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>

#include "tests/robot/simulation/scenes.hpp"
#include "tests/support/matchers.hpp"

namespace robot::simulation {
namespace {

WorldConfig empty_house() {
  WorldConfig config;
  config.visitors = 0;
  config.drive = {0.0, 0.0, 0.0, 0.0, 0.5};
  return config;
}

// All numbers of an event stream, bit for bit.
std::uint64_t fingerprint(const std::vector<Input>& inputs) {
  std::uint64_t hash = 1469598103934665603ull;
  const auto mix = [&](double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 1099511628211ull;
  };
  for (const auto& input : inputs) {
    mix(to_seconds(input.now));
    if (const auto* scan = std::get_if<LaserScan>(&input.event)) {
      for (const float range : scan->ranges) mix(range);
    } else if (const auto* odometry = std::get_if<Odometry>(&input.event)) {
      mix(odometry->odom_from_base.x), mix(odometry->odom_from_base.y), mix(odometry->odom_from_base.theta);
    } else if (const auto* sonars = std::get_if<SonarScan>(&input.event)) {
      for (const auto& reading : sonars->readings) mix(reading.range);
    }
  }
  return hash;
}

void append(std::vector<Input>& all, std::vector<Input> more) {
  for (auto& input : more) all.push_back(std::move(input));
}

TEST(World, SameSeedSameEventsHoweverTimeIsCut) {
  const Museum museum = testing::hall(15.0, 15.0);
  WorldConfig config;
  config.visitors = 30;
  World coarse(museum, standard_body(), config, 7), fine(museum, standard_body(), config, 7);
  World other(museum, standard_body(), config, 8);
  std::vector<Input> a, b, c;
  for (World* world : {&coarse, &fine, &other}) {
    world->enable_motors(true);
    world->drive_to({0.3, 0.2});
  }
  for (int i = 1; i <= 15; ++i) append(a, coarse.advance(from_seconds(0.1 * i)));
  for (int i = 1; i <= 1500; ++i) append(b, fine.advance(Time(i * 1ms)));
  for (int i = 1; i <= 15; ++i) append(c, other.advance(from_seconds(0.1 * i)));
  EXPECT_EQ(a.size(), b.size());
  EXPECT_EQ(fingerprint(a), fingerprint(b));
  EXPECT_NE(fingerprint(a), fingerprint(c));
  EXPECT_EQ(coarse.truth(), fine.truth());
}

TEST(World, EventsComeInTimeAndAtTheirRates) {
  World world(testing::hall(10.0, 10.0), standard_body(), empty_house(), 1);
  const auto events = world.advance(from_seconds(10.0));
  int fronts = 0, rears = 0, odometry = 0;
  Time last{};
  for (const auto& input : events) {
    EXPECT_GE(input.now, last);
    last = input.now;
    odometry += std::holds_alternative<Odometry>(input.event);
    if (const auto* scan = std::get_if<LaserScan>(&input.event)) ++(scan->laser == LaserId::front ? fronts : rears);
  }
  EXPECT_NEAR(fronts, 200, 1);
  EXPECT_NEAR(rears, 200, 1);
  EXPECT_NEAR(odometry, 200, 1);
}

TEST(World, WheelsNeedMotorsAndFreshCommands) {
  World world(testing::hall(20.0, 20.0), standard_body(), empty_house(), 1);
  world.drive_to({0.5, 0.0});
  world.advance(from_seconds(1.0));
  EXPECT_THAT(world.truth(), robot::testing::PoseNear(world.museum().home, 1e-9));
  world.enable_motors(true);
  world.drive_to({0.5, 0.0});
  world.advance(from_seconds(2.5));
  EXPECT_NEAR(world.twist().linear, 0.5, 1e-3);
  world.advance(from_seconds(5.0));  // the base's own watchdog
  EXPECT_EQ(world.twist().linear, 0.0);
}

TEST(World, EmergencyStopHoldsTheWheels) {
  World world(testing::hall(20.0, 20.0), standard_body(), empty_house(), 1);
  world.enable_motors(true);
  world.drive_to({0.5, 0.0});
  world.advance(from_seconds(1.0));
  world.press_emergency_stop(true);
  world.enable_motors(true);
  world.drive_to({0.5, 0.0});
  world.advance(from_seconds(2.5));
  EXPECT_EQ(world.twist().linear, 0.0);
  EXPECT_TRUE(world.base().emergency_stop);
  EXPECT_FALSE(world.base().motors_enabled);
}

TEST(World, WallStopsTheBodyOnceAndPressesTheBumper) {
  World world(testing::hall(6.0, 6.0), standard_body(), empty_house(), 1);
  world.enable_motors(true);
  for (int i = 1; i <= 100; ++i) {
    world.drive_to({0.5, 0.0});
    world.advance(from_seconds(0.1 * i));
  }
  EXPECT_NEAR(world.truth().x, 5.9 - 0.30, 0.01);
  ASSERT_EQ(world.contacts().size(), 1u);
  EXPECT_EQ(world.contacts()[0].kind, ContactKind::fixed);
  EXPECT_TRUE(world.base().bumper_front);
  EXPECT_TRUE(world.base().stalled);
  for (int i = 1; i <= 20; ++i) {
    world.drive_to({-0.2, 0.0});
    world.advance(from_seconds(10.0 + 0.1 * i));
  }
  EXPECT_FALSE(world.base().bumper_front);
  EXPECT_LT(world.truth().x, 5.4);
}

TEST(World, RobotThatRunsSomeoneDownIsBlamed) {
  WorldConfig config = empty_house();
  config.visitors = 1;
  World world(testing::hall(12.0, 4.0), standard_body(), config, 1);
  world.enable_motors(true);
  for (int i = 1; i <= 40; ++i) {
    // Held where it stands: nobody else is to blame.
    world.visitors()[0].position = {8.0, 2.0};
    world.visitors()[0].velocity = {};
    world.drive_to({0.5, 0.0});
    world.advance(from_seconds(0.1 * i));
  }
  ASSERT_FALSE(world.contacts().empty());
  EXPECT_EQ(world.contacts()[0].kind, ContactKind::person_robot_fault);
}

// Runs in from the left, 25 cm before the bumper: the brakes are on at once, and yet they meet.
TEST(World, WhoeverCutsInTooCloseToStopIsToBlame) {
  WorldConfig config = empty_house();
  config.visitors = 1;
  World world(testing::hall(16.0, 8.0), standard_body(), config, 1);
  world.enable_motors(true);
  world.place({3.0, 4.0, 0.0});
  bool brakes = false;
  double lane = 0.0;  // x at which the person runs across
  for (int i = 1; i <= 320; ++i) {
    Person& person = world.visitors()[0];
    if (i <= 200) {
      person.position = {6.0, 7.0};
    } else if (i == 201) {
      lane = world.truth().x + 0.3 + 0.25 + person.radius;
      person.position = {lane, 4.6};
    } else {
      person.position.x = lane;
    }
    person.velocity = {0.0, i <= 200 || person.position.y < 4.05 ? 0.0 : -2.4};
    brakes = brakes || (i > 200 && person.position.y < 4.5);
    world.drive_to({brakes ? 0.0 : 0.7, 0.0});
    world.advance(Time(i * 25ms));
  }
  ASSERT_EQ(world.contacts().size(), 1u);
  EXPECT_EQ(world.contacts()[0].kind, ContactKind::person_own_fault);
}

TEST(World, BatteryEmptiesOnTheWayAndFillsAtHome) {
  WorldConfig config = empty_house();
  config.battery_fraction = 0.5;
  World world(testing::hall(20.0, 20.0), standard_body(), config, 1);
  world.advance(from_seconds(60.0));
  const double charged = world.base().battery_fraction;
  EXPECT_GT(charged, 0.5);
  world.place({4.0, 4.0, 0.0});
  world.advance(from_seconds(120.0));
  EXPECT_LT(world.base().battery_fraction, charged);
  EXPECT_GT(world.base().battery_volts, 11.0);
}

}  // namespace
}  // namespace robot::simulation
