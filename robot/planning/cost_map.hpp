// What it costs to be somewhere: from the static map, hazards and boundary (blocked where the robot cannot stand, dear
// where it is tight) and from temporary obstacles (dear but never blocked, so that a crowded passage stays possible
// when there is no way round).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "robot/body.hpp"
#include "robot/mapping/obstacle_layers.hpp"
#include "robot/museum.hpp"
#include "robot/planning/value_function.hpp"

namespace robot {

struct CostMapConfig {
  double margin = 0.04;                // m beyond the inscribed radius within which a static obstacle blocks
  double comfortable = 0.75;           // m of clearance from which on a place costs no more than open floor
  int tight_cost = 12;                 // open floor = 1; just outside the margin
  int temporary_cost = 60;             // where the robot would touch a temporary obstacle
  int temporary_near_cost = 10;        // just outside of that, falling to nothing at `comfortable_temporary`
  double comfortable_temporary = 0.6;  // m
};

class CostMap {
 public:
  // Unknown cells, hazards and everything outside of the boundary are blocked.
  CostMap(const Museum& museum, const Footprint& footprint, const CostMapConfig& config = {});

  // Takes over which cells are temporarily blocked and gives the costs that changed by it.
  std::vector<CostChange> update(std::span<const Cell> changed, const ObstacleLayers& layers);

  const CostGrid& costs() const { return costs_; }
  // Without anything temporary.
  const CostGrid& static_costs() const { return static_; }
  // Metres from the cell's centre to the nearest static obstacle, hazard or border.
  const Grid<float>& clearance() const { return clearance_; }
  // Known to be free, outside of hazards and inside of the boundary: a point of the floor, not a place for the robot.
  bool floor(Cell cell) const { return clearance_.at_or(cell, 0.0f) > 0.0f; }

 private:
  struct Stamp {
    int dx, dy;
    std::uint8_t cost;
  };
  void touch(Cell cell);
  void stamp(Cell center);
  void erase(Cell center);
  void restamp_near(const std::vector<Cell>& erased);
  std::vector<CostChange> compare_touched();

  CostMapConfig config_;
  Grid<float> clearance_;
  CostGrid static_;
  CostGrid temporary_;
  CostGrid costs_;
  std::vector<Stamp> stamps_;
  int reach_ = 0;                  // cells, of a stamp
  Grid<std::uint8_t> blocked_at_;  // 1: in blocked_
  std::vector<Cell> blocked_;
  Grid<std::uint8_t> touched_at_;  // 1: in touched_
  std::vector<Cell> touched_;      // cells whose temporary cost may have changed
};

}  // namespace robot
