#include "robot/planning/path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace robot {
namespace {

constexpr std::size_t longest_line = 400;  // cells; longer straight pieces stay several

// Cost of the straight line between two cells' centres in the units of the value function; infinite over blocked cells.
double line_cost(const CostGrid& costs, Cell a, Cell b) {
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  const int steps = std::max(1, static_cast<int>(std::ceil(2.0 * length)));  // two samples a cell
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double t = (i + 0.5) / steps;
    const Cell c{static_cast<int>(std::lround(a.x + t * (b.x - a.x))),
                 static_cast<int>(std::lround(a.y + t * (b.y - a.y)))};
    if (costs[c] == 0) return std::numeric_limits<double>::infinity();
    sum += costs[c];
  }
  return ValueFunction::straight_step * length * sum / steps;
}

// Cost from the first cell up to each cell.
std::vector<double> costs_along(const std::vector<Cell>& cells, const CostGrid& costs) {
  std::vector<double> along(cells.size(), 0.0);
  for (std::size_t i = 1; i < cells.size(); ++i) {
    const bool diagonal = cells[i].x != cells[i - 1].x && cells[i].y != cells[i - 1].y;
    along[i] = along[i - 1] + (diagonal ? ValueFunction::diagonal_step : ValueFunction::straight_step) *
                                  static_cast<double>(costs[cells[i - 1]]);
  }
  return along;
}

}  // namespace

double path_length(const std::vector<Point>& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) length += distance(path[i - 1], path[i]);
  return length;
}

std::vector<Point> straighten(const std::vector<Cell>& cells, const CostGrid& costs) {
  std::vector<Point> path;
  if (cells.empty()) return path;
  const std::vector<double> along = costs_along(cells, costs);
  const auto straight = [&](std::size_t i, std::size_t j) {
    return j == i + 1 || line_cost(costs, cells[i], cells[j]) <= along[j] - along[i];
  };
  path.push_back(costs.center(cells.front()));
  for (std::size_t i = 0; i + 1 < cells.size();) {
    const std::size_t last = std::min(cells.size() - 1, i + longest_line);
    std::size_t good = i + 1, bad = last + 1;
    for (std::size_t step = 2; i + step <= last; step *= 2) {
      if (!straight(i, i + step)) {
        bad = i + step;
        break;
      }
      good = i + step;
    }
    while (bad - good > 1) {
      const std::size_t middle = good + (bad - good) / 2;
      (straight(i, middle) ? good : bad) = middle;
    }
    path.push_back(costs.center(cells[good]));
    i = good;
  }
  return path;
}

std::vector<Point> resample(const std::vector<Point>& path, double step) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i > 0) {
      const Point a = path[i - 1], leg = path[i] - a;
      const int pieces = std::max(1, static_cast<int>(std::ceil(norm(leg) / step)));
      for (int k = 1; k < pieces; ++k) points.push_back(a + (static_cast<double>(k) / pieces) * leg);
    }
    points.push_back(path[i]);
  }
  return points;
}

}  // namespace robot
