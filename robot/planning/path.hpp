// Paths as polylines in the map frame, and the shortening of a path over cells into one that a robot can drive.
#pragma once

#include <vector>

#include "robot/geometry/pose.hpp"
#include "robot/planning/value_function.hpp"

namespace robot {

// Metres along the polyline.
double path_length(const std::vector<Point>& path);

// Pulls the path straight wherever the straight line costs no more than the cells it replaces: the clearance that the
// costs ask for is kept (RHINO 4.2 (3), "post-processed to maintain a minimum clearance").
std::vector<Point> straighten(const std::vector<Cell>& cells, const CostGrid& costs);

// Points of the polyline at most `step` metres apart, its corners included.
std::vector<Point> resample(const std::vector<Point>& path, double step);

}  // namespace robot
