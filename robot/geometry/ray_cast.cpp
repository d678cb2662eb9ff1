#include "robot/geometry/ray_cast.hpp"

#include <algorithm>

#include "robot/geometry/distance_field.hpp"

namespace robot {
namespace {

// A beam in cell units. Crossing times are always computed from the origin, so that a beam that jumped ahead crosses
// the same borders at the same times as one that went cell by cell.
struct Beam {
  Beam(Point from, Point direction, Point grid_origin, double resolution)
      : x((from.x - grid_origin.x) / resolution),
        y((from.y - grid_origin.y) / resolution),
        dx(direction.x),
        dy(direction.y),
        inverse_x(dx == 0.0 ? 0.0 : 1.0 / dx),
        inverse_y(dy == 0.0 ? 0.0 : 1.0 / dy),
        step_x(dx > 0.0 ? 1 : -1),
        step_y(dy > 0.0 ? 1 : -1) {}

  double leaves_column(int cell) const { return dx == 0.0 ? forever : (cell + (step_x > 0) - x) * inverse_x; }
  double leaves_row(int cell) const { return dy == 0.0 ? forever : (cell + (step_y > 0) - y) * inverse_y; }

  static constexpr double forever = std::numeric_limits<double>::infinity();
  double x, y, dx, dy, inverse_x, inverse_y;
  int step_x, step_y;
};

}  // namespace

double cast_ray(const OccupancyGrid& map, Point from, double angle, double max_range) {
  Cell cell = map.cell(from);
  if (!map.contains(cell) || !std::isfinite(angle)) return max_range;
  const Beam beam(from, {std::cos(angle), std::sin(angle)}, map.origin(), map.resolution());
  const double limit = max_range / map.resolution();
  double way = 0.0;
  while (way < limit) {
    if (is_occupied(map[cell])) return way * map.resolution();
    const double next_x = beam.leaves_column(cell.x), next_y = beam.leaves_row(cell.y);
    way = std::min(next_x, next_y);
    (next_x < next_y ? cell.x : cell.y) += next_x < next_y ? beam.step_x : beam.step_y;
    if (!map.contains(cell)) return max_range;
  }
  return max_range;
}

RayCaster::RayCaster(const OccupancyGrid& map)
    : width_(map.width()), height_(map.height()), resolution_(map.resolution()), origin_(map.origin()) {
  // The distance between two squares is that between the centre of one and the other grown by a cell all round.
  Mask grown(width_, height_, 1.0, {}, 0);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      if (!is_occupied(map[{x, y}])) continue;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height_ - 1); ++v) {
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width_ - 1); ++u) grown[{u, v}] = 1;
      }
    }
  }
  const DistanceField field = distance_to(grown);
  clearance_.resize(map.size());
  for (std::size_t i = 0; i < clearance_.size(); ++i) {
    const float half_cells = std::min(2.0f * field.cells()[i], 254.0f);
    clearance_[i] = is_occupied(map.cells()[i]) ? occupied : static_cast<std::uint8_t>(half_cells);
  }
}

double RayCaster::cast(Point from, double angle, double max_range) const {
  if (!std::isfinite(angle)) return max_range;
  return cast(from, Point{std::cos(angle), std::sin(angle)}, max_range);
}

double RayCaster::cast(Point from, Point direction, double max_range) const {
  const Beam beam(from, direction, origin_, resolution_);
  if (!(beam.x >= 0.0 && beam.y >= 0.0 && beam.x < width_ && beam.y < height_)) return max_range;
  const double limit = max_range / resolution_;
  int cell_x = static_cast<int>(beam.x), cell_y = static_cast<int>(beam.y);
  double way = 0.0;
  while (way < limit) {
    const auto clearance = clearance_[static_cast<std::size_t>(cell_y) * static_cast<std::size_t>(width_) +
                                      static_cast<std::size_t>(cell_x)];
    if (clearance == occupied) return way * resolution_;
    if (clearance >= 4) {
      // Two cells and more: jump, stopping short of the border so that rounding cannot reach an occupied square.
      way += 0.5 * clearance - 1e-6;
      const double x = beam.x + way * beam.dx, y = beam.y + way * beam.dy;
      if (!(x >= 0.0 && y >= 0.0 && x < width_ && y < height_)) return max_range;
      cell_x = static_cast<int>(x);
      cell_y = static_cast<int>(y);
      continue;
    }
    const double next_x = beam.leaves_column(cell_x), next_y = beam.leaves_row(cell_y);
    if (next_x < next_y) {
      way = next_x;
      cell_x += beam.step_x;
    } else {
      way = next_y;
      cell_y += beam.step_y;
    }
    if (cell_x < 0 || cell_y < 0 || cell_x >= width_ || cell_y >= height_) return max_range;
  }
  return max_range;
}

}  // namespace robot
