// Ray casting: how far a beam flies over a map before it meets an occupied cell. Ranges end at the cell's face.
#pragma once

#include <vector>

#include "robot/geometry/grid.hpp"
#include "robot/geometry/pose.hpp"

namespace robot {

// The textbook: exact traversal cell by cell (Amanatides and Woo 1987). Metres from `from` (map frame) along `angle`
// (rad) to the first occupied cell; max_range when there is none before that or the beam leaves the map; 0 from inside
// an occupied cell. Unknown cells do not stop a beam. Starts outside the map see nothing.
double cast_ray(const OccupancyGrid& map, Point from, double angle, double max_range);

// The same answers several times faster: per cell it knows how far any beam may fly before an occupied square can come,
// so beams march through the open in long steps and go cell by cell only along walls.
class RayCaster {
 public:
  explicit RayCaster(const OccupancyGrid& map);

  double cast(Point from, double angle, double max_range) const;
  // The same for a direction that is known already: `direction` of length one.
  double cast(Point from, Point direction, double max_range) const;

 private:
  int width_ = 0;
  int height_ = 0;
  double resolution_ = 0.05;
  Point origin_;
  // Distance in half cells between this square and the nearest occupied one, rounded down; 0: neighbours or the cell
  // itself. occupied marks the cell itself.
  std::vector<std::uint8_t> clearance_;
  static constexpr std::uint8_t occupied = 255;
};

}  // namespace robot
