// Where a round body can be, and where it can get to from a place: the yes-or-no view of a map with its hazards.
#pragma once

#include <vector>

#include "robot/geometry/distance_field.hpp"
#include "robot/geometry/grid.hpp"
#include "robot/geometry/pose.hpp"

namespace robot {

// Cells that are known to be free, outside of all hazards and inside the boundary (empty: everywhere). A hazard covers
// every cell that its area or its edge touches about the cell's centre.
Mask open_cells(const OccupancyGrid& map, const std::vector<std::vector<Point>>& hazards,
                const std::vector<Point>& boundary);

// Cells in which the centre of a disc of this radius (m) can stand while all of it stays on open cells.
Mask cells_clear_for(const Mask& open, double radius);

// Cells that can be reached from the point over clear ones, 8-connected, never squeezing diagonally between two blocked
// cells. Nothing when the point itself is not clear.
Mask reachable_cells(const Mask& clear, Point from);

}  // namespace robot
