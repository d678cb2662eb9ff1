#include "robot/tasks/visit_order.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "robot/geometry/pose.hpp"
#include "robot/geometry/random.hpp"

namespace robot {
namespace {

using testing::ElementsAre;

TravelCost straight(std::vector<Point> points) {  // points[0] is here
  return [points](int a, int b) {
    return distance(points[static_cast<std::size_t>(a)], points[static_cast<std::size_t>(b)]);
  };
}

double length(const std::vector<int>& order, const TravelCost& cost) {
  double sum = 0.0;
  int here = 0;
  for (const int stop : order) {
    sum += cost(here, stop);
    here = stop;
  }
  return sum;
}

TEST(VisitOrder, GoesAlongALineInOneSweep) {
  EXPECT_THAT(visit_order(3, straight({{0, 0}, {9, 0}, {3, 0}, {6, 0}})), ElementsAre(2, 3, 1));
}

TEST(VisitOrder, NothingToVisitIsAnEmptyOrder) { EXPECT_TRUE(visit_order(0, straight({{0, 0}})).empty()); }

TEST(VisitOrder, LeavesUnreachableStopsForLast) {
  const auto cost = [](int a, int b) {
    return a == 1 || b == 1 ? std::numeric_limits<double>::infinity() : std::abs(a - b) * 1.0;
  };
  EXPECT_THAT(visit_order(3, cost), ElementsAre(2, 3, 1));
}

TEST(VisitOrder, IsTheShortestOfAllPermutations) {
  Random random(7);
  for (int round = 0; round < 30; ++round) {
    std::vector<Point> points(7);
    for (auto& p : points) p = {random.uniform(0, 30), random.uniform(0, 30)};
    const auto cost = straight(points);
    std::vector<int> all(6);
    std::iota(all.begin(), all.end(), 1);
    double best = std::numeric_limits<double>::infinity();
    do {
      best = std::min(best, length(all, cost));
    } while (std::ranges::next_permutation(all).found);
    EXPECT_NEAR(length(visit_order(6, cost), cost), best, 1e-9);
  }
}

TEST(VisitOrder, BeyondTheExactLimitIsAPermutationAndNoWorseThanNearestNeighbour) {
  Random random(3);
  std::vector<Point> points(24);
  for (auto& p : points) p = {random.uniform(0, 60), random.uniform(0, 50)};
  const auto cost = straight(points);
  auto order = visit_order(23, cost);
  double greedy = 0.0;
  std::vector<bool> seen(24);
  for (int i = 0, here = 0; i < 23; ++i) {
    int next = 0;
    for (int k = 1; k < 24; ++k) {
      if (!seen[static_cast<std::size_t>(k)] && (next == 0 || cost(here, k) < cost(here, next))) next = k;
    }
    seen[static_cast<std::size_t>(next)] = true;
    greedy += cost(here, next);
    here = next;
  }
  EXPECT_LE(length(order, cost), greedy + 1e-9);
  std::ranges::sort(order);
  for (int i = 0; i < 23; ++i) EXPECT_EQ(order[static_cast<std::size_t>(i)], i + 1);
}

}  // namespace
}  // namespace robot
