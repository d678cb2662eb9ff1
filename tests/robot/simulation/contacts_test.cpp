#include "robot/simulation/contacts.hpp"

#include <gmock/gmock.h>

#include "robot/geometry/polygon.hpp"
#include "tests/robot/simulation/scenes.hpp"

namespace robot::simulation {
namespace {

const Footprint footprint;  // 0.30 m to front and rear, 0.26 m to each side

Person person_at(double x, double y) {
  Person person;
  person.position = {x, y};
  return person;
}

TEST(Contacts, WallIsTouchedByTheTrueRectangle) {
  Museum museum = testing::hall(6.0, 6.0);
  testing::build(museum, 4.0, 2.0, 4.5, 4.0);
  const Walls walls(museum.map);
  EXPECT_FALSE(touched_wall(footprint, {3.69, 3.0, 0.0}, walls));
  EXPECT_TRUE(touched_wall(footprint, {3.71, 3.0, 0.0}, walls));
  EXPECT_FALSE(touched_wall(footprint, {3.73, 3.0, pi / 2}, walls));  // sideways it is narrower
  EXPECT_TRUE(touched_wall(footprint, {3.65, 3.0, pi / 4}, walls));   // a corner reaches farther
  EXPECT_FALSE(touched_wall(footprint, {1.5, 3.0, 0.3}, walls));
}

TEST(Contacts, HazardsAndTheBoundaryCount) {
  Museum museum = testing::hall(10.0, 10.0);
  museum.hazards = {{"stairs", HazardKind::staircase, testing::box(6.0, 4.0, 8.0, 6.0), {}},
                    {"case", HazardKind::glass, testing::box(2.0, 7.0, 3.0, 8.0), {}}};
  museum.boundary = testing::box(1.0, 1.0, 9.0, 9.0);
  const Hazards hazards(museum);
  EXPECT_FALSE(hazards.touched(footprint, {5.6, 5.0, 0.0}));
  const auto stairs = hazards.touched(footprint, {5.75, 5.0, 0.0});
  ASSERT_TRUE(stairs);
  EXPECT_EQ(stairs->id, "stairs");
  EXPECT_FALSE(stairs->solid);
  const auto glass = hazards.touched(footprint, {2.5, 7.5, 0.3});
  ASSERT_TRUE(glass);
  EXPECT_TRUE(glass->solid);
  const auto left = hazards.touched(footprint, {1.2, 5.0, 0.0});
  ASSERT_TRUE(left);
  EXPECT_EQ(left->id, "boundary");
}

TEST(Contacts, RobotThatDrivesIntoAStandingPersonIsAtFault) {
  EXPECT_TRUE(robot_at_fault(footprint, {0, 0, 0}, {0.3, 0.0}, person_at(0.5, 0.0), {}));
  EXPECT_TRUE(robot_at_fault(footprint, {0, 0, 0}, {-0.1, 0.0}, person_at(-0.5, 0.1), {}));
}

TEST(Contacts, PersonWhoWalksIntoAStandingRobotIsAtFault) {
  EXPECT_FALSE(robot_at_fault(footprint, {0, 0, 0}, {0.0, 0.0}, person_at(0.5, 0.0), {-1.0, 0.0}));
  EXPECT_FALSE(robot_at_fault(footprint, {0, 0, 0}, {0.5, 0.0}, person_at(-0.5, 0.0), {1.2, 0.0}));   // from behind
  EXPECT_FALSE(robot_at_fault(footprint, {0, 0, 0}, {0.5, 0.0}, person_at(0.0, 0.46), {0.0, -0.8}));  // the side
}

TEST(Contacts, TheFasterOfTwoThatMeetIsAtFault) {
  EXPECT_TRUE(robot_at_fault(footprint, {0, 0, 0}, {0.6, 0.0}, person_at(0.5, 0.0), {-0.3, 0.0}));
  EXPECT_FALSE(robot_at_fault(footprint, {0, 0, 0}, {0.3, 0.0}, person_at(0.5, 0.0), {-1.0, 0.0}));
}

TEST(Contacts, TurningCornersCount) {
  // At the left of the front corner, which swings to the left when the robot turns that way.
  EXPECT_TRUE(robot_at_fault(footprint, {0, 0, 0}, {0.0, 0.5}, person_at(0.25, 0.45), {}));
  EXPECT_FALSE(robot_at_fault(footprint, {0, 0, 0}, {0.0, -0.5}, person_at(0.25, 0.45), {}));
}

TEST(Contacts, StoppingWayTellsTheInevitable) {
  const Twist fast{0.7, 0.0};  // stops in 0.15 * 0.7 + 0.7^2 / 2 = 0.35 m
  EXPECT_TRUE(inevitable(footprint, {0, 0, 0}, fast, 1.0, 0.15, {0.80, 0.0}, 0.22));
  EXPECT_FALSE(inevitable(footprint, {0, 0, 0}, fast, 1.0, 0.15, {0.90, 0.0}, 0.22));
  EXPECT_FALSE(inevitable(footprint, {0, 0, 0}, fast, 1.0, 0.15, {0.70, 0.6}, 0.22));
  EXPECT_FALSE(inevitable(footprint, {0, 0, 0}, {0.0, 1.0}, 1.0, 0.15, {0.6, 0.0}, 0.22));
}

}  // namespace
}  // namespace robot::simulation
