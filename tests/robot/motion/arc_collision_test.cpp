#include "robot/motion/arc_collision.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "robot/geometry/random.hpp"

namespace robot {
namespace {

const Footprint body{.front = 0.30, .rear = 0.30, .half_width = 0.26};

double contact(Point p, Twist twist) {
  PointColumns points;
  points.push_back(p);
  return time_to_contact(body, points, twist);
}

TEST(ArcCollision, StraightAheadIsTheWayToTheFrontEdge) {
  EXPECT_NEAR(contact({1.3, 0.1}, {0.5, 0.0}), 2.0, 1e-6);
  EXPECT_NEAR(contact({-1.3, 0.1}, {-0.5, 0.0}), 2.0, 1e-6);
  EXPECT_EQ(contact({1.3, 0.27}, {0.5, 0.0}), no_contact);
  EXPECT_EQ(contact({-1.3, 0.0}, {0.5, 0.0}), no_contact);
  EXPECT_EQ(contact({1.3, 0.0}, {0.0, 0.0}), no_contact);
}

TEST(ArcCollision, TurningOnTheSpotMeetsWhatTheCornersSweep) {
  // The corner at (0.3, 0.26) has a radius of 0.397 m and a bearing of 40.9 degrees.
  const double corner = std::atan2(0.26, 0.30);
  const double r = 0.35;  // meets the left edge where y = 0.26, at x = sqrt(r^2 - 0.26^2)
  const double edge = std::atan2(0.26, std::sqrt(r * r - 0.26 * 0.26));
  EXPECT_GT(corner, 0.0);
  EXPECT_NEAR(contact({0.0, r}, {0.0, 1.0}), pi / 2 - edge, 1e-5);
  EXPECT_NEAR(contact({0.0, r}, {0.0, -1.0}), pi / 2 - edge, 1e-5);
  EXPECT_EQ(contact({0.0, 0.41}, {0.0, 1.0}), no_contact);
}

TEST(ArcCollision, ATouchedRobotCanBackAwayButNotPushOn) {
  const Point in_front{0.29, 0.0}, at_left{0.0, 0.25};
  EXPECT_EQ(contact(in_front, {0.3, 0.0}), 0.0);
  EXPECT_EQ(contact(in_front, {-0.1, 0.0}), no_contact);
  EXPECT_EQ(contact(at_left, {0.3, 0.0}), no_contact);
  EXPECT_EQ(contact({0.2, 0.25}, {0.0, 0.5}), 0.0);
  EXPECT_EQ(contact({0.2, 0.25}, {0.0, -0.5}), no_contact);
}

TEST(ArcCollision, DistanceIsToTheRectangle) {
  EXPECT_DOUBLE_EQ(distance_to(body, {0.5, 0.0}), 0.2);
  EXPECT_DOUBLE_EQ(distance_to(body, {0.0, -0.36}), 0.1);
  EXPECT_DOUBLE_EQ(distance_to(body, {0.1, 0.1}), 0.0);
  EXPECT_NEAR(distance_to(grown(body, 0.1), {0.7, 0.66}), 0.5 * std::hypot(0.6, 0.6), 1e-9);
}

Twist any_twist(Random& random) {
  Twist twist{random.uniform(-1.0, 1.5), random.uniform(-1.5, 1.5)};
  if (random.chance(0.1)) twist.linear = 0.0;
  if (random.chance(0.1)) twist.angular = 0.0;
  return twist;
}

RC_GTEST_PROP(ArcCollisionExact, TheFastWayEqualsThePlainOne, (std::uint64_t seed)) {
  Random random(seed);
  for (int i = 0; i < 200; ++i) {
    const Twist twist = any_twist(random);
    const Point p{random.uniform(-2.5, 2.5), random.uniform(-2.5, 2.5)};
    // Where a circle grazes a corner the answer jumps; a hundredth of a millimetre of footprint must hold both sides.
    if (covers(grown(body, 1e-5), p) != covers(grown(body, -1e-5), p)) continue;
    const double fast = contact(p, twist), speed = std::abs(twist.linear) + std::abs(twist.angular) * norm(p);
    const double early = time_to_contact_plain(grown(body, 1e-5), p, twist);
    const double late = time_to_contact_plain(grown(body, -1e-5), p, twist);
    if (speed == 0.0 || (early > 60.0 && fast > 60.0)) continue;  // farther than anybody looks
    RC_ASSERT(fast >= early - 2e-3 / speed - 1e-4 * early);
    RC_ASSERT(fast <= late + 2e-3 / speed + 1e-4 * early);
  }
}

// Independent of both formulas: march along the arc in small steps and look.
RC_GTEST_PROP(ArcCollisionExact, SteppingAlongTheArcFindsTheSame, (std::uint64_t seed)) {
  Random random(seed);
  const Twist twist = any_twist(random);
  const Point p{random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0)};
  if (covers(body, p)) return;
  const double found = contact(p, twist);
  constexpr double step = 0.002;
  const double full_turn = std::abs(twist.angular) > 1e-3 ? 2.0 * pi / std::abs(twist.angular) : 10.0;
  const double until = std::min({found, full_turn, 10.0});
  for (double t = 0.0; t < until - 0.01; t += step) {
    RC_ASSERT(!covers(grown(body, -0.004), inverse(arc(twist, t)) * p));
  }
  if (found < 10.0) RC_ASSERT(covers(grown(body, 0.004), inverse(arc(twist, found)) * p));
}

}  // namespace
}  // namespace robot
