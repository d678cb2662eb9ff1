#include "robot/robot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/ascii_world.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/rehearsal.hpp"

namespace robot {
namespace {

using testing::PoseNear;
using testing::Rehearsal;

// Two rooms, half a metre a character: the robot at R, an exhibit's viewpoint at A (behind the door) and one at B.
Museum two_rooms() {
  const auto drawing = testing::draw_world(
      0.5, {"####################", "#        #         #", "#   R    #    A    #", "#        #         #",
            "#                  #", "#                  #", "#        #         #", "#   B    #   ###   #",
            "#        #         #", "####################"});
  Museum museum;
  museum.id = "two-rooms";
  museum.map = OccupancyGrid(200, 100, 0.05, {0, 0}, free_cell);
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 200; ++x) museum.map[{x, y}] = drawing.map[{x / 10, y / 10}];
  }
  const auto add = [&](const std::string& id, Point at) {
    Exhibit exhibit;
    exhibit.id = id;
    exhibit.title = {{"en", id}};
    exhibit.viewpoints = {{{at.x, at.y, pi / 2}}};
    exhibit.narrations = {{.text = {{"en", "This is " + id + "."}}, .picture = {}, .duration = Seconds(5)}};
    museum.exhibits.push_back(exhibit);
  };
  add("a", drawing.at('A'));
  add("b", drawing.at('B'));
  museum.home = {drawing.at('R').x, drawing.at('R').y, 0.0};
  return museum;
}

class RobotTest : public ::testing::Test {
 protected:
  explicit RobotTest(bool known_start = true)
      : rehearsal_(museum_,
                   {.localizer = {}, .start = known_start ? std::optional(museum_.home) : std::nullopt, .seed = 5},
                   {.visitors = 0, .start = {}, .drive = {}, .sensors = {}}, 3) {}

  RequestVisit wish(const Target& target) {
    return {.ticket = 11, .requester = {.name = "Ada", .channel = Channel::web, .session = "s"}, .target = target};
  }

  Museum museum_ = two_rooms();
  Rehearsal rehearsal_;
};

TEST_F(RobotTest, DrivesThroughTheDoorAndExplains) {
  rehearsal_.run(Seconds(1));
  rehearsal_.tell(wish(ExhibitTarget{"a", {}}));
  ASSERT_EQ(rehearsal_.answers.back().refusal, Refusal::none);
  const RequestId id = rehearsal_.answers.back().requests.front();
  EXPECT_TRUE(
      rehearsal_.run_until([&] { return rehearsal_.request(id)->state == RequestState::fulfilled; }, Seconds(120)));
  ASSERT_FALSE(rehearsal_.speeches.empty());
  EXPECT_EQ(rehearsal_.speeches.back().text.at("en"), "This is a.");
  EXPECT_THAT(rehearsal_.world().truth(), PoseNear(museum_.exhibits[0].viewpoints[0].pose, 0.2));
  EXPECT_TRUE(rehearsal_.world().contacts().empty());
}

TEST_F(RobotTest, StopAnswersInTheSameCallAndHoldsUntilResume) {
  rehearsal_.run(Seconds(1));
  rehearsal_.tell(wish(ExhibitTarget{"a", {}}));
  ASSERT_TRUE(rehearsal_.run_until([&] { return rehearsal_.command.twist.linear > 0.3; }, Seconds(20)));
  const auto outputs = rehearsal_.tell(Stop{"Brandt"});
  const auto* command = std::get_if<WheelCommand>(&outputs.front());
  ASSERT_TRUE(command);
  EXPECT_EQ(command->reason, GateReason::stopped_by_hand);
  rehearsal_.run(Seconds(2));
  const Pose stood = rehearsal_.world().truth();
  rehearsal_.run(Seconds(5));
  EXPECT_THAT(rehearsal_.world().truth(), PoseNear(stood, 0.01));
  EXPECT_EQ(rehearsal_.status.activity, Activity::stopped);
  rehearsal_.tell(Resume{"Brandt"});
  EXPECT_TRUE(rehearsal_.run_until([&] { return rehearsal_.command.twist.linear > 0.3; }, Seconds(20)));
}

TEST_F(RobotTest, ALostLaserStopsTheWheels) {
  rehearsal_.run(Seconds(1));
  rehearsal_.tell(wish(ExhibitTarget{"a", {}}));
  ASSERT_TRUE(rehearsal_.run_until([&] { return rehearsal_.command.twist.linear > 0.3; }, Seconds(20)));
  rehearsal_.lost = [](const Event& event) {
    const auto* scan = std::get_if<LaserScan>(&event);
    return scan && scan->laser == LaserId::front;
  };
  rehearsal_.tell(DeviceState{Device::laser_front, false, "unplugged"});
  EXPECT_EQ(rehearsal_.command.reason, GateReason::sensor_stale);
  rehearsal_.run(Seconds(2));
  EXPECT_EQ(rehearsal_.command.twist, (Twist{}));
  EXPECT_EQ(rehearsal_.status.activity, Activity::faulted);
  EXPECT_EQ(rehearsal_.status.why, Why::laser_silent);
}

TEST_F(RobotTest, RefusesGoalsItCannotReachAndSaysWhy) {
  rehearsal_.run(Seconds(1));
  const auto refusal = [&](const Target& target) {
    rehearsal_.tell(wish(target));
    return rehearsal_.answers.back().refusal;
  };
  EXPECT_EQ(refusal(ExhibitTarget{"zeppelin", {}}), Refusal::unknown_exhibit);
  EXPECT_EQ(refusal(PointTarget{{-3, 2}, {}}), Refusal::off_the_map);
  EXPECT_EQ(refusal(PointTarget{{0.1, 0.1}, {}}), Refusal::inside_obstacle);
  EXPECT_EQ(refusal(PointTarget{{std::numeric_limits<double>::quiet_NaN(), 1}, {}}), Refusal::not_finite);
  EXPECT_EQ(refusal(PointTarget{{8.5, 1.25}, {}}), Refusal::none);
}

TEST_F(RobotTest, SaysThatAHazardIsNoGoal) {
  museum_.hazards.push_back({.id = "plate",
                             .kind = HazardKind::low_obstacle,
                             .polygon = {{6, 2.6}, {8, 2.6}, {8, 3.4}, {6, 3.4}},
                             .title = {}});
  Rehearsal rehearsal(museum_, {.localizer = {}, .start = museum_.home},
                      {.visitors = 0, .start = {}, .drive = {}, .sensors = {}}, 3);
  rehearsal.run(Seconds(1));
  rehearsal.tell(wish(PointTarget{{7.0, 3.0}, {}}));
  EXPECT_EQ(rehearsal.answers.back().refusal, Refusal::in_hazard);
}

class LostRobotTest : public RobotTest {
 protected:
  LostRobotTest() : RobotTest(false) {}
};

TEST_F(LostRobotTest, FindsItselfAndThenServes) {
  EXPECT_TRUE(rehearsal_.run_until([&] { return rehearsal_.pose.localized; }, Seconds(40)));
  EXPECT_THAT(rehearsal_.pose.map_from_base, PoseNear(rehearsal_.world().truth(), 0.15));
  rehearsal_.tell(wish(ExhibitTarget{"b", {}}));
  const RequestId id = rehearsal_.answers.back().requests.front();
  EXPECT_TRUE(
      rehearsal_.run_until([&] { return rehearsal_.request(id)->state == RequestState::fulfilled; }, Seconds(90)));
}

}  // namespace
}  // namespace robot
