// The value function of the motion planner (RHINO 4.2, table and steps 1-5): for every cell the least cost of travel to
// the goal, over a grid of costs. Values are integers and the fixed point is unique, so that the bucket queue used here
// gives, cell for cell, what the paper's value iteration converges to.
//
// The paper's "selective reset" is done exactly: every cell remembers to which neighbour its best way leads; when the
// cost of a cell rises, precisely the cells whose way leads through it are reset, and refilled from their rim.
// Any-time: the wave advances by a counted number of cells; what it has settled is final until the costs change.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "robot/geometry/grid.hpp"

namespace robot {

// Cost of leaving a cell: 0 blocked, 1 open floor, up to max_cost.
using CostGrid = Grid<std::uint8_t>;

struct CostChange {
  Cell cell;
  std::uint8_t cost = 0;
};

class ValueFunction {
 public:
  static constexpr std::uint32_t unreached = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint32_t straight_step = 5, diagonal_step = 7;  // 7/5 stands for the square root of two
  static constexpr int max_cost = 120;

  ValueFunction() = default;
  explicit ValueFunction(const CostGrid& costs);  // costs above max_cost are taken as max_cost

  // Starts from scratch towards a goal. A blocked goal, or one off the grid, leaves every cell unreached.
  void set_goal(Cell goal);
  // Repairs for changed costs; the values that stay right stay untouched. Run work() afterwards.
  void change(std::span<const CostChange> changes);
  // Settles up to `cells` cells; true when nothing is left to do.
  bool work(int cells);
  void finish();
  bool finished() const { return queued_ == 0 && seeds_.empty(); }

  // Cost to the goal in steps of 1/5 cell of open floor; `unreached` when the wave has not been there (or never can).
  std::uint32_t value(Cell cell) const;
  // True when no later work() changes the value of this cell.
  bool settled(Cell cell) const;
  std::uint8_t cost(Cell cell) const;
  // The neighbour to which the best way leads; the cell itself at the goal or when it is unreached.
  Cell downhill(Cell cell) const;
  // Cells of the way to the goal, both ends included; empty when unreached.
  std::vector<Cell> descend(Cell from) const;
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  using Index = std::uint32_t;
  struct Seed {
    std::uint32_t value;
    Index cell;
  };
  static constexpr int bucket_count = 256;  // covers the dearest edge: 7 * 120 / 5 = 168 buckets

  Index index(Cell c) const { return static_cast<Index>(c.y + 1) * stride_ + static_cast<Index>(c.x + 1); }
  bool inside(Cell c) const { return c.x >= 0 && c.y >= 0 && c.x < width_ && c.y < height_; }
  void push(Index cell, std::uint32_t value);
  void expand(Index cell);
  void invalidate_from(Index cell, std::vector<Index>& reset);
  void refill(Index cell);
  void collect_queue();
  void admit_seeds();

  int width_ = 0;
  int height_ = 0;
  Index stride_ = 0;  // with a rim of blocked cells, so that no neighbour needs a check
  Index offset_[8] = {};
  std::vector<std::uint8_t> costs_;
  std::vector<std::uint32_t> values_;  // blocked cells and the rim hold 0: nothing ever improves them
  std::vector<std::uint8_t> parents_;  // direction 0..7 of the way, or `no_parent`
  Index goal_ = 0;                     // 0: none (a cell of the rim)
  std::vector<Index> buckets_[bucket_count];
  std::uint32_t current_ = 0;  // number of the bucket being settled, not wrapped
  std::size_t queued_ = 0;
  std::vector<Seed> seeds_;  // start of later waves, largest value first
};

}  // namespace robot
