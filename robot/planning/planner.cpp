#include "robot/planning/planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "robot/planning/path.hpp"

namespace robot {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr int coarsening = 4;      // cells a side joined to one for travel distances
constexpr double out_reach = 2.0;  // m that a robot may stand away from where it could be planned to

// Costs at a coarser cell size; open where any of the joined cells is, at the least of their costs.
CostGrid coarser(const CostGrid& costs, int factor) {
  const auto cells = [&](int n) { return (n + factor - 1) / factor; };
  CostGrid coarse(cells(costs.width()), cells(costs.height()), costs.resolution() * factor, costs.origin(), 0);
  for (int y = 0; y < costs.height(); ++y) {
    for (int x = 0; x < costs.width(); ++x) {
      const std::uint8_t cost = costs[{x, y}];
      std::uint8_t& joined = coarse[{x / factor, y / factor}];
      if (cost != 0 && (joined == 0 || cost < joined)) joined = cost;
    }
  }
  return coarse;
}

// The cell nearest to a point for which good() holds, among those within reach that are connected with the point's cell
// over cells for which pass() holds.
template <typename Pass, typename Good>
std::optional<Cell> nearest_cell(const CostGrid& grid, Point from, double reach, Pass pass, Good good) {
  const Cell start = grid.cell(from);
  if (!grid.contains(start) || !pass(start)) return std::nullopt;
  const int side = 2 * static_cast<int>(std::ceil(reach / grid.resolution())) + 3;
  Grid<std::uint8_t> seen(side, side, 1.0, {}, 0);
  const auto local = [&](Cell c) { return Cell{c.x - start.x + side / 2, c.y - start.y + side / 2}; };
  std::vector<Cell> wave = {start};
  seen[local(start)] = 1;
  std::optional<Cell> best;
  double best_distance = reach;
  for (std::size_t i = 0; i < wave.size(); ++i) {
    const Cell c = wave[i];
    const double away = distance(grid.center(c), from);
    if (away > reach + grid.resolution()) continue;
    if (good(c) && (away < best_distance || c == start)) {
      best = c;
      best_distance = away;
    }
    for (int d = 0; d < 9; ++d) {
      const Cell next{c.x + d % 3 - 1, c.y + d / 3 - 1};
      if (!seen.contains(local(next)) || !grid.contains(next) || seen[local(next)] || !pass(next)) continue;
      seen[local(next)] = 1;
      wave.push_back(next);
    }
  }
  return best;
}

}  // namespace

Planner::Planner(const Museum& museum, const Footprint& footprint, const CostMapConfig& config)
    : costs_(museum, footprint, config),
      map_(museum.map),
      coarse_(coarser(costs_.static_costs(), coarsening)),
      values_(costs_.costs()) {}

PlaceKind Planner::place(Point point) const {
  const Cell cell = map_.cell(point);
  if (!map_.contains(cell)) return PlaceKind::off_the_map;
  if (costs_.static_costs()[cell] != 0) return PlaceKind::traversable;
  if (!is_free(map_[cell])) return PlaceKind::inside_obstacle;
  return costs_.floor(cell) ? PlaceKind::too_tight : PlaceKind::in_hazard;
}

std::optional<Point> Planner::nearest_traversable(Point point, double reach) const {
  const CostGrid& open = costs_.static_costs();
  if (place(point) == PlaceKind::traversable) return point;
  const auto cell = nearest_cell(
      open, point, reach, [&](Cell c) { return costs_.floor(c); }, [&](Cell c) { return open[c] != 0; });
  if (!cell) return std::nullopt;
  return open.center(*cell);
}

bool Planner::set_goal(Point goal) {
  goal_ = nearest_traversable(goal);
  values_.set_goal(goal_ ? map_.cell(*goal_) : Cell{-1, -1});
  return goal_.has_value();
}

void Planner::clear_goal() {
  goal_.reset();
  values_.set_goal({-1, -1});
}

void Planner::update(ObstacleLayers& layers) {
  const std::vector<Cell> changed = layers.take_changes();
  if (!changed.empty()) values_.change(costs_.update(changed, layers));
}

bool Planner::work(int cells) { return values_.work(cells); }

// From where the robot stands to the nearest place that has a way: hazards and tight places may be left, walls not
// crossed.
std::optional<Cell> Planner::way_out(Point from, double reach) const {
  const auto pass = [&](Cell c) { return !is_occupied(map_[c]); };
  const auto good = [&](Cell c) { return values_.value(c) != ValueFunction::unreached; };
  const Cell start = map_.cell(from);
  if (map_.contains(start) && good(start)) return start;
  if (map_.contains(start) && costs_.costs()[start] != 0 && !values_.settled(start))
    return std::nullopt;  // wait for it
  return nearest_cell(costs_.costs(), from, reach, pass, good);
}

double Planner::value_at(Point from) const {
  if (!goal_) return infinite;
  const auto cell = way_out(from, out_reach);
  if (!cell) return infinite;
  const double way = values_.value(*cell) * map_.resolution() / ValueFunction::straight_step;
  return way + (map_.cell(from) == *cell ? 0.0 : distance(from, map_.center(*cell)));
}

bool Planner::ready(Point from) const {
  if (!goal_ || values_.finished()) return true;
  const auto cell = way_out(from, out_reach);
  return cell && values_.settled(*cell);
}

std::vector<Point> Planner::path_from(Point from) const {
  if (!goal_) return {};
  const auto start = way_out(from, out_reach);
  if (!start) return {};
  std::vector<Point> path = straighten(values_.descend(*start), costs_.costs());
  if (map_.cell(from) == *start) {
    path.front() = from;
  } else {
    path.insert(path.begin(), from);
  }
  // The way ends in the goal's cell; the goal itself may lie off its centre.
  if (path.size() > 1) {
    path.back() = *goal_;
  } else {
    path.push_back(*goal_);
  }
  return path;
}

double Planner::crowding_from(Point from) const {
  if (!goal_) return 0.0;
  const auto start = way_out(from, out_reach);
  if (!start) return 0.0;
  double extra = 0.0;
  for (const Cell& c : values_.descend(*start)) extra += costs_.costs()[c] - costs_.static_costs()[c];
  return extra * map_.resolution();
}

std::vector<std::vector<double>> Planner::travel_distances(const std::vector<Point>& points) const {
  const std::size_t n = points.size();
  std::vector<std::vector<double>> metres(n, std::vector<double>(n, infinite));
  std::vector<Cell> cells;
  for (const Point& p : points) {
    const auto near = nearest_traversable(p, out_reach);
    cells.push_back(near ? coarse_.cell(*near) : Cell{-1, -1});
  }
  ValueFunction values(coarse_);
  for (std::size_t i = 0; i < n; ++i) {
    values.set_goal(cells[i]);
    values.finish();
    for (std::size_t j = 0; j < i; ++j) {
      const std::uint32_t value = values.value(cells[j]);
      if (value == ValueFunction::unreached) continue;
      metres[i][j] = metres[j][i] = value * coarse_.resolution() / ValueFunction::straight_step;
    }
    metres[i][i] = 0.0;
  }
  return metres;
}

std::vector<double> Planner::travel_from(Point from, const std::vector<Point>& to) const {
  std::vector<double> metres(to.size(), infinite);
  const auto start = nearest_traversable(from, out_reach);
  if (!start) return metres;
  ValueFunction values(coarse_);
  values.set_goal(coarse_.cell(*start));
  values.finish();
  for (std::size_t i = 0; i < to.size(); ++i) {
    const auto near = nearest_traversable(to[i], out_reach);
    const std::uint32_t value = near ? values.value(coarse_.cell(*near)) : ValueFunction::unreached;
    if (value != ValueFunction::unreached) metres[i] = value * coarse_.resolution() / ValueFunction::straight_step;
  }
  return metres;
}

}  // namespace robot
