#include "robot/motion/dynamic_window.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "robot/geometry/random.hpp"
#include "robot/motion/safety_gate.hpp"
#include "robot/planning/path.hpp"
#include "robot/planning/planner.hpp"
#include "tests/support/ascii_world.hpp"
#include "tests/support/driven_robot.hpp"
#include "tests/support/matchers.hpp"

namespace robot {
namespace {

using testing::Disc;
using testing::draw_world;
using testing::DrivenRobot;
using testing::PoseNear;

Museum museum_of(const OccupancyGrid& map) {
  Museum museum;
  museum.map = map;
  return museum;
}

// The whole of planning and motion in a closed loop, with a perfectly known pose.
class Drive {
 public:
  Drive(const Museum& museum, const Pose& start, const Pose& goal, bool final_heading = false)
      : robot(museum.map, start),
        layers(museum.map),
        planner(museum, robot.body().footprint),
        hazards(museum),
        window(robot.body()),
        gate(robot.body(), hazards.has_hazards()),
        scans(robot.body()) {
    task.goal = goal;
    task.final_heading = final_heading;
    planner.set_goal(goal.position());
    while (!planner.work(1 << 20)) {
    }
  }

  // One control tick; people as a perfect tracker would see them.
  void tick() {
    scans.add(robot.odometry());
    gate.add(robot.odometry(), robot.now());
    BaseState state;
    state.motors_enabled = true;
    gate.add(state, robot.now());
    for (const LaserId id : {LaserId::front, LaserId::rear}) {
      const LaserScan scan = robot.scan(id);
      scans.add(scan);
      gate.add(scan, robot.now());
      layers.add(understood(scan));
    }
    layers.decay(robot.now());
    if (ticks % 10 == 0) planner.update(layers);
    planner.work(100000);
    People people;
    for (const Disc& disc : robot.discs()) people.people.push_back({disc.position, disc.velocity, 0});
    const std::vector<Pose> belief = {robot.pose()};
    const VirtualReadings readings = hazards.read(belief);
    gate.add(readings, true, robot.now());
    task.path = planner.path_from(robot.pose().position());
    choice = window.choose(task, robot.pose(), robot.twist(), with_motion(scans.points(4.0), people, robot.pose()),
                           readings, robot.now());
    gate.set_speed_limit(task.speed_limit);
    command = gate.limit(choice.twist, robot.now());
    const Pose before = robot.pose();
    const double turned_before = robot.twist().angular;
    robot.drive(command.twist, 0.05);
    travelled += distance(before.position(), robot.pose().position());
    jerk += std::abs(robot.twist().angular - turned_before);
    ++ticks;
    closest = std::min(closest, robot.gap_to_people());
    touched = touched || robot.touches_wall();
  }

  // Drives until it has arrived or the time is over.
  bool run(double seconds) {
    for (int i = 0; i < static_cast<int>(seconds * 20) && choice.state != MotionState::arrived; ++i) {
      tick();
      if (std::getenv("DOCENT_TRACE")) trace();
    }
    return choice.state == MotionState::arrived;
  }
  void trace() const {
    std::cerr << robot.seconds() << " at " << robot.pose().x << " " << robot.pose().y << " "
              << degrees(robot.pose().theta) << " state " << static_cast<int>(choice.state) << " wants "
              << choice.twist.linear << " " << choice.twist.angular << " gets " << command.twist.linear << " "
              << command.twist.angular << " gate " << static_cast<int>(command.reason) << " does "
              << robot.twist().linear << " " << robot.twist().angular << " gap " << robot.gap_to_people() << "\n";
  }
  // As a localizer that knows its place would: what does not end at the map's walls is people.
  ScanView understood(const LaserScan& scan) const {
    const Pose laser = robot.pose() * robot.body().lasers[static_cast<std::size_t>(scan.laser)].base_from_laser;
    ScanView view{scan.time, scan.laser, laser, scan.angle_min, scan.angle_step, scan.ranges, {}};
    for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
      const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_step, range = scan.ranges[i];
      const Point end = laser * Point{range * std::cos(angle), range * std::sin(angle)};
      const bool person = std::any_of(robot.discs().begin(), robot.discs().end(),
                                      [&](const Disc& d) { return distance(d.position, end) < d.radius + 0.03; });
      view.kinds.push_back(!std::isfinite(range) ? BeamKind::no_return : person ? BeamKind::person : BeamKind::map);
    }
    return view;
  }
  double mean_speed() const { return travelled / (ticks * 0.05); }

  DrivenRobot robot;
  ObstacleLayers layers;
  Planner planner;
  VirtualSensors hazards;
  DynamicWindow window;
  SafetyGate gate;
  ScanMemory scans;
  MotionTask task;
  MotionChoice choice;
  WheelCommand command;
  double travelled = 0.0, jerk = 0.0, closest = 1e9;
  int ticks = 0;
  bool touched = false;
};

OccupancyGrid hall(double width, double height) {
  OccupancyGrid map(static_cast<int>(width / 0.05), static_cast<int>(height / 0.05), 0.05, {}, free_cell);
  for (int x = 0; x < map.width(); ++x) map[{x, 0}] = map[{x, map.height() - 1}] = occupied_cell;
  for (int y = 0; y < map.height(); ++y) map[{0, y}] = map[{map.width() - 1, y}] = occupied_cell;
  return map;
}

void wall(OccupancyGrid& map, Point a, Point b) {
  for (int i = 0; i < map.width() * map.height(); ++i) {
    const Cell c = map.cell_at(static_cast<std::size_t>(i));
    const Point p = map.center(c);
    if (p.x >= a.x && p.x <= b.x && p.y >= a.y && p.y <= b.y) map[c] = occupied_cell;
  }
}

TEST(DynamicWindow, StandsWithoutATask) {
  DynamicWindow window(standard_body());
  const auto choice = window.choose({}, {}, {}, {}, {}, from_seconds(1));
  EXPECT_EQ(choice.twist, Twist{});
  EXPECT_EQ(choice.state, MotionState::standing);
}

TEST(DynamicWindow, RunsStraightInTheOpenAtTheSpeedLimit) {
  Drive drive(museum_of(hall(14, 6)), {2, 3, 0}, {12, 3, 0});
  ASSERT_TRUE(drive.run(25));
  EXPECT_LT(distance(drive.robot.pose().position(), {12, 3}), 0.1);
  EXPECT_GT(drive.mean_speed(), 0.5);
  EXPECT_LT(drive.jerk, 0.5);  // no weaving
}

TEST(DynamicWindow, TurnsOnTheSpotFirstAndFacesTheGoalAtTheEnd) {
  Drive drive(museum_of(hall(10, 10)), {5, 5, 0}, {2, 5, pi / 2}, true);
  drive.tick();
  EXPECT_EQ(drive.choice.state, MotionState::turning);
  ASSERT_TRUE(drive.run(30));
  EXPECT_THAT(drive.robot.pose(), PoseNear(Pose{2, 5, pi / 2}, 0.1, radians(5)));
}

TEST(DynamicWindow, AGoalInATightPlaceIsReachedAsNearAsTheRobotCanStand) {
  Drive drive(museum_of(hall(8, 6)), {4, 3, 0}, {4, 0.2, -pi / 2}, true);
  ASSERT_TRUE(drive.run(30));
  EXPECT_LT(drive.robot.pose().y, 0.5);
  EXPECT_FALSE(drive.touched);
}

TEST(DynamicWindow, DrivesThroughADoor) {
  OccupancyGrid map = hall(10, 6);
  wall(map, {5.0, 0.0}, {5.15, 2.5});
  wall(map, {5.0, 3.4}, {5.15, 6.0});  // 0.9 m wide
  Drive drive(museum_of(map), {2, 4.5, 0}, {8, 1.5, 0});
  ASSERT_TRUE(drive.run(40));
  EXPECT_FALSE(drive.touched);
  EXPECT_GT(drive.mean_speed(), 0.3);
}

TEST(DynamicWindow, DrivesRoundACornerAndOutOfAUShape) {
  OccupancyGrid map = hall(12, 10);
  wall(map, {6.0, 3.0}, {6.15, 7.0});
  wall(map, {3.0, 7.0}, {6.15, 7.15});
  wall(map, {3.0, 3.0}, {6.15, 3.15});  // a pocket that opens to the left
  Drive drive(museum_of(map), {5, 5, 0}, {9, 5, 0});
  ASSERT_TRUE(drive.run(60));
  EXPECT_FALSE(drive.touched);
  EXPECT_GT(drive.mean_speed(), 0.3);
}

TEST(DynamicWindow, WaitsBeforeAPersonInADoorAndGoesOnWhenTheyLeave) {
  OccupancyGrid map = hall(10, 6);
  wall(map, {5.0, 0.0}, {5.15, 2.5});
  wall(map, {5.0, 3.5}, {5.15, 6.0});
  Drive drive(museum_of(map), {2, 3, 0}, {8, 3, 0});
  drive.robot.discs().push_back({{5.0, 3.0}, {}});
  EXPECT_FALSE(drive.run(10));
  EXPECT_GT(drive.closest, 0.02);
  EXPECT_GT(drive.choice.blocked_for.count(), 2.0);
  drive.robot.discs().clear();
  EXPECT_TRUE(drive.run(20));
}

TEST(DynamicWindow, PassesAStandingPersonInTheHall) {
  Drive drive(museum_of(hall(12, 8)), {2, 4, 0}, {10, 4, 0});
  drive.robot.discs().push_back({{6.0, 4.05}, {}});
  ASSERT_TRUE(drive.run(40));
  EXPECT_GT(drive.closest, 0.1);
  EXPECT_GT(drive.mean_speed(), 0.35);
}

TEST(DynamicWindow, GivesWayToSomebodyWhoCrosses) {
  Drive drive(museum_of(hall(12, 8)), {2, 4, 0}, {10, 4, 0});
  drive.robot.discs().push_back({{6.0, 0.5}, {0.0, 0.8}});
  for (int i = 0; i < 170; ++i) drive.tick();
  EXPECT_GT(drive.closest, 0.15);
  drive.robot.discs().clear();
  EXPECT_TRUE(drive.run(30));
}

TEST(DynamicWindow, WhoCrossesMayStopOnTheWay) {
  // A child runs across: beside the way now, on its other side in half a second.
  std::vector<Obstacle> child;
  for (double angle = 0.0; angle < 2 * pi; angle += 0.2) {
    child.push_back({Point{0.75 + 0.15 * std::cos(angle), 0.75 + 0.15 * std::sin(angle)}, {0.0, -3.0}});
  }
  DynamicWindow window(standard_body());
  const MotionTask task{.path = {{0, 0}, {5, 0}}, .goal = {5, 0, 0}};
  const VelocitySpace space = window.choose(task, {}, {0.65, 0.0}, child, {}, from_seconds(1)).space;
  const std::size_t straight = space.angular.size() / 2;
  EXPECT_NEAR(space.linear.back(), 0.7, 1e-6);
  EXPECT_NEAR(space.angular[straight], 0.0, 1e-6);
  EXPECT_TRUE(std::isnan(space.score[(space.linear.size() - 1) * space.angular.size() + straight]));
}

TEST(DynamicWindow, KeepsOffAHazardStripThatNoSensorSees) {
  Museum museum = museum_of(hall(12, 8));
  museum.hazards.push_back({"stairs", HazardKind::staircase, {{5, 2}, {7, 2}, {7, 5}, {5, 5}}, {}});
  Drive drive(museum, {2, 4, 0}, {10, 4, 0});
  for (int i = 0; i < 900 && drive.choice.state != MotionState::arrived; ++i) {
    drive.tick();
    const Pose base_from_map = inverse(drive.robot.pose());
    for (double x = 5; x <= 7; x += 0.1) {
      for (const double y : {2.0, 5.0}) {
        ASSERT_GE(distance_to(drive.robot.body().footprint, base_from_map * Point{x, y}), 0.01);
      }
    }
  }
  EXPECT_EQ(drive.choice.state, MotionState::arrived);
  EXPECT_GT(drive.mean_speed(), 0.3);
}

TEST(DynamicWindow, AHazardNeverTrapsTheRobot) {
  Museum museum = museum_of(hall(12, 8));
  museum.hazards.push_back({"stairs", HazardKind::staircase, {{5, 2}, {7, 2}, {7, 5}, {5, 5}}, {}});
  for (const Pose& start :
       {Pose{5.2, 4, 0}, Pose{5.2, 4, 1.5}, Pose{6.7, 3, pi}, Pose{6, 4.8, -1}, Pose{4.8, 3, 1.57}}) {
    Drive drive(museum, start, {10, 6.5, 0});
    EXPECT_TRUE(drive.run(60)) << start.x << " " << start.y << " " << start.theta;
  }
}

TEST(DynamicWindow, BacksOutOfADeadEndThatIsTooNarrowToTurnIn) {
  OccupancyGrid map = hall(10, 6);
  wall(map, {6.0, 3.33}, {9.0, 3.4});
  wall(map, {6.0, 2.6}, {9.0, 2.67});  // 0.66 m wide
  wall(map, {8.9, 2.6}, {9.0, 3.4});
  Drive drive(museum_of(map), {7.3, 3.0, 0}, {2, 3, 0});
  EXPECT_TRUE(drive.run(90));
  EXPECT_FALSE(drive.touched);
}

// Among walkers who look after nobody, the robot does not run into anyone: when someone touches it, it stands, or they
// come from behind or the side.
RC_GTEST_PROP(DynamicWindowProperty, DoesNotRunIntoWalkers, (std::uint64_t seed)) {
  Random random(seed);
  Drive drive(museum_of(hall(14, 8)), {2, 4, 0}, {12, 4, 0});
  for (int i = 0; i < 6; ++i) {
    const Point p{random.uniform(4.0, 11.0), random.uniform(0.5, 7.5)};
    const double angle = random.uniform(-pi, pi), speed = random.chance(0.3) ? 0.0 : random.uniform(0.3, 1.0);
    drive.robot.discs().push_back({p, {speed * std::cos(angle), speed * std::sin(angle)}});
  }
  std::vector<bool> touching(drive.robot.discs().size());
  for (int i = 0; i < 20 * 30 && drive.choice.state != MotionState::arrived; ++i) {
    drive.tick();
    for (std::size_t k = 0; k < touching.size(); ++k) {
      Disc& disc = drive.robot.discs()[k];
      if (disc.position.x < 0.5 || disc.position.x > 13.5) disc.velocity.x *= -1.0;
      if (disc.position.y < 0.5 || disc.position.y > 7.5) disc.velocity.y *= -1.0;
      const Point seen = inverse(drive.robot.pose()) * disc.position;
      const bool touched_before = touching[k];
      touching[k] = distance_to(drive.robot.body().footprint, seen) < disc.radius;
      if (!touching[k] || touched_before) continue;  // the first touch tells whose fault it is
      // At fault is who closed the gap faster: the body at the place of contact, or they.
      const Twist& twist = drive.robot.twist();
      const Point touch{std::clamp(seen.x, -0.3, 0.3), std::clamp(seen.y, -0.26, 0.26)};
      const Point normal = (1.0 / std::max(1e-6, distance(seen, touch))) * (seen - touch);
      const double robot_closes = dot({twist.linear - twist.angular * touch.y, twist.angular * touch.x}, normal);
      const Point walks = Pose{0, 0, -drive.robot.pose().theta} * disc.velocity;
      RC_ASSERT(robot_closes <= 0.02 || robot_closes < -dot(walks, normal));
    }
    RC_ASSERT(!drive.touched);
  }
}

}  // namespace
}  // namespace robot
