#include "robot/geometry/polygon.hpp"

#include <gtest/gtest.h>

namespace robot {
namespace {

const std::vector<Point> square = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};

TEST(Polygon, KnowsInsideFromOutside) {
  EXPECT_TRUE(contains(square, {1.0, 1.9}));
  EXPECT_FALSE(contains(square, {1.0, 2.1}));
  EXPECT_FALSE(contains({}, {0.0, 0.0}));
  const std::vector<Point> hook = {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {0, 1}};
  EXPECT_TRUE(contains(hook, {2.5, 2.5}));
  EXPECT_FALSE(contains(hook, {1.0, 2.0}));
}

TEST(Polygon, MeasuresToItsEdgeFromBothSides) {
  EXPECT_DOUBLE_EQ(distance_to_edge(square, {1.0, 1.5}), 0.5);
  EXPECT_DOUBLE_EQ(distance_to_edge(square, {5.0, 6.0}), 5.0);
}

TEST(Polygon, AreaIsSignedByTurn) {
  EXPECT_DOUBLE_EQ(signed_area(square), 4.0);
  EXPECT_DOUBLE_EQ(signed_area({{0, 2}, {2, 2}, {2, 0}, {0, 0}}), -4.0);
}

TEST(Polygon, FindsCrossedAndRepeatedCorners) {
  EXPECT_FALSE(crosses_itself(square));
  EXPECT_TRUE(crosses_itself({{0, 0}, {2, 2}, {2, 0}, {0, 2}}));
  EXPECT_TRUE(crosses_itself({{0, 0}, {0, 0}, {2, 0}, {0, 2}}));
  EXPECT_FALSE(crosses_itself({{0, 0}, {2, 0}, {0, 2}}));
}

}  // namespace
}  // namespace robot
