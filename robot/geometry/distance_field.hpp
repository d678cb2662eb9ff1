// Distance fields: how far every cell of a map is from the nearest surface a laser can see.
// Exact separable Euclidean transform after Felzenszwalb and Huttenlocher 2012, "Distance transforms of sampled
// functions": linear in the number of cells.
#pragma once

#include "robot/geometry/grid.hpp"
#include "robot/geometry/pose.hpp"

namespace robot {

using DistanceField = Grid<float>;  // m; infinity where the map has no surface at all
using Mask = Grid<std::uint8_t>;    // 1: set

// Occupied cells with at least one known, not occupied cell among their eight neighbours: what sensors see of the map.
// Filled and hollow obstacles come out alike.
Mask surfaces(const OccupancyGrid& map);

// Metres from each cell's centre to the centre of the nearest set cell.
DistanceField distance_to(const Mask& mask);

// Metres from each cell's centre to the centre of the nearest surface cell.
inline DistanceField distance_field(const OccupancyGrid& map) { return distance_to(surfaces(map)); }

// A field's value between cell centres and how it changes there.
struct FieldSample {
  double value = 0.0;  // m
  Point gradient;      // m a m
};

// Bilinear between the four nearest centres; beyond the outermost centres the border's value and the way back to it.
// The field must not be empty.
FieldSample interpolate(const DistanceField& field, Point point);

}  // namespace robot
