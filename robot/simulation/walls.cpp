#include "robot/simulation/walls.hpp"

#include <algorithm>

namespace robot::simulation {
namespace {

Grid<float> distances(const OccupancyGrid& map) {
  Mask occupied(map.width(), map.height(), map.resolution(), map.origin(), 0);
  for (std::size_t i = 0; i < map.size(); ++i) occupied.cells()[i] = is_occupied(map.cells()[i]) ? 1 : 0;
  Grid<float> field = distance_to(occupied);
  for (float& d : field.cells()) d = std::min(d, 1000.0f);
  return field;
}

}  // namespace

Walls::Walls(const OccupancyGrid& map) : distance_(distances(map)), rays_(map) {}

double Walls::clearance(Point p) const {
  if (!distance_.contains(p)) return 0.0;
  return std::max(0.0, interpolate(distance_, p).value - 0.5 * distance_.resolution());
}

Point Walls::away(Point p) const {
  if (!distance_.contains(p)) return {};
  const Point slope = interpolate(distance_, p).gradient;
  const double length = norm(slope);
  return length > 1e-9 ? (1.0 / length) * slope : Point{};
}

}  // namespace robot::simulation
