// The next metres of the path as the robot sees them: from the place on it that is nearest, in the base frame.
#pragma once

#include <vector>

#include "robot/geometry/pose.hpp"

namespace robot {

class PathAhead {
 public:
  struct Place {
    double along = 0.0;   // m from the nearest place
    double offset = 0.0;  // m off the path
  };

  // path: map frame. Only `reach` metres of it are kept; remaining() counts all.
  PathAhead(const std::vector<Point>& path, const Pose& map_from_base, double reach);

  bool empty() const { return points_.empty(); }
  double remaining() const { return remaining_; }  // m to the path's end
  double reach() const { return along_.empty() ? 0.0 : along_.back(); }

  Place project(Point base_point) const;
  Point at(double along) const;
  // Direction of the path there, rad.
  double heading(double along) const;
  // The farthest point up to `lookahead` metres ahead to which the straight way strays at most `deviation` metres from
  // the path: corners are not cut.
  Point carrot(double lookahead, double deviation) const;

 private:
  std::vector<Point> points_;  // base frame, a decimetre apart
  std::vector<double> along_;  // m
  double remaining_ = 0.0;
};

}  // namespace robot
