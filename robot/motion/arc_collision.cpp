#include "robot/motion/arc_collision.hpp"

#include <algorithm>
#include <cmath>

#include "robot/motion/sweep.hpp"

namespace robot {
namespace {

constexpr double still = 1e-6;           // m/s or rad/s that count as none
constexpr double straight_radius = 200;  // m; flatter arcs are treated as straight lines

// Does the motion push the rectangle farther over a point that it already covers? The way out is across the nearest
// edge.
bool pushes_over(const Footprint& f, Point p, const Twist& twist) {
  const double to_front = f.front - p.x, to_rear = p.x + f.rear;
  const double to_left = f.half_width - p.y, to_right = p.y + f.half_width;
  const double nearest = std::min({to_front, to_rear, to_left, to_right});
  // The body's own velocity where the point touches it.
  const Point velocity{twist.linear - twist.angular * p.y, twist.angular * p.x};
  if (nearest == to_front) return velocity.x > still;
  if (nearest == to_rear) return velocity.x < -still;
  if (nearest == to_left) return velocity.y > still;
  return velocity.y < -still;
}

double from_pseudo_angle(double a) {
  if (a <= 1.0) return std::asin(a);
  if (a <= 2.0) return std::acos(std::max(1.0 - a, -1.0));
  if (a <= 3.0) return pi + std::asin(std::min(a - 2.0, 1.0));
  return 2.0 * pi - std::acos(std::min(a - 3.0, 1.0));
}

sweep::Box box(const Footprint& f) {
  return {static_cast<float>(f.front), static_cast<float>(f.rear), static_cast<float>(f.half_width)};
}

bool pushes_over_any(const Footprint& f, const PointColumns& points, const Twist& twist) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point p{points.x[i], points.y[i]};
    if (covers(f, p) && pushes_over(f, p, twist)) return true;
  }
  return false;
}

}  // namespace

Footprint grown(const Footprint& footprint, double margin) {
  return {footprint.front + margin, footprint.rear + margin, footprint.half_width + margin};
}

bool covers(const Footprint& f, Point p) { return p.x > -f.rear && p.x < f.front && std::abs(p.y) < f.half_width; }

double distance_to(const Footprint& f, Point p) {
  const double x = std::max({p.x - f.front, -f.rear - p.x, 0.0}), y = std::max(std::abs(p.y) - f.half_width, 0.0);
  return std::hypot(x, y);
}

double time_to_contact(const Footprint& footprint, const PointColumns& points, const Twist& twist) {
  const bool moves = std::abs(twist.linear) > still, turns = std::abs(twist.angular) > still;
  if (!moves && !turns) return no_contact;
  if (pushes_over_any(footprint, points, twist)) return 0.0;
  const double radius = turns ? twist.linear / twist.angular : straight_radius;
  if (!turns || std::abs(radius) >= straight_radius) {
    const float way = sweep::straight(box(footprint), twist.linear > 0.0 ? 1.0f : -1.0f, points.x.data(),
                                      points.y.data(), points.size());
    return way < sweep::far_away ? way / std::abs(twist.linear) : no_contact;
  }
  const float turned = sweep::turning(box(footprint), static_cast<float>(radius), twist.angular > 0.0 ? 1.0f : -1.0f,
                                      points.x.data(), points.y.data(), points.size());
  return turned < sweep::far_away ? from_pseudo_angle(turned) / std::abs(twist.angular) : no_contact;
}

double time_to_contact_plain(const Footprint& f, Point p, const Twist& twist) {
  const bool moves = std::abs(twist.linear) > still, turns = std::abs(twist.angular) > still;
  if (!moves && !turns) return no_contact;
  if (covers(f, p)) return pushes_over(f, p, twist) ? 0.0 : no_contact;
  if (!turns || std::abs(twist.linear / twist.angular) >= straight_radius) {
    const double way = twist.linear > 0.0 ? p.x - f.front : -f.rear - p.x;
    return std::abs(p.y) < f.half_width && way >= 0.0 ? way / std::abs(twist.linear) : no_contact;
  }
  const double radius = twist.linear / twist.angular;
  const Point from_center{p.x, p.y - radius};
  const double r = norm(from_center), start = std::atan2(from_center.y, from_center.x);
  double nearest = no_contact;
  // The point at angle b on its circle meets the robot after the robot has turned by start - b.
  const auto meet = [&](double x, double y) {
    double turned = std::fmod((start - std::atan2(y, x)) * (twist.angular > 0.0 ? 1.0 : -1.0), 2.0 * pi);
    if (turned < 0.0) turned += 2.0 * pi;
    nearest = std::min(nearest, turned / std::abs(twist.angular));
  };
  for (const double x : {f.front, -f.rear}) {
    if (std::abs(x) > r) continue;
    const double y = std::sqrt(r * r - x * x);
    for (const double side : {y, -y}) {
      if (std::abs(side + radius) <= f.half_width) meet(x, side);
    }
  }
  for (const double edge : {f.half_width, -f.half_width}) {
    const double y = edge - radius;
    if (std::abs(y) > r) continue;
    const double x = std::sqrt(r * r - y * y);
    for (const double side : {x, -x}) {
      if (side <= f.front && side >= -f.rear) meet(side, y);
    }
  }
  return nearest;
}

}  // namespace robot
