// How far a rectangular robot can go along a circular arc before it touches one of many points: exact, not sampled.
// Seen from the robot every point moves on a circle about the turning centre; where that circle first meets the
// rectangle's edges is the contact (see also Arras et al. 2002 for the same idea).
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "robot/body.hpp"
#include "robot/geometry/pose.hpp"

namespace robot {

inline constexpr double no_contact = std::numeric_limits<double>::infinity();

// Points as columns, for the vector unit.
struct PointColumns {
  std::vector<float> x, y;
  void clear() { x.clear(), y.clear(); }
  void push_back(Point p) { x.push_back(static_cast<float>(p.x)), y.push_back(static_cast<float>(p.y)); }
  std::size_t size() const { return x.size(); }
};

// The rectangle grown by a margin on all sides.
Footprint grown(const Footprint& footprint, double margin);
bool covers(const Footprint& footprint, Point p);
// Metres from a point to the rectangle, 0 inside.
double distance_to(const Footprint& footprint, Point p);

// Seconds until a constant twist brings the rectangle onto the first of the points; infinite when never (within one
// full turn). A point already inside counts only while the motion would push the rectangle farther over it: a robot
// that is touched can always back away.
double time_to_contact(const Footprint& footprint, const PointColumns& points, const Twist& twist);

// The same for one point, written plainly with trigonometry: the reference for tests and benchmarks.
double time_to_contact_plain(const Footprint& footprint, Point point, const Twist& twist);

}  // namespace robot
