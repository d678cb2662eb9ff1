#include "robot/motion/path_ahead.hpp"

#include <algorithm>
#include <cmath>

#include "robot/geometry/polygon.hpp"

namespace robot {
namespace {

constexpr double spacing = 0.1;             // m
constexpr double shortest_lookahead = 0.3;  // m
constexpr double early = 0.05;              // m of distance that a metre of path outweighs: loops do not mislead

double share_along(Point p, Point a, Point b) {
  const Point leg = b - a;
  const double length_squared = dot(leg, leg);
  return length_squared > 0.0 ? std::clamp(dot(p - a, leg) / length_squared, 0.0, 1.0) : 0.0;
}

}  // namespace

PathAhead::PathAhead(const std::vector<Point>& path, const Pose& map_from_base, double reach) {
  if (path.empty()) return;
  const Point robot = map_from_base.position();
  std::size_t leg = 0;
  double share = 0.0, best = distance(robot, path.front()), along = 0.0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const double t = share_along(robot, path[i], path[i + 1]), length = distance(path[i], path[i + 1]);
    const double away = distance(robot, path[i] + t * (path[i + 1] - path[i])) + early * (along + t * length);
    if (away < best) {
      best = away;
      leg = i;
      share = t;
    }
    along += length;
  }
  const Pose base_from_map = inverse(map_from_base);
  const auto append = [&](Point p) {
    const Point seen = base_from_map * p;
    along_.push_back(points_.empty() ? 0.0 : along_.back() + distance(points_.back(), seen));
    points_.push_back(seen);
  };
  Point from = leg + 1 < path.size() ? path[leg] + share * (path[leg + 1] - path[leg]) : path[leg];
  append(from);
  for (std::size_t i = leg + 1; i < path.size(); ++i) {
    const double length = distance(from, path[i]);
    remaining_ += length;
    const int pieces = std::max(1, static_cast<int>(std::ceil(length / spacing)));
    for (int k = 1; k <= pieces && along_.back() < reach; ++k) {
      append(from + (static_cast<double>(k) / pieces) * (path[i] - from));
    }
    from = path[i];
  }
}

PathAhead::Place PathAhead::project(Point p) const {
  Place place{0.0, points_.empty() ? 0.0 : distance(p, points_.front())};
  for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
    const double t = share_along(p, points_[i], points_[i + 1]);
    const double offset = distance(p, points_[i] + t * (points_[i + 1] - points_[i]));
    if (offset < place.offset) place = {along_[i] + t * (along_[i + 1] - along_[i]), offset};
  }
  return place;
}

Point PathAhead::at(double along) const {
  if (points_.empty()) return {};
  const auto after = std::upper_bound(along_.begin(), along_.end(), along);
  if (after == along_.begin()) return points_.front();
  if (after == along_.end()) return points_.back();
  const auto i = static_cast<std::size_t>(after - along_.begin());
  const double t = (along - along_[i - 1]) / (along_[i] - along_[i - 1]);
  return points_[i - 1] + t * (points_[i] - points_[i - 1]);
}

double PathAhead::heading(double along) const {
  const Point leg = at(along + spacing) - at(along - spacing);
  return std::atan2(leg.y, leg.x);
}

Point PathAhead::carrot(double lookahead, double deviation) const {
  Point best = at(std::min(shortest_lookahead, reach()));
  for (std::size_t i = 0; i < points_.size() && along_[i] <= lookahead; ++i) {
    if (along_[i] < shortest_lookahead) continue;
    double strays = 0.0;
    for (std::size_t k = 0; k < i; ++k) strays = std::max(strays, distance_to_segment(points_[k], {}, points_[i]));
    // Being off the path is no reason to hug it: only what the way ahead adds counts.
    if (strays > deviation + norm(points_.front())) break;
    best = points_[i];
  }
  return best;
}

}  // namespace robot
