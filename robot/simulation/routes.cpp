#include "robot/simulation/routes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

#include "robot/geometry/polygon.hpp"

namespace robot::simulation {
namespace {

constexpr double coarse = 0.25;  // m
constexpr double body = 0.24;    // m that a person needs to each side
constexpr double comfort = 0.6;  // m from walls that people like to keep
constexpr float never = std::numeric_limits<float>::infinity();
constexpr std::array<Cell, 8> neighbours{{{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

bool stops_people(HazardKind kind) { return kind != HazardKind::keep_out; }

bool names_entrance(const Area& area) {
  for (const auto& [language, title] : area.title) {
    for (const char* word : {"ntrance", "ingang", "oyer"}) {
      if (title.find(word) != std::string::npos) return true;
    }
  }
  return false;
}

}  // namespace

OccupancyGrid walkable_map(const Museum& museum) {
  OccupancyGrid map = museum.map;
  for (auto& value : map.cells()) value = is_free(value) ? free_cell : occupied_cell;
  for (const auto& hazard : museum.hazards) {
    if (!stops_people(hazard.kind) || hazard.polygon.empty()) continue;
    Point low = hazard.polygon.front(), high = low;
    for (const Point p : hazard.polygon) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    const double r = map.resolution();
    for (double y = low.y - r; y <= high.y + r; y += r) {
      for (double x = low.x - r; x <= high.x + r; x += r) {
        const Cell cell = map.cell({x, y});
        if (!map.contains(cell)) continue;
        const Point center = map.center(cell);
        if (contains(hazard.polygon, center) || distance_to_edge(hazard.polygon, center) < 0.71 * r) {
          map[cell] = occupied_cell;
        }
      }
    }
  }
  return map;
}

Routes::Routes(const Museum& museum, const Walls& walls)
    : cost_(static_cast<int>(std::ceil(museum.map.width() * museum.map.resolution() / coarse)),
            static_cast<int>(std::ceil(museum.map.height() * museum.map.resolution() / coarse)), coarse,
            museum.map.origin(), never),
      exhibits_(static_cast<int>(museum.exhibits.size())) {
  for (std::size_t i = 0; i < cost_.size(); ++i) {
    const double clearance = walls.clearance(cost_.center(cost_.cell_at(i)));
    if (clearance < body) continue;
    cost_.cells()[i] = static_cast<float>(1.0 + 2.0 * std::max(0.0, comfort - clearance) / comfort);
  }
  // People live where the robot lives: what its homing position cannot reach is another house.
  std::vector<Cell> about_home;
  for (std::size_t i = 0; i < cost_.size(); ++i) {
    const Cell cell = cost_.cell_at(i);
    if (distance(cost_.center(cell), museum.home.position()) < 1.0) about_home.push_back(cell);
  }
  const Grid<float> from_home = field(about_home);
  for (std::size_t i = 0; i < cost_.size(); ++i) {
    if (from_home.cells()[i] == never) cost_.cells()[i] = never;
  }
  std::vector<Point> all;
  for (std::size_t i = 0; i < cost_.size(); ++i) {
    if (cost_.cells()[i] < never) all.push_back(cost_.center(cost_.cell_at(i)));
  }
  const auto add = [&](std::vector<Point> spots) {
    if (spots.empty()) spots = all;
    std::vector<Cell> sources;
    sources.reserve(spots.size());
    for (const Point p : spots) sources.push_back(cost_.cell(p));
    ways_.push_back(field(sources));
    spots_.push_back(std::move(spots));
  };
  const auto near = [&](double low, double high, auto&& measure) {
    std::vector<Point> spots;
    for (const Point p : all) {
      const double d = measure(p);
      if (d >= low && d <= high) spots.push_back(p);
    }
    return spots;
  };
  for (const auto& exhibit : museum.exhibits) {
    add(near(0.5, 2.2, [&](Point p) { return distance_to_edge(exhibit.outline, p); }));
  }
  const auto area = std::ranges::find_if(museum.areas, names_entrance);
  Point entrance = museum.home.position();
  if (area != museum.areas.end()) {
    entrance = area->label;
  } else {
    double farthest = 0.0;
    for (const Point p : all) {
      const double d = from_home[cost_.cell(p)];
      if (d > farthest) farthest = d, entrance = p;
    }
  }
  double closest = 1e9;
  for (const Point p : all) closest = std::min(closest, distance(p, entrance));
  add(near(0.0, closest + 1.5, [&](Point p) { return distance(p, entrance); }));
  spots_.push_back(std::move(all));
}

Grid<float> Routes::field(const std::vector<Cell>& sources) const {
  Grid<float> way(cost_.width(), cost_.height(), coarse, cost_.origin(), never);
  using Entry = std::pair<float, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (const Cell cell : sources) {
    if (!way.contains(cell) || cost_[cell] == never) continue;
    way[cell] = 0.0f;
    open.push({0.0f, way.index(cell)});
  }
  while (!open.empty()) {
    const auto [d, index] = open.top();
    open.pop();
    if (d > way.cells()[index]) continue;
    const Cell cell = way.cell_at(index);
    for (const Cell step : neighbours) {
      const Cell next{cell.x + step.x, cell.y + step.y};
      if (!way.contains(next) || cost_[next] == never) continue;
      const bool diagonal = step.x != 0 && step.y != 0;
      if (diagonal && (cost_[{next.x, cell.y}] == never || cost_[{cell.x, next.y}] == never)) continue;
      const float length = static_cast<float>(coarse * (diagonal ? std::sqrt(2.0) : 1.0));
      const float there = d + 0.5f * length * (cost_[cell] + cost_[next]);
      if (there >= way[next]) continue;
      way[next] = there;
      open.push({there, way.index(next)});
    }
  }
  return way;
}

bool Routes::passable(Point p) const { return cost_.at_or(cost_.cell(p), never) < never; }

double Routes::way(int destination, Point p) const {
  const auto& field = ways_[static_cast<std::size_t>(destination)];
  return field.at_or(field.cell(p), never);
}

Point Routes::direction(int destination, Point p) const {
  const auto& field = ways_[static_cast<std::size_t>(destination)];
  const Cell here = field.cell(p);
  if (!field.contains(here) || field[here] == 0.0f) return {};
  // Two cells ahead in each of the eight directions and their halves: smooth enough, and never through a corner.
  Point sum;
  float best = field[here];
  Cell target = here;
  for (const Cell step : neighbours) {
    const Cell near{here.x + step.x, here.y + step.y}, far{here.x + 2 * step.x, here.y + 2 * step.y};
    if (field.at_or(near, never) == never) continue;
    const float value = std::min(field.at_or(near, never), field.at_or(far, never));
    if (value < best) best = value, target = field.at_or(far, never) <= field.at_or(near, never) ? far : near;
    if (field[here] == never) continue;
    const double fall = std::max(0.0f, field[here] - field.at_or(near, never));
    const Point unit = (1.0 / std::hypot(step.x, step.y)) * Point{1.0 * step.x, 1.0 * step.y};
    sum = sum + (fall * fall) * unit;
  }
  if (target == here) return {};
  const Point to = field.center(target) - p;
  const Point steepest = (1.0 / std::max(1e-9, norm(to))) * to;
  const Point mixed = norm(sum) > 1e-9 ? steepest + (1.0 / norm(sum)) * sum : steepest;
  return (1.0 / std::max(1e-9, norm(mixed))) * mixed;
}

Point Routes::spot(int destination, Random& random) const {
  const auto& spots = spots_[static_cast<std::size_t>(destination)];
  if (spots.empty()) return {};
  return spots[random.index(spots.size())] + Point{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)};
}

Point Routes::anywhere(Random& random) const { return spot(exhibits_ + 1, random); }

}  // namespace robot::simulation
