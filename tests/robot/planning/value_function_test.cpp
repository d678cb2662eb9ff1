#include "robot/planning/value_function.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <vector>

#include "robot/geometry/random.hpp"

namespace robot {
namespace {

CostGrid open_floor(int width, int height) { return CostGrid(width, height, 0.05, {}, 1); }

// The paper's value iteration (RHINO 4.2, steps 1 and 2), sweep by sweep until nothing changes.
Grid<std::uint32_t> value_iteration(const CostGrid& costs, Cell goal) {
  Grid<std::uint32_t> values(costs.width(), costs.height(), 1.0, {}, ValueFunction::unreached);
  if (costs.at_or(goal, 0) == 0) return values;
  values[goal] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Cell c = values.cell_at(i);
      if (costs[c] == 0 || c == goal) continue;
      for (int d = 0; d < 9; ++d) {
        const Cell n{c.x + d % 3 - 1, c.y + d / 3 - 1};
        const std::uint32_t value = values.at_or(n, ValueFunction::unreached);
        if (n == c || value == ValueFunction::unreached) continue;
        const auto step = n.x != c.x && n.y != c.y ? ValueFunction::diagonal_step : ValueFunction::straight_step;
        if (value + step * costs[c] >= values[c]) continue;
        values[c] = value + step * costs[c];
        changed = true;
      }
    }
  }
  return values;
}

void expect_same(const ValueFunction& values, const Grid<std::uint32_t>& expected) {
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Cell c = expected.cell_at(i);
    ASSERT_EQ(values.value(c), expected[c]) << "cell " << c.x << "," << c.y;
  }
}

TEST(ValueFunction, CountsStepsOnOpenFloor) {
  ValueFunction values(open_floor(10, 5));
  values.set_goal({2, 2});
  values.finish();
  EXPECT_EQ(values.value({2, 2}), 0u);
  EXPECT_EQ(values.value({7, 2}), 5u * ValueFunction::straight_step);
  EXPECT_EQ(values.value({4, 4}), 2u * ValueFunction::diagonal_step);
  EXPECT_EQ(values.value({7, 3}), 4u * ValueFunction::straight_step + ValueFunction::diagonal_step);
}

TEST(ValueFunction, WallsAreWalkedRound) {
  CostGrid costs = open_floor(7, 7);
  for (int y = 0; y < 6; ++y) costs[{3, y}] = 0;
  ValueFunction values(costs);
  values.set_goal({5, 0});
  values.finish();
  const auto way = values.descend({1, 0});
  ASSERT_FALSE(way.empty());
  EXPECT_EQ(way.front(), (Cell{1, 0}));
  EXPECT_EQ(way.back(), (Cell{5, 0}));
  EXPECT_TRUE(std::ranges::any_of(way, [](Cell c) { return c == Cell{3, 6}; }));
  EXPECT_EQ(values.value({3, 0}), ValueFunction::unreached);
}

TEST(ValueFunction, AGoalThatIsBlockedOrOffTheGridReachesNothing) {
  CostGrid costs = open_floor(5, 5);
  costs[{2, 2}] = 0;
  ValueFunction values(costs);
  for (const Cell goal : {Cell{2, 2}, Cell{-1, 0}, Cell{0, 5}}) {
    values.set_goal(goal);
    values.finish();
    EXPECT_EQ(values.value({0, 0}), ValueFunction::unreached);
    EXPECT_TRUE(values.descend({0, 0}).empty());
    EXPECT_TRUE(values.settled({0, 0}));
  }
}

TEST(ValueFunction, WhatIsSettledStaysWhileTheWaveGoesOn) {
  Random random(3);
  CostGrid costs = open_floor(40, 40);
  for (auto& cost : costs.cells()) cost = static_cast<std::uint8_t>(random.index(8));
  costs[{5, 5}] = 1;
  const auto expected = value_iteration(costs, {5, 5});
  ValueFunction values(costs);
  values.set_goal({5, 5});
  while (!values.work(37)) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const Cell c = expected.cell_at(i);
      ASSERT_TRUE(!values.settled(c) || values.value(c) == expected[c]);
    }
  }
  expect_same(values, expected);
}

TEST(ValueFunction, ADoorThatClosesAndOpensAgain) {
  CostGrid costs = open_floor(11, 5);
  for (int y = 0; y < 5; ++y) costs[{5, y}] = y == 2 ? 1 : 0;
  ValueFunction values(costs);
  values.set_goal({9, 2});
  values.finish();
  const auto open_value = values.value({1, 2});
  const CostChange shut{{5, 2}, 0}, open{{5, 2}, 1};
  values.change({&shut, 1});
  values.finish();
  EXPECT_EQ(values.value({1, 2}), ValueFunction::unreached);
  EXPECT_EQ(values.value({8, 2}), ValueFunction::straight_step);
  values.change({&open, 1});
  values.finish();
  EXPECT_EQ(values.value({1, 2}), open_value);
}

TEST(ValueFunction, ChangesOffTheGridAndUnchangedCostsAreNoWork) {
  ValueFunction values(open_floor(5, 5));
  values.set_goal({2, 2});
  values.finish();
  const std::vector<CostChange> none = {{{-1, 0}, 3}, {{0, 9}, 0}, {{1, 1}, 1}};
  values.change(none);
  EXPECT_TRUE(values.finished());
}

// The heart of it: after any sequence of changes, in the middle of a wave or after it, repair gives cell for cell what
// the paper's plain value iteration gives from scratch.
RC_GTEST_PROP(ValueFunctionRepair, EqualsValueIterationFromScratch, (std::uint64_t seed)) {
  Random random(seed);
  const int width = 2 + static_cast<int>(random.index(25)), height = 2 + static_cast<int>(random.index(25));
  const auto any_cell = [&] {
    return Cell{static_cast<int>(random.index(static_cast<std::uint64_t>(width))),
                static_cast<int>(random.index(static_cast<std::uint64_t>(height)))};
  };
  const auto any_cost = [&] {
    return static_cast<std::uint8_t>(random.chance(0.25)  ? 0
                                     : random.chance(0.5) ? 1
                                                          : 1 + random.index(ValueFunction::max_cost));
  };
  CostGrid costs(width, height, 0.05, {}, 1);
  for (auto& cost : costs.cells()) cost = any_cost();
  const Cell goal = any_cell();
  ValueFunction values(costs);
  values.set_goal(goal);
  for (int round = 0; round < 6; ++round) {
    values.work(static_cast<int>(random.index(300)));
    std::vector<CostChange> changes;
    for (std::uint64_t n = 1 + random.index(30); n > 0; --n) changes.push_back({any_cell(), any_cost()});
    for (const auto& [cell, cost] : changes) costs[cell] = cost;
    values.change(changes);
    if (random.chance(0.5)) continue;  // the next changes meet an unfinished wave
    values.finish();
    const auto expected = value_iteration(costs, goal);
    for (std::size_t i = 0; i < expected.size(); ++i)
      RC_ASSERT(values.value(expected.cell_at(i)) == expected.cells()[i]);
  }
}

// Every cell's way downhill adds up to its value.
RC_GTEST_PROP(ValueFunctionRepair, DescentCostsWhatTheValueSays, (std::uint64_t seed)) {
  Random random(seed);
  CostGrid costs(20, 20, 0.05, {}, 1);
  for (auto& cost : costs.cells()) cost = static_cast<std::uint8_t>(random.index(5));
  costs[{10, 10}] = 1;
  ValueFunction values(costs);
  values.set_goal({10, 10});
  values.finish();
  std::vector<CostChange> changes;
  for (int i = 0; i < 20; ++i) {
    changes.push_back({costs.cell_at(random.index(costs.size())), static_cast<std::uint8_t>(random.index(5))});
  }
  std::erase_if(changes, [](const CostChange& c) { return c.cell == Cell{10, 10}; });
  for (const auto& [cell, cost] : changes) costs[cell] = cost;
  values.change(changes);
  values.finish();
  for (std::size_t i = 0; i < costs.size(); ++i) {
    const Cell from = costs.cell_at(i);
    if (values.value(from) == ValueFunction::unreached) continue;
    const auto way = values.descend(from);
    std::uint32_t sum = 0;
    for (std::size_t k = 0; k + 1 < way.size(); ++k) {
      const bool diagonal = way[k].x != way[k + 1].x && way[k].y != way[k + 1].y;
      sum += (diagonal ? ValueFunction::diagonal_step : ValueFunction::straight_step) * costs[way[k]];
    }
    RC_ASSERT(sum == values.value(from));
  }
}

}  // namespace
}  // namespace robot
