#include "robot/geometry/ray_cast.hpp"

#include <gmock/gmock.h>
#include <rapidcheck.h>

#include "robot/geometry/random.hpp"
#include "tests/support/ascii_world.hpp"

namespace robot {
namespace {

using testing::ascii_world;
using testing::draw_world;

TEST(RayCast, EndsAtTheFaceOfTheOccupiedCell) {
  const auto world = draw_world(0.1, {"#######", "#R....#", "#######"});
  const RayCaster caster(world.map);
  EXPECT_NEAR(cast_ray(world.map, world.at('R'), 0.0, 10.0), 0.45, 1e-12);
  EXPECT_NEAR(caster.cast(world.at('R'), 0.0, 10.0), 0.45, 1e-12);
  EXPECT_NEAR(caster.cast(world.at('R'), pi, 10.0), 0.05, 1e-12);
  EXPECT_NEAR(caster.cast(world.at('R'), pi / 2, 10.0), 0.05, 1e-12);
}

TEST(RayCast, GivesMaxRangeWhenNothingIsMet) {
  const auto world = draw_world(0.1, {"......#", ".R.....", "......."});
  const RayCaster caster(world.map);
  for (const double angle : {0.0, pi / 2, pi, -pi / 2, 1.2}) {
    EXPECT_EQ(cast_ray(world.map, world.at('R'), angle, 7.0), 7.0) << angle;
    EXPECT_EQ(caster.cast(world.at('R'), angle, 7.0), 7.0) << angle;
  }
}

TEST(RayCast, StopsAtMaxRangeBeforeTheWall) {
  const auto world = draw_world(0.1, {"R........#"});
  EXPECT_EQ(cast_ray(world.map, world.at('R'), 0.0, 0.5), 0.5);
  EXPECT_EQ(RayCaster(world.map).cast(world.at('R'), 0.0, 0.5), 0.5);
}

TEST(RayCast, FromInsideAWallIsZeroAndFromOutsideTheMapSeesNothing) {
  const auto map = ascii_world(0.1, {"###", "###"});
  const RayCaster caster(map);
  EXPECT_EQ(caster.cast({0.15, 0.15}, 1.0, 5.0), 0.0);
  EXPECT_EQ(cast_ray(map, {0.15, 0.15}, 1.0, 5.0), 0.0);
  EXPECT_EQ(caster.cast({-1.0, 0.15}, 0.0, 5.0), 5.0);
  EXPECT_EQ(cast_ray(map, {-1.0, 0.15}, 0.0, 5.0), 5.0);
}

TEST(RayCast, BadNumbersSeeNothing) {
  const auto map = ascii_world(0.1, {"#.#"});
  const RayCaster caster(map);
  const double nan = std::nan("");
  EXPECT_EQ(caster.cast({nan, 0.05}, 0.0, 5.0), 5.0);
  EXPECT_EQ(caster.cast({0.15, 0.05}, nan, 5.0), 5.0);
  EXPECT_EQ(cast_ray(map, {0.15, nan}, 0.0, 5.0), 5.0);
}

TEST(RayCast, UnknownCellsDoNotStopABeam) {
  const auto world = draw_world(0.1, {"R??.#"});
  EXPECT_NEAR(RayCaster(world.map).cast(world.at('R'), 0.0, 5.0), 0.35, 1e-12);
}

TEST(RayCast, MarchEqualsTraversal) {
  EXPECT_TRUE(rc::check([] {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const int w = *rc::gen::inRange(1, 80), h = *rc::gen::inRange(1, 80);
    const double density = *rc::gen::element(0.0, 0.002, 0.02, 0.2);
    OccupancyGrid map(w, h, 0.05, {random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0)}, free_cell);
    for (auto& cell : map.cells()) cell = random.chance(density) ? occupied_cell : free_cell;
    const RayCaster caster(map);
    for (int i = 0; i < 50; ++i) {
      const Point from{map.origin().x + random.uniform() * w * 0.05, map.origin().y + random.uniform() * h * 0.05};
      const double angle = i % 5 == 0 ? pi / 4 * static_cast<double>(random.index(8)) : random.uniform(-pi, pi);
      RC_ASSERT(std::abs(caster.cast(from, angle, 3.0) - cast_ray(map, from, angle, 3.0)) < 1e-9);
    }
  }));
}

}  // namespace
}  // namespace robot
