#include "robot/simulation/drive.hpp"

#include <gmock/gmock.h>

#include "tests/support/matchers.hpp"

namespace robot::simulation {
namespace {

constexpr DriveNoise no_noise{0.0, 0.0, 0.0, 0.0, 0.5};
constexpr double dt = 0.005;

Pose drive_for(Drive& drive, Twist wanted, double seconds) {
  Pose moved;
  drive.command(wanted);
  for (int i = 0; i < static_cast<int>(seconds / dt + 0.5); ++i) moved = moved * drive.step(dt);
  return moved;
}

TEST(Drive, WithoutNoiseTheOdometryIsTheTruth) {
  Drive drive({}, no_noise, Random(1));
  Pose truth;
  for (const Twist wanted : {Twist{0.5, 0.3}, Twist{-0.1, -1.0}, Twist{1.2, 0.0}, Twist{}}) {
    truth = truth * drive_for(drive, wanted, 2.0);
    EXPECT_THAT(drive.odometry(), testing::PoseNear(truth, 1e-9));
  }
}

TEST(Drive, SteadyTwistRunsAnExactArc) {
  Drive drive({}, no_noise, Random(1));
  drive_for(drive, {0.5, 0.4}, 5.0);  // up to speed
  EXPECT_NEAR(drive.wheels().linear, 0.5, 1e-6);
  EXPECT_THAT(drive_for(drive, {0.5, 0.4}, 3.0), testing::PoseNear(arc({0.5, 0.4}, 3.0), 1e-5));
}

TEST(Drive, TorqueLimitsHoldWhateverIsCommanded) {
  const DriveLimits limits;
  Drive drive(limits, no_noise, Random(1));
  Random random(7);
  for (int i = 0; i < 20000; ++i) {
    if (i % 40 == 0) drive.command({random.uniform(-5.0, 5.0), random.uniform(-9.0, 9.0)});
    const Twist before = drive.wheels();
    drive.step(dt);
    const Twist after = drive.wheels();
    const bool faster = std::abs(after.linear) > std::abs(before.linear);
    const double limit = faster ? limits.max_acceleration : limits.max_deceleration;
    EXPECT_LE(std::abs(after.linear - before.linear), limit * dt + 1e-4);
    EXPECT_LE(std::abs(after.angular - before.angular), limits.max_angular_acceleration * dt + 1e-4);
    EXPECT_LE(after.linear, limits.max_linear + 1e-9);
    EXPECT_GE(after.linear, -limits.max_reverse - 1e-9);
    EXPECT_LE(std::abs(after.angular), limits.max_angular + 1e-9);
  }
}

TEST(Drive, FullBrakingStopsWithinTheWayThatSafetyCountsOn) {
  const DriveLimits limits;
  Drive drive(limits, no_noise, Random(1));
  drive_for(drive, {0.7, 0.0}, 5.0);
  const double speed = drive.wheels().linear;
  // The loops' time constant rounds the last centimetres.
  EXPECT_LT(drive_for(drive, {}, 3.0).x, speed * speed / (2.0 * limits.max_deceleration) + 0.01);
}

TEST(Drive, DeadReckoningDriftsLikeRealBases) {
  double worst_way = 0.0, way = 0.0, turn = 0.0;
  constexpr int bases = 200;
  for (int seed = 0; seed < bases; ++seed) {
    Drive drive({}, {}, Random(static_cast<std::uint64_t>(seed)));
    const Pose truth = drive_for(drive, {0.5, 0.0}, 20.0);
    const Pose error = relative(truth, drive.odometry());
    way += norm(error.position()) / bases;
    turn += std::abs(error.theta) / bases;
    worst_way = std::max(worst_way, norm(error.position()));
  }
  EXPECT_GT(way, 0.1);  // over 10 m
  EXPECT_LT(way, 0.6);
  EXPECT_LT(worst_way, 2.5);
  EXPECT_GT(turn, radians(0.7));
  EXPECT_LT(turn, radians(5.0));
}

}  // namespace
}  // namespace robot::simulation
