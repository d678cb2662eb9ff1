// Polygons in the plane: lists of corners in order, closed implicitly, metres.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "robot/geometry/pose.hpp"

namespace robot {

// Inside by the even-odd rule. Points exactly on an edge may count either way.
inline bool contains(const std::vector<Point>& polygon, Point p) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Point a = polygon[i], b = polygon[j];
    if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) inside = !inside;
  }
  return inside;
}

// Metres from a point to the nearest place on the segment a-b.
inline double distance_to_segment(Point p, Point a, Point b) {
  const Point along = b - a;
  const double length_squared = dot(along, along);
  const double t = length_squared > 0.0 ? std::clamp(dot(p - a, along) / length_squared, 0.0, 1.0) : 0.0;
  return distance(p, a + t * along);
}

// Metres from a point to the polygon's nearest edge, from inside as from outside; infinite without corners.
inline double distance_to_edge(const std::vector<Point>& polygon, Point p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    nearest = std::min(nearest, distance_to_segment(p, polygon[i], polygon[(i + 1) % polygon.size()]));
  }
  return nearest;
}

// Square metres; positive when the corners run counter-clockwise.
inline double signed_area(const std::vector<Point>& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return 0.5 * twice;
}

// Whether two segments share a point, touching ends included.
inline bool segments_meet(Point a, Point b, Point c, Point d) {
  const auto side = [](Point p, Point q, Point r) {
    const double turn = cross(q - p, r - p);
    return (turn > 0.0) - (turn < 0.0);
  };
  const auto on = [](Point p, Point q, Point r) {
    return std::min(p.x, q.x) <= r.x && r.x <= std::max(p.x, q.x) && std::min(p.y, q.y) <= r.y &&
           r.y <= std::max(p.y, q.y);
  };
  const int abc = side(a, b, c), abd = side(a, b, d), cda = side(c, d, a), cdb = side(c, d, b);
  if (abc != abd && cda != cdb) return true;
  return (abc == 0 && on(a, b, c)) || (abd == 0 && on(a, b, d)) || (cda == 0 && on(c, d, a)) ||
         (cdb == 0 && on(c, d, b));
}

// Whether any two edges that are not neighbours meet, as in a figure of eight or at a repeated corner.
inline bool crosses_itself(const std::vector<Point>& polygon) {
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (polygon[i] == polygon[(i + 1) % n]) return true;
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      if (segments_meet(polygon[i], polygon[i + 1], polygon[j], polygon[(j + 1) % n])) return true;
    }
  }
  return false;
}

}  // namespace robot
