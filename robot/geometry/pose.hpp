// Points, poses and twists in the plane. x forward (or map right), y left (or map up), angles counter-clockwise.
// A pose is named by what it does: map_from_base maps base coordinates into the map, so that neighbours in a product
// match: map_from_laser = map_from_base * base_from_laser.
#pragma once

#include <cmath>
#include <numbers>

namespace robot {

inline constexpr double pi = std::numbers::pi;

constexpr double radians(double degrees) { return degrees * pi / 180.0; }
constexpr double degrees(double radians) { return radians * 180.0 / pi; }

// Wraps an angle to [-pi, pi]. NaN and infinities come back as NaN.
inline double wrap_angle(double angle) { return std::remainder(angle, 2.0 * pi); }

struct Point {
  double x = 0.0;  // m
  double y = 0.0;  // m
  friend bool operator==(const Point&, const Point&) = default;
};

constexpr Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
constexpr Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
constexpr Point operator*(double s, Point a) { return {s * a.x, s * a.y}; }
constexpr double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
constexpr double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
inline double norm(Point a) { return std::sqrt(a.x * a.x + a.y * a.y); }  // metres: no overflow to fear, and fast
inline double distance(Point a, Point b) { return norm(a - b); }

struct Pose {
  double x = 0.0;      // m
  double y = 0.0;      // m
  double theta = 0.0;  // rad
  Point position() const { return {x, y}; }
  friend bool operator==(const Pose&, const Pose&) = default;
};

// a_from_c = a_from_b * b_from_c.
inline Pose operator*(const Pose& a, const Pose& b) {
  const double c = std::cos(a.theta), s = std::sin(a.theta);
  return {a.x + c * b.x - s * b.y, a.y + s * b.x + c * b.y, wrap_angle(a.theta + b.theta)};
}

inline Point operator*(const Pose& a, Point p) {
  const double c = std::cos(a.theta), s = std::sin(a.theta);
  return {a.x + c * p.x - s * p.y, a.y + s * p.x + c * p.y};
}

inline Pose inverse(const Pose& a) {
  const double c = std::cos(a.theta), s = std::sin(a.theta);
  return {-c * a.x - s * a.y, s * a.x - c * a.y, wrap_angle(-a.theta)};
}

// b seen from a: inverse(a) * b.
inline Pose relative(const Pose& a, const Pose& b) { return inverse(a) * b; }

inline bool is_finite(const Pose& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.theta); }
inline bool is_finite(Point a) { return std::isfinite(a.x) && std::isfinite(a.y); }

// Velocity of a differential-drive base in its own frame.
struct Twist {
  double linear = 0.0;   // m/s, forward positive
  double angular = 0.0;  // rad/s, counter-clockwise positive
  friend bool operator==(const Twist&, const Twist&) = default;
};

// Where a constant twist leads in `seconds`, seen from the start: an exact circular arc.
inline Pose arc(const Twist& twist, double seconds) {
  const double turn = twist.angular * seconds, way = twist.linear * seconds;
  if (std::abs(turn) < 1e-9) return {way, 0.5 * way * turn, wrap_angle(turn)};
  const double radius = way / turn;
  return {radius * std::sin(turn), radius * (1.0 - std::cos(turn)), wrap_angle(turn)};
}

}  // namespace robot
