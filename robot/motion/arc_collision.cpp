#include "robot/motion/arc_collision.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace robot {
namespace {

constexpr double still = 1e-6;           // m/s or rad/s that count as none
constexpr double straight_radius = 200;  // m; flatter arcs are treated as straight lines
constexpr float far_away = 1e30f;

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

// A measure of the angle from u to v, turning counter-clockwise, that grows with it from 0 to 4, a unit a quadrant: no
// trigonometry, and exact for the small angles of wide arcs. Both vectors have the length 1 / sqrt(inverse_radius2).
inline float pseudo_angle(float ux, float uy, float vx, float vy, float inverse_radius2) {
  const float c = (ux * vx + uy * vy) * inverse_radius2, s = (ux * vy - uy * vx) * inverse_radius2;
  const float left = c > 0.0f ? s : 1.0f - c, right = c > 0.0f ? 3.0f + c : 2.0f - s;
  return s >= 0.0f ? left : right;
}

double from_pseudo_angle(double a) {
  if (a <= 1.0) return std::asin(a);
  if (a <= 2.0) return std::acos(std::max(1.0 - a, -1.0));
  if (a <= 3.0) return pi + std::asin(std::min(a - 2.0, 1.0));
  return 2.0 * pi - std::acos(std::min(a - 3.0, 1.0));
}

double straight_contact(const Footprint& f, const PointColumns& points, double linear) {
  const auto edge = static_cast<float>(linear > 0.0 ? f.front : f.rear), half = static_cast<float>(f.half_width);
  const float sign = linear > 0.0 ? 1.0f : -1.0f;
  float nearest = far_away;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const float way = sign * points.x[i] - edge;
    const bool meets = std::abs(points.y[i]) < half && way >= 0.0f;
    nearest = meets && way < nearest ? way : nearest;
  }
  return nearest < far_away ? nearest / std::abs(linear) : no_contact;
}

// In the robot's frame every point turns about the centre (0, radius), by minus the robot's own turn. Mirrored so that
// the points always turn clockwise: `turn_sign` is the sign of the angular velocity.
double turning_contact(const Footprint& f, const PointColumns& points, double radius, double turn_sign) {
  const auto cy = static_cast<float>(radius), sign = static_cast<float>(turn_sign);
  const float front = static_cast<float>(f.front), rear = static_cast<float>(-f.rear);
  const float left = static_cast<float>(f.half_width), right = -left;
  float nearest = far_away;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const float px = points.x[i], py = points.y[i] - cy;
    const float r2 = px * px + py * py, inverse = 1.0f / std::max(r2, 1e-12f);
    // Turning from where it meets an edge to the point, counter-clockwise for a left turn of the robot.
    const auto meet = [&](float x, float y, bool valid) {
      const float a = pseudo_angle(x, sign * y, px, sign * py, inverse);
      return valid ? a : far_away;
    };
    const auto on_x = [&](float x) {  // front or rear edge
      const float y2 = r2 - x * x, y = std::sqrt(std::max(y2, 0.0f));
      const float low = right - cy, high = left - cy;
      const float a = meet(x, y, y2 >= 0.0f && y >= low && y <= high);
      const float b = meet(x, -y, y2 >= 0.0f && -y >= low && -y <= high);
      return std::min(a, b);
    };
    const auto on_y = [&](float edge) {  // left or right edge
      const float y = edge - cy, x2 = r2 - y * y, x = std::sqrt(std::max(x2, 0.0f));
      const float a = meet(x, y, x2 >= 0.0f && x >= rear && x <= front);
      const float b = meet(-x, y, x2 >= 0.0f && -x >= rear && -x <= front);
      return std::min(a, b);
    };
    const float first = std::min(std::min(on_x(front), on_x(rear)), std::min(on_y(left), on_y(right)));
    const bool inside = points.x[i] > rear && points.x[i] < front && points.y[i] > right && points.y[i] < left;
    nearest = inside ? nearest : std::min(nearest, first);
  }
  return nearest < far_away ? from_pseudo_angle(nearest) : no_contact;
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
  if (!turns || std::abs(radius) >= straight_radius) return straight_contact(footprint, points, twist.linear);
  const double angle = turning_contact(footprint, points, radius, twist.angular > 0.0 ? 1.0 : -1.0);
  return angle / std::abs(twist.angular);
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
