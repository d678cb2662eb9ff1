#include "robot/planning/planner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "robot/geometry/random.hpp"
#include "robot/planning/path.hpp"
#include "tests/support/ascii_world.hpp"
#include "tests/support/matchers.hpp"

namespace robot {
namespace {

using testing::AsciiWorld;
using testing::draw_world;
using ::testing::Each;
using testing::PointNear;
using ::testing::Truly;

const Footprint body = standard_body().footprint;

// Drawn at 25 cm a character, planned at 5 cm.
OccupancyGrid finer(const OccupancyGrid& coarse, int factor) {
  OccupancyGrid fine(coarse.width() * factor, coarse.height() * factor, coarse.resolution() / factor, coarse.origin());
  for (std::size_t i = 0; i < fine.size(); ++i) {
    const Cell c = fine.cell_at(i);
    fine.cells()[i] = coarse[{c.x / factor, c.y / factor}];
  }
  return fine;
}

struct Site {
  AsciiWorld drawn;
  Museum museum;
  Site(const std::vector<std::string>& rows) : drawn(draw_world(0.25, rows)) { museum.map = finer(drawn.map, 5); }
  Point at(char mark) const { return drawn.at(mark); }
};

// Two rooms joined by two doors: a near one and one far up.
Site two_rooms() {
  return Site({
      "########################################", "#                   #                  #",
      "#                   #                  #", "#                                      #",
      "#                                      #", "#                                      #",
      "#                   #                  #", "#                   #                  #",
      "#                   #                  #", "#                   #                  #",
      "#                   #                  #", "#                   #                  #",
      "#                   #                  #", "#                   #                  #",
      "#                                      #", "#         A         D         B        #",
      "#                                      #", "#                   #                  #",
      "#   C               #                  #", "########################################",
  });
}

void plan(Planner& planner, Point goal) {
  ASSERT_TRUE(planner.set_goal(goal));
  while (!planner.work(5000)) {
  }
}

// Somebody stands at a place for a while.
void block(ObstacleLayers& layers, Point place, double radius) {
  ScanView scan;
  scan.angle_step = 0.02;
  scan.angle_min = -pi;
  for (int i = 0; i < 315; ++i) {
    scan.ranges.push_back(static_cast<float>(radius));
    scan.kinds.push_back(BeamKind::person);
  }
  scan.map_from_laser = {place.x, place.y, 0.0};
  for (int i = 0; i < 20; ++i) layers.add(scan);
}

TEST(Planner, TakesTheNearDoorAndStaysClearOfWalls) {
  const Site site = two_rooms();
  Planner planner(site.museum, body);
  plan(planner, site.at('B'));
  const auto path = planner.path_from(site.at('A'));
  ASSERT_GE(path.size(), 2u);
  EXPECT_THAT(path.front(), PointNear(site.at('A'), 1e-9));
  EXPECT_THAT(path.back(), PointNear(site.at('B'), 1e-9));
  EXPECT_NEAR(path_length(path), distance(site.at('A'), site.at('B')), 0.1);
  const auto& clearance = planner.costs().clearance();
  EXPECT_THAT(resample(path, 0.05),
              Each(Truly([&](Point p) { return clearance[clearance.cell(p)] > body.half_width; })));
  EXPECT_GT(planner.value_at(site.at('A')), 5.0);   // metres,
  EXPECT_LT(planner.value_at(site.at('A')), 15.0);  // dearer in a door of 0.75 m
}

TEST(Planner, TakesADetourWhilePeopleBlockTheDoorAndReturnsWhenTheyLeave) {
  const Site site = two_rooms();
  Planner planner(site.museum, body);
  ObstacleLayers layers(site.museum.map);
  plan(planner, site.at('B'));
  const auto passes_near_door = [&] {
    const auto path = resample(planner.path_from(site.at('A')), 0.05);
    return std::any_of(path.begin(), path.end(), [&](Point p) { return distance(p, site.at('D')) < 1.0; });
  };
  EXPECT_TRUE(passes_near_door());
  EXPECT_EQ(planner.crowding_from(site.at('A')), 0.0);
  block(layers, site.at('D'), 0.3);
  planner.update(layers);
  planner.work(1 << 30);
  EXPECT_FALSE(passes_near_door());
  EXPECT_TRUE(std::isfinite(planner.value_at(site.at('A'))));
  layers.forget();
  planner.update(layers);
  planner.work(1 << 30);
  EXPECT_TRUE(passes_near_door());
}

TEST(Planner, ACrowdedPassageStaysPossibleWhenThereIsNoWayRound) {
  Site site = two_rooms();
  for (int y = 60; y < 99; ++y) site.museum.map[{102, y}] = occupied_cell;  // wall up the far door
  Planner planner(site.museum, body);
  ObstacleLayers layers(site.museum.map);
  plan(planner, site.at('B'));
  block(layers, site.at('D'), 0.3);
  planner.update(layers);
  planner.work(1 << 30);
  EXPECT_FALSE(planner.path_from(site.at('A')).empty());
  EXPECT_GT(planner.crowding_from(site.at('A')), 5.0);
}

TEST(Planner, SaysWhenThereIsNoWay) {
  Site site = two_rooms();
  for (int y = 0; y < 100; ++y) site.museum.map[{102, y}] = occupied_cell;
  Planner planner(site.museum, body);
  ASSERT_TRUE(planner.set_goal(site.at('B')));
  planner.work(10);
  EXPECT_FALSE(planner.ready(site.at('A')));
  planner.work(1 << 30);
  EXPECT_TRUE(planner.ready(site.at('A')));
  EXPECT_TRUE(std::isinf(planner.value_at(site.at('A'))));
  EXPECT_TRUE(planner.path_from(site.at('A')).empty());
}

TEST(Planner, APathIsThereAsSoonAsTheWaveHasCome) {
  const Site site = two_rooms();
  Planner planner(site.museum, body);
  ASSERT_TRUE(planner.set_goal(site.at('B')));
  int slices = 0;
  while (!planner.ready(site.at('A')) && slices < 1000) {
    planner.work(200);
    ++slices;
  }
  EXPECT_FALSE(planner.values().finished());
  const auto early = planner.path_from(site.at('A'));
  planner.work(1 << 30);
  EXPECT_EQ(early, planner.path_from(site.at('A')));
}

TEST(Planner, PlacesAreTakenForWhatTheyAre) {
  Site site = two_rooms();
  site.museum.hazards.push_back({"pit", HazardKind::staircase, {{6, 1}, {8, 1}, {8, 2}, {6, 2}}, {}});
  const Planner planner(site.museum, body);
  EXPECT_EQ(planner.place(site.at('A')), PlaceKind::traversable);
  EXPECT_EQ(planner.place({0.1, 0.1}), PlaceKind::inside_obstacle);
  EXPECT_EQ(planner.place({0.3, 3.0}), PlaceKind::too_tight);
  EXPECT_EQ(planner.place({7.0, 1.5}), PlaceKind::in_hazard);
  EXPECT_EQ(planner.place({-1.0, 3.0}), PlaceKind::off_the_map);
  EXPECT_EQ(planner.place({std::numeric_limits<double>::quiet_NaN(), 3.0}), PlaceKind::off_the_map);
}

TEST(Planner, AGoalThatIsTooTightIsReplacedByTheNearestPlace) {
  const Site site = two_rooms();
  Planner planner(site.museum, body);
  EXPECT_TRUE(planner.set_goal({0.35, 3.0}));
  EXPECT_THAT(*planner.goal(), PointNear(Point{0.55, 3.0}, 0.1));
  EXPECT_FALSE(planner.set_goal({0.1, 0.1}));
  EXPECT_FALSE(planner.goal());
  EXPECT_TRUE(planner.path_from(site.at('A')).empty());
}

TEST(Planner, ARobotThatStandsTooTightOrInAHazardIsLedOut) {
  Site site = two_rooms();
  site.museum.hazards.push_back({"pit", HazardKind::staircase, {{6, 1}, {8, 1}, {8, 2}, {6, 2}}, {}});
  Planner planner(site.museum, body);
  plan(planner, site.at('A'));
  for (const Point from : {Point{0.3, 3.0}, Point{7.0, 1.6}}) {
    const auto path = planner.path_from(from);
    ASSERT_GE(path.size(), 2u);
    EXPECT_EQ(path.front(), from);
    EXPECT_LT(distance(path[0], path[1]), 1.2);
    EXPECT_TRUE(std::isfinite(planner.value_at(from)));
  }
}

TEST(Planner, HazardsAndTheOutsideOfTheBoundaryAreWalkedRound) {
  Site site = two_rooms();
  site.museum.hazards.push_back({"rope", HazardKind::keep_out, {{3.0, 0.2}, {3.1, 0.2}, {3.1, 3.0}, {3.0, 3.0}}, {}});
  site.museum.boundary = {{0.2, 0.2}, {9.8, 0.2}, {9.8, 4.8}, {0.2, 4.8}};
  Planner planner(site.museum, body);
  plan(planner, site.at('C'));
  const auto path = resample(planner.path_from({4.0, 0.9}), 0.05);
  ASSERT_FALSE(path.empty());
  EXPECT_TRUE(std::any_of(path.begin(), path.end(), [](Point p) { return p.y > 3.2; }));
  EXPECT_THAT(path, Each(Truly([](Point p) { return p.y < 4.5; })));
  EXPECT_TRUE(std::isinf(planner.value_at({2.0, 4.9 + 2.5})));
}

TEST(Planner, TravelIsSymmetricAndKnowsWhereThereIsNoWay) {
  Site site = two_rooms();
  const Planner planner(site.museum, body);
  const std::vector<Point> points = {site.at('A'), site.at('B'), site.at('C'), {0.1, 0.1}};
  const auto metres = planner.travel_distances(points);
  EXPECT_EQ(metres[0][0], 0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) EXPECT_EQ(metres[i][j], metres[j][i]);
  }
  EXPECT_GE(metres[0][1], distance(points[0], points[1]) - 0.4);
  EXPECT_LE(metres[0][1], distance(points[0], points[1]) + 10.0);
  EXPECT_GT(metres[1][2], metres[0][2]);
  EXPECT_TRUE(std::isinf(metres[0][3]));
  const auto from_a = planner.travel_from(site.at('A'), points);
  // The other direction leaves other ends, which may be tight.
  for (std::size_t j = 1; j < 3; ++j) EXPECT_NEAR(from_a[j], metres[0][j], 3.0);
}

// After any coming and going of people the planner's values are those of a planner that starts from scratch.
RC_GTEST_PROP(PlannerRepair, EqualsAPlannerFromScratch, (std::uint64_t seed)) {
  static const Site site = two_rooms();
  Random random(seed);
  Planner planner(site.museum, body);
  ObstacleLayers layers(site.museum.map);
  RC_ASSERT(planner.set_goal(site.at('B')));
  for (int round = 0; round < 5; ++round) {
    planner.work(static_cast<int>(random.index(20000)));
    if (random.chance(0.6)) {
      block(layers, {random.uniform(0.5, 9.5), random.uniform(0.5, 4.5)}, random.uniform(0.05, 0.4));
    } else {
      layers.forget_near({random.uniform(0.5, 9.5), random.uniform(0.5, 4.5)}, 2.0);
    }
    planner.update(layers);
  }
  planner.work(1 << 30);
  // Scratch learns of all blocked cells at once.
  CostMap costs(site.museum, body);
  costs.update(layers.blocked_cells(), layers);
  RC_ASSERT(costs.costs() == planner.costs().costs());
  ValueFunction scratch(costs.costs());
  scratch.set_goal(site.museum.map.cell(*planner.goal()));
  scratch.finish();
  for (std::size_t i = 0; i < site.museum.map.size(); ++i) {
    const Cell c = site.museum.map.cell_at(i);
    RC_ASSERT(planner.values().value(c) == scratch.value(c));
  }
}

TEST(Path, ResamplingKeepsCornersAndLength) {
  const std::vector<Point> path = {{0, 0}, {1, 0}, {1, 2}};
  const auto points = resample(path, 0.3);
  EXPECT_NEAR(path_length(points), 3.0, 1e-9);
  EXPECT_THAT(points, ::testing::Contains(Point{1, 0}));
  for (std::size_t i = 1; i < points.size(); ++i) EXPECT_LE(distance(points[i - 1], points[i]), 0.3 + 1e-9);
  EXPECT_TRUE(straighten({}, CostGrid(3, 3, 1.0, {}, 1)).empty());
}

TEST(Path, StraighteningCutsStairsButNoDearGround) {
  CostGrid costs(40, 40, 0.05, {}, 1);
  std::vector<Cell> stairs;
  for (int i = 0; i < 30; ++i) stairs.push_back({i, i / 2});
  EXPECT_EQ(straighten(stairs, costs).size(), 2u);
  for (int i = 8; i < 22; ++i) costs[{i, 5}] = costs[{i, 6}] = costs[{i, 7}] = costs[{i, 8}] = 40;
  std::vector<Cell> round_it;
  for (int x = 5; x <= 24; ++x) round_it.push_back({x, 2});
  for (int y = 3; y <= 7; ++y) round_it.push_back({24, y});
  EXPECT_GT(straighten(round_it, costs).size(), 2u);
}

}  // namespace
}  // namespace robot
