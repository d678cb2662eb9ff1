#include "robot/simulation/crowd.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "robot/geometry/polygon.hpp"
#include "robot/simulation/contacts.hpp"
#include "tests/robot/simulation/scenes.hpp"

namespace robot::simulation {
namespace {

constexpr double dt = 0.025;

// Two rooms with a door, three exhibits, a staircase and a glass case.
Museum small_museum() {
  Museum museum = testing::hall(20.0, 12.0);
  testing::build(museum, 10.0, 0.0, 10.2, 5.0);
  testing::build(museum, 10.0, 6.4, 10.2, 12.0);
  const Polygon first = testing::box(3.0, 3.0, 4.5, 4.0), second = testing::box(15.0, 8.0, 16.0, 9.5);
  testing::build(museum, 3.0, 3.0, 4.5, 4.0);
  testing::build(museum, 15.0, 8.0, 16.0, 9.5);
  museum.hazards = {{"stairs", HazardKind::staircase, testing::box(16.5, 1.0, 19.0, 3.0), {}},
                    {"case", HazardKind::glass, testing::box(5.0, 8.0, 6.0, 9.0), {}}};
  museum.exhibits = {testing::exhibit("press", 1, first), testing::exhibit("loom", 2, second),
                     testing::exhibit("clock", 3, testing::box(5.0, 8.0, 6.0, 9.0))};
  museum.home = {7.5, 6.0, 0.0};
  return museum;
}

TEST(Crowd, NobodyWalksThroughWallsGlassOrStairs) {
  const Museum museum = small_museum();
  Crowd crowd(museum, 60, Random(4));
  for (int i = 0; i < 4000; ++i) {
    crowd.step(dt, {museum.home, {}, {}});
    for (const auto& person : crowd.people()) {
      ASSERT_TRUE(is_free(museum.map.at_or(museum.map.cell(person.position), occupied_cell))) << "step " << i;
      for (const auto& hazard : museum.hazards) ASSERT_FALSE(contains(hazard.polygon, person.position)) << hazard.id;
    }
  }
}

TEST(Crowd, PeopleGetAboutAndStandAtExhibits) {
  const Museum museum = small_museum();
  Crowd crowd(museum, 40, Random(4));
  std::vector<double> way(40, 0.0);
  int looking_close = 0, looking = 0;
  for (int i = 0; i < 8000; ++i) {
    const auto before = crowd.people();
    crowd.step(dt, {museum.home, {}, {}});
    for (std::size_t k = 0; k < before.size(); ++k) {
      const Person& person = crowd.people()[k];
      const double moved = distance(person.position, before[k].position);
      if (moved < 0.2) way[k] += moved;  // who leaves comes back as someone else, at the entrance
      if (i % 100 != 0 || person.doing != Doing::looking) continue;
      ++looking;
      looking_close += std::ranges::any_of(
          museum.exhibits, [&](const Exhibit& e) { return distance_to_edge(e.outline, person.position) < 3.0; });
    }
  }
  EXPECT_GT(looking, 100);
  EXPECT_GT(looking_close, looking * 8 / 10);
  // In 200 s nearly everybody has gone somewhere.
  EXPECT_GT(std::ranges::count_if(way, [](double w) { return w > 10.0; }), 34);
}

TEST(Crowd, SomeGatherRoundTheStandingRobot) {
  const Museum museum = small_museum();
  Crowd crowd(museum, 60, Random(4));
  const RobotSeen robot{{7.5, 6.0, 0.0}, {}, {}};
  std::size_t most = 0;
  for (int i = 0; i < 8000; ++i) {
    crowd.step(dt, robot);
    most = std::max(most, static_cast<std::size_t>(std::ranges::count_if(crowd.people(), [&](const Person& person) {
                      return distance(person.position, robot.pose.position()) < 2.0;
                    })));
  }
  EXPECT_GE(most, 6u);
  EXPECT_LE(most, 40u);
}

TEST(Crowd, AttentivePeopleNeverOverlapAStandingRobot) {
  const Museum museum = small_museum();
  Crowd crowd(museum, 60, Random(9));
  const RobotSeen robot{{7.5, 6.0, 0.4}, {}, {}};
  int touches = 0;
  for (int i = 0; i < 6000; ++i) {
    crowd.step(dt, robot);
    for (const auto& person : crowd.people()) {
      touches += nearest_place(robot.footprint, robot.pose, person.position).distance < person.radius - 0.02;
    }
  }
  EXPECT_LT(touches, 60);  // the few with a phone before their eyes, until they notice
}

TEST(Crowd, BlockersMakeWayWhenAsked) {
  const Museum museum = testing::hall(12.0, 12.0);
  int freed = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Crowd crowd(museum, 1, Random(seed));
    const RobotSeen robot{{6.0, 6.0, 0.0}, {}, {}};
    crowd.people()[0].position = {6.8, 6.05};
    crowd.people()[0].doing = Doing::blocking;
    for (int i = 0; i < 400; ++i) {
      if (i % 80 == 0) crowd.hear(Cue::make_way, robot);
      crowd.step(dt, robot);
    }
    freed += std::abs(crowd.people()[0].position.y - 6.0) > 0.5 || crowd.people()[0].position.x > 8.0;
  }
  EXPECT_GE(freed, 18);
}

TEST(Crowd, SameSeedSameVisitors) {
  const Museum museum = small_museum();
  Crowd a(museum, 30, Random(4)), b(museum, 30, Random(4)), other(museum, 30, Random(5));
  for (int i = 0; i < 1000; ++i) {
    for (Crowd* crowd : {&a, &b, &other}) crowd->step(dt, {museum.home, {0.1, 0.0}, {}});
  }
  int apart = 0;
  for (std::size_t k = 0; k < 30; ++k) {
    EXPECT_EQ(a.people()[k].position, b.people()[k].position);
    apart += !(a.people()[k].position == other.people()[k].position);
  }
  EXPECT_GT(apart, 25);
}

}  // namespace
}  // namespace robot::simulation
