#include "robot/geometry/free_space.hpp"

#include <algorithm>
#include <cmath>

#include "robot/geometry/polygon.hpp"

namespace robot {
namespace {

// Calls f(cell) for the map's cells whose centres lie in the polygon's bounding box, widened by a margin in metres.
template <typename F>
void for_cells_near(const Mask& grid, const std::vector<Point>& polygon, double margin, F f) {
  if (polygon.empty()) return;
  Point low = polygon.front(), high = polygon.front();
  for (const Point& p : polygon) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const auto column = [&](double x) {
    return static_cast<int>(std::clamp((x - grid.origin().x) / grid.resolution(), -1.0, grid.width() + 1.0));
  };
  const auto row = [&](double y) {
    return static_cast<int>(std::clamp((y - grid.origin().y) / grid.resolution(), -1.0, grid.height() + 1.0));
  };
  const int x1 = std::min(grid.width() - 1, column(high.x + margin));
  const int y1 = std::min(grid.height() - 1, row(high.y + margin));
  for (int y = std::max(0, row(low.y - margin)); y <= y1; ++y) {
    for (int x = std::max(0, column(low.x - margin)); x <= x1; ++x) f(Cell{x, y});
  }
}

bool borders_on_open(const Mask& open, Cell c) {
  return open.at_or({c.x - 1, c.y}, 0) || open.at_or({c.x + 1, c.y}, 0) || open.at_or({c.x, c.y - 1}, 0) ||
         open.at_or({c.x, c.y + 1}, 0);
}

}  // namespace

Mask open_cells(const OccupancyGrid& map, const std::vector<std::vector<Point>>& hazards,
                const std::vector<Point>& boundary) {
  Mask open(map.width(), map.height(), map.resolution(), map.origin(), 0);
  for (std::size_t i = 0; i < map.size(); ++i) open.cells()[i] = is_free(map.cells()[i]) ? 1 : 0;
  for (const auto& hazard : hazards) {
    const double margin = 0.5 * map.resolution();
    for_cells_near(open, hazard, margin, [&](Cell c) {
      const Point p = open.center(c);
      if (contains(hazard, p) || distance_to_edge(hazard, p) <= margin) open[c] = 0;
    });
  }
  if (boundary.empty()) return open;
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (open.cells()[i] && !contains(boundary, open.center(open.cell_at(i)))) open.cells()[i] = 0;
  }
  return open;
}

Mask cells_clear_for(const Mask& open, double radius) {
  Mask clear = open;
  const int reach = static_cast<int>(std::floor(radius / open.resolution()));
  const double limit = std::pow(radius / open.resolution(), 2);
  // One ring of cells round the map counts as blocked: nobody knows what is there.
  for (int y = -1; y <= open.height(); ++y) {
    for (int x = -1; x <= open.width(); ++x) {
      if (open.at_or({x, y}, 0) || !borders_on_open(open, {x, y})) continue;
      for (int dy = -reach; dy <= reach; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
          const Cell c{x + dx, y + dy};
          if (dx * dx + dy * dy <= limit && clear.contains(c)) clear[c] = 0;
        }
      }
    }
  }
  return clear;
}

Mask reachable_cells(const Mask& clear, Point from) {
  Mask reached(clear.width(), clear.height(), clear.resolution(), clear.origin(), 0);
  const Cell start = clear.cell(from);
  if (!clear.at_or(start, 0)) return reached;
  std::vector<Cell> open = {start};
  reached[start] = 1;
  while (!open.empty()) {
    const Cell c = open.back();
    open.pop_back();
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell next{c.x + dx, c.y + dy};
        if (!clear.at_or(next, 0) || reached[next]) continue;
        if (dx != 0 && dy != 0 && (!clear[{next.x, c.y}] || !clear[{c.x, next.y}])) continue;
        reached[next] = 1;
        open.push_back(next);
      }
    }
  }
  return reached;
}

}  // namespace robot
