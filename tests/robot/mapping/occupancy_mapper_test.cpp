#include "robot/mapping/occupancy_mapper.hpp"

#include <gmock/gmock.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>

#include "robot/geometry/random.hpp"
#include "robot/geometry/ray_cast.hpp"
#include "tests/support/ascii_world.hpp"

namespace robot {
namespace {

using testing::draw_world;

LaserScan one_beam(float range, float max_range = 30.0f) { return {{}, LaserId::front, 0.0, 0.01, max_range, {range}}; }

LaserScan all_round(const RayCaster& world, const Pose& from, int beams = 360) {
  LaserScan scan{{}, LaserId::front, -pi, 2 * pi / beams, 30.0f, {}};
  for (int i = 0; i < beams; ++i) {
    const double angle = from.theta + scan.angle_min + i * scan.angle_step;
    scan.ranges.push_back(static_cast<float>(world.cast(from.position(), angle, 30.0) + 0.01));
  }
  return scan;
}

TEST(OccupancyMapper, OneBeamClearsItsWayAndMarksItsEnd) {
  OccupancyMapper mapper({.resolution = 0.1});
  mapper.insert(one_beam(1.0f), {0.05, 0.05, 0.0});
  const auto map = mapper.map();
  for (double x = 0.05; x < 1.0; x += 0.1) EXPECT_EQ(map[map.cell({x, 0.05})], 42) << x;
  EXPECT_EQ(map[map.cell({1.05, 0.05})], 70);
  EXPECT_EQ(map[map.cell({1.15, 0.05})], unknown_cell);
  EXPECT_EQ(map[map.cell({0.05, 0.15})], unknown_cell);
}

TEST(OccupancyMapper, EvidenceAddsUpToItsBounds) {
  OccupancyMapper mapper({.resolution = 0.1, .least = 0.05, .most = 0.9});
  for (int i = 0; i < 30; ++i) mapper.insert(one_beam(1.0f), {0.05, 0.05, 0.0});
  const auto map = mapper.map();
  EXPECT_EQ(map[map.cell({0.55, 0.05})], 5);
  EXPECT_EQ(map[map.cell({1.05, 0.05})], 90);
}

TEST(OccupancyMapper, AScanCountsOnceACellAndHitsComeFirst) {
  // The second beam passes the cell in which the first one ended.
  LaserScan scan{{}, LaserId::front, 0.0, 0.0, 30.0f, {1.0f, 2.0f, 1.0f}};
  OccupancyMapper mapper({.resolution = 0.1});
  mapper.insert(scan, {0.05, 0.05, 0.0});
  const auto map = mapper.map();
  EXPECT_EQ(map[map.cell({1.05, 0.05})], 70);
  EXPECT_EQ(map[map.cell({0.55, 0.05})], 42);
}

TEST(OccupancyMapper, LeavesOutWhatIsNoRange) {
  OccupancyMapper mapper;
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  mapper.insert({{}, LaserId::front, 0.0, 0.1, 30.0f, {nan, inf, -1.0f, 0.0f, 30.0f, 31.0f}}, {});
  EXPECT_THAT(mapper.map().cells(), ::testing::Each(unknown_cell));
  mapper.insert(one_beam(1.0f), {std::nan(""), 0.0, 0.0});
  EXPECT_EQ(mapper.scans(), 1);
}

TEST(OccupancyMapper, BeyondItsRangeBeamsOnlyClear) {
  OccupancyMapper mapper({.resolution = 0.1, .max_range = 1.0});
  mapper.insert(one_beam(5.0f), {0.05, 0.05, 0.0});
  const auto map = mapper.map();
  EXPECT_EQ(map[map.cell({0.95, 0.05})], 42);
  EXPECT_EQ(map[map.cell({1.05, 0.05})], 42);
  EXPECT_EQ(map.at_or(map.cell({5.05, 0.05}), unknown_cell), unknown_cell);
}

TEST(OccupancyMapper, RefusesProbabilitiesOnTheWrongSide) {
  EXPECT_THROW(OccupancyMapper({.hit = 0.4}), std::invalid_argument);
  EXPECT_THROW(OccupancyMapper({.miss = 0.6}), std::invalid_argument);
  EXPECT_THROW(OccupancyMapper({.most = 1.0}), std::invalid_argument);
}

TEST(OccupancyMapper, LearnsTheRoomItWasDrivenThrough) {
  const auto world = draw_world(0.2, {"####################",  //
                                      "#..................#",  //
                                      "#..A.....####......#",  //
                                      "#........####..B...#",  //
                                      "#..................#",  //
                                      "####################"});
  const RayCaster caster(world.map);
  OccupancyMapper mapper({.resolution = 0.1});
  for (int i = 0; i < 10; ++i) {
    mapper.insert(all_round(caster, {world.at('A').x, world.at('A').y, 0.03 * i}),
                  {world.at('A').x, world.at('A').y, 0.03 * i});
    mapper.insert(all_round(caster, {world.at('B').x, world.at('B').y, 0.03 * i}),
                  {world.at('B').x, world.at('B').y, 0.03 * i});
  }
  const auto map = mapper.map();
  EXPECT_TRUE(is_free(map[map.cell({3.2, 0.3})]));
  EXPECT_TRUE(is_occupied(map[map.cell({1.05, 0.15})]));  // the lower wall's face
  EXPECT_TRUE(is_occupied(map[map.cell({1.85, 0.6})]));   // the block's left face
  EXPECT_EQ(map[map.cell({2.2, 0.6})], unknown_cell);     // its inside
}

TEST(OccupancyMapper, GrowsWithoutLosingOrMovingAnything) {
  EXPECT_TRUE(rc::check([] {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    OccupancyMapper mapper({.resolution = 0.1});
    std::vector<Point> ends;
    for (int i = 0; i < 12; ++i) {
      const Pose from{random.uniform(-20.0, 20.0), random.uniform(-20.0, 20.0), random.uniform(-pi, pi)};
      const double range = random.uniform(0.5, 20.0);
      for (int k = 0; k < 5; ++k) mapper.insert(one_beam(static_cast<float>(range)), from);
      ends.push_back(from * Point{static_cast<float>(range), 0.0});
    }
    const auto map = mapper.map();
    int marked = 0;
    for (const Point& end : ends) marked += map.contains(end) && is_occupied(map[map.cell(end)]) ? 1 : 0;
    RC_ASSERT(marked >= 11);  // now and then a later beam has passed an older end
  }));
}

TEST(OccupancyMapper, StaysBoundedWhateverPosesItIsGiven) {
  OccupancyMapper mapper({.resolution = 1.0, .max_extent = 50.0});
  mapper.insert(one_beam(5.0f), {});
  mapper.insert(one_beam(5.0f), {1e12, -1e12, 1.0});
  mapper.insert(one_beam(5.0f), {45.0, 0.0, 0.0});
  EXPECT_EQ(mapper.scans(), 2);
  EXPECT_LE(mapper.map().width(), 400);
}

}  // namespace
}  // namespace robot
