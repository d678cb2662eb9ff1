// What stands in the museum, from its map: how far off, which way is away from it, and where rays end.
#pragma once

#include "robot/geometry/distance_field.hpp"
#include "robot/geometry/grid.hpp"
#include "robot/geometry/ray_cast.hpp"

namespace robot::simulation {

class Walls {
 public:
  explicit Walls(const OccupancyGrid& map);

  // Metres to the nearest occupied cell, interpolated (within a few centimetres); 0 inside one and off the map.
  double clearance(Point p) const;
  // Whether the nearest occupied cell is surely farther off than this; one look, for those in the open.
  bool roomy(Point p, double metres) const {
    return distance_.at_or(distance_.cell(p), 0.0f) > metres + 1.5 * distance_.resolution();
  }
  // Unit vector away from the nearest occupied cell; zero where there is none to get away from.
  Point away(Point p) const;
  // Metres along a unit direction to the first occupied cell; `limit` when none comes before.
  double ray(Point from, Point direction, double limit) const { return rays_.cast(from, direction, limit); }
  bool occupied(Cell cell) const { return distance_.contains(cell) && distance_[cell] == 0.0f; }
  const Grid<float>& cells() const { return distance_; }

 private:
  Grid<float> distance_;  // m between the centres of a cell and of the nearest occupied one, at most 1000
  RayCaster rays_;
};

}  // namespace robot::simulation
