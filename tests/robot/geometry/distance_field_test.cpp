#include "robot/geometry/distance_field.hpp"

#include <gmock/gmock.h>
#include <rapidcheck.h>

#include "robot/geometry/random.hpp"
#include "tests/support/ascii_world.hpp"
#include "tests/support/matchers.hpp"

namespace robot {
namespace {

using testing::ascii_world;
using testing::PointNear;

TEST(Surfaces, FilledAndHollowObstaclesLookAlike) {
  const auto filled = ascii_world(0.1, {"........", ".#####..", ".#####..", ".#####..", ".#####..", "........"});
  const auto hollow = ascii_world(0.1, {"........", ".#####..", ".#   #..", ".#   #..", ".#####..", "........"});
  const Mask of_filled = surfaces(filled);
  EXPECT_EQ(of_filled[(Cell{3, 2})], 0);
  EXPECT_EQ(of_filled[(Cell{1, 1})], 1);
  EXPECT_EQ(of_filled, surfaces(hollow));
}

TEST(Surfaces, OccupiedCellsSeenFromNowhereDoNotCount) {
  const Mask mask = surfaces(ascii_world(0.1, {"????", "?##?", "????"}));
  EXPECT_THAT(mask.cells(), ::testing::Each(0));
}

TEST(DistanceField, IsInMetresBetweenCentres) {
  const auto field = distance_field(ascii_world(0.1, {".....", ".....", "#...."}));
  EXPECT_FLOAT_EQ(field[(Cell{0, 0})], 0.0f);
  EXPECT_FLOAT_EQ(field[(Cell{3, 0})], 0.3f);
  EXPECT_FLOAT_EQ(field[(Cell{4, 2})], 0.1f * std::sqrt(20.0f));
}

TEST(DistanceField, WithoutASurfaceIsInfinite) {
  const auto field = distance_field(ascii_world(0.1, {"...", "..."}));
  EXPECT_THAT(field.cells(), ::testing::Each(std::numeric_limits<float>::infinity()));
  EXPECT_TRUE(distance_field(OccupancyGrid{}).empty());
}

TEST(DistanceField, EqualsBruteForceOnRandomGrids) {
  EXPECT_TRUE(rc::check([] {
    const int w = *rc::gen::inRange(1, 24), h = *rc::gen::inRange(1, 24);
    const double density = *rc::gen::element(0.01, 0.1, 0.5);
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    Mask mask(w, h, 1.0, {});
    for (auto& cell : mask.cells()) cell = random.chance(density) ? 1 : 0;
    const DistanceField field = distance_to(mask);
    for (std::size_t i = 0; i < mask.size(); ++i) {
      float nearest = std::numeric_limits<float>::infinity();
      for (std::size_t j = 0; j < mask.size(); ++j) {
        if (!mask.cells()[j]) continue;
        const Cell a = mask.cell_at(i), b = mask.cell_at(j);
        const double square = (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
        nearest = std::min(nearest, static_cast<float>(std::sqrt(square)));
      }
      RC_ASSERT(field.cells()[i] == nearest);
    }
  }));
}

TEST(Interpolate, IsExactOnAPlaneAndGivesItsGradient) {
  DistanceField field(6, 5, 0.5, {-1.0, 2.0});
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 6; ++x) {
      const Point p = field.center({x, y});
      field[{x, y}] = static_cast<float>(3.0 + 0.25 * p.x - 0.5 * p.y);
    }
  }
  const auto sample = interpolate(field, {0.33, 3.1});
  EXPECT_NEAR(sample.value, 3.0 + 0.25 * 0.33 - 0.5 * 3.1, 1e-6);
  EXPECT_THAT(sample.gradient, PointNear(Point{0.25, -0.5}, 1e-6));
}

TEST(Interpolate, OutsideItGrowsWithTheWayBackToTheBorder) {
  const auto field = distance_field(ascii_world(0.1, {"....", "....", "#..."}));
  const auto sample = interpolate(field, {9.35, 0.05});
  EXPECT_NEAR(sample.value, 0.3 + 9.0, 1e-6);
  EXPECT_THAT(sample.gradient, PointNear(Point{1.0, 0.0}, 1e-9));
}

}  // namespace
}  // namespace robot
