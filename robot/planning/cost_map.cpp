#include "robot/planning/cost_map.hpp"

#include <algorithm>
#include <cmath>

#include "robot/geometry/distance_field.hpp"
#include "robot/geometry/free_space.hpp"

namespace robot {
namespace {

// Falls from `high` at `near` metres to `low` at `far` metres, steeper near by.
std::uint8_t falling(double distance, double near, double far, int high, int low) {
  const double t = std::clamp((far - distance) / (far - near), 0.0, 1.0);
  return static_cast<std::uint8_t>(std::lround(low + (high - low) * t * t));
}

// Metres from each cell's centre to the face of the nearest cell that is no floor; the world beyond the map is none.
Grid<float> floor_clearance(const Museum& museum) {
  std::vector<Polygon> hazards;
  for (const Hazard& hazard : museum.hazards) hazards.push_back(hazard.polygon);
  Mask blocked = open_cells(museum.map, hazards, museum.boundary);
  for (auto& cell : blocked.cells()) cell = cell ? 0 : 1;
  Grid<float> clearance = distance_to(blocked);
  const float half = static_cast<float>(0.5 * blocked.resolution());
  for (std::size_t i = 0; i < clearance.size(); ++i) {
    const Cell c = clearance.cell_at(i);
    const int rim = 1 + std::min({c.x, c.y, clearance.width() - 1 - c.x, clearance.height() - 1 - c.y});
    const float border = static_cast<float>(rim * clearance.resolution());
    float& d = clearance.cells()[i];
    d = blocked.cells()[i] ? 0.0f : std::min(d, border) - half;
  }
  return clearance;
}

}  // namespace

CostMap::CostMap(const Museum& museum, const Footprint& footprint, const CostMapConfig& config) : config_(config) {
  const OccupancyGrid& map = museum.map;
  clearance_ = floor_clearance(museum);
  static_ = CostGrid(map.width(), map.height(), map.resolution(), map.origin(), 0);
  const double blocked_below = footprint.inscribed() + config.margin;
  for (std::size_t i = 0; i < static_.size(); ++i) {
    const double d = clearance_.cells()[i];
    if (d >= blocked_below) static_.cells()[i] = falling(d, blocked_below, config.comfortable, config.tight_cost, 1);
  }
  costs_ = static_;
  temporary_ = CostGrid(map.width(), map.height(), map.resolution(), map.origin(), 0);
  blocked_at_ = touched_at_ = temporary_;
  reach_ = static_cast<int>(std::ceil(config.comfortable_temporary / map.resolution()));
  for (int dy = -reach_; dy <= reach_; ++dy) {
    for (int dx = -reach_; dx <= reach_; ++dx) {
      const double d = map.resolution() * std::hypot(dx, dy);
      const auto cost = d < blocked_below
                            ? static_cast<std::uint8_t>(config.temporary_cost)
                            : falling(d, blocked_below, config.comfortable_temporary, config.temporary_near_cost, 0);
      if (cost > 0) stamps_.push_back({dx, dy, cost});
    }
  }
}

void CostMap::touch(Cell cell) {
  if (touched_at_[cell]) return;
  touched_at_[cell] = 1;
  touched_.push_back(cell);
}

void CostMap::stamp(Cell center) {
  for (const Stamp& s : stamps_) {
    const Cell c{center.x + s.dx, center.y + s.dy};
    if (!temporary_.contains(c) || temporary_[c] >= s.cost) continue;
    temporary_[c] = s.cost;
    touch(c);
  }
}

void CostMap::erase(Cell center) {
  for (const Stamp& s : stamps_) {
    const Cell c{center.x + s.dx, center.y + s.dy};
    if (!temporary_.contains(c) || temporary_[c] == 0) continue;
    temporary_[c] = 0;
    touch(c);
  }
}

// Erasing one obstacle's stamp takes from those of its neighbours; they are put there again.
void CostMap::restamp_near(const std::vector<Cell>& erased) {
  const int tile = 2 * reach_ + 1;
  Grid<std::uint8_t> hit(costs_.width() / tile + 3, costs_.height() / tile + 3, 1.0, {}, 0);
  for (const Cell& c : erased) {
    for (int dy = 0; dy <= 2; ++dy) {
      for (int dx = 0; dx <= 2; ++dx) hit[{c.x / tile + dx, c.y / tile + dy}] = 1;
    }
  }
  for (const Cell& c : blocked_) {
    if (hit[{c.x / tile + 1, c.y / tile + 1}]) stamp(c);
  }
}

std::vector<CostChange> CostMap::compare_touched() {
  std::vector<CostChange> changes;
  for (const Cell& c : touched_) {
    touched_at_[c] = 0;
    if (static_[c] == 0) continue;
    const auto cost = static_cast<std::uint8_t>(std::min(ValueFunction::max_cost, static_[c] + temporary_[c]));
    if (cost == costs_[c]) continue;
    costs_[c] = cost;
    changes.push_back({c, cost});
  }
  touched_.clear();
  return changes;
}

std::vector<CostChange> CostMap::update(std::span<const Cell> changed, const ObstacleLayers& layers) {
  std::vector<Cell> erased;
  for (const Cell& c : changed) {
    if (!blocked_at_.contains(c)) continue;
    const bool blocked = layers.blocked(c);
    if (blocked == (blocked_at_[c] != 0)) continue;
    blocked_at_[c] = blocked ? 1 : 0;
    (blocked ? blocked_ : erased).push_back(c);
  }
  if (!erased.empty()) {
    std::erase_if(blocked_, [&](Cell c) { return !blocked_at_[c]; });
    for (const Cell& c : erased) erase(c);
    restamp_near(erased);
  }
  for (const Cell& c : changed) {
    if (blocked_at_.at_or(c, 0)) stamp(c);
  }
  return compare_touched();
}

}  // namespace robot
