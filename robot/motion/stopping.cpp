#include "robot/motion/stopping.hpp"

#include <algorithm>
#include <cmath>

#include "robot/motion/sweep.hpp"

namespace robot {
namespace {

constexpr double walk_step = 0.03;   // s
constexpr double longest_way = 6.0;  // s; any drive has stopped by then
constexpr float slack = 0.001f;      // m that points may come nearer within the margin

double approach(double from, double to, double up, double down, double seconds) {
  const bool faster = std::abs(to) > std::abs(from) && to * from >= 0.0;
  const double most = (faster ? up : down) * seconds;
  return from + std::clamp(to - from, -most, most);
}

sweep::Box box(const Footprint& f) {
  return {static_cast<float>(f.front), static_cast<float>(f.rear), static_cast<float>(f.half_width)};
}

}  // namespace

Twist toward(const Twist& from, const Twist& wanted, const DriveLimits& limits, double seconds) {
  return {approach(from.linear, wanted.linear, limits.max_acceleration, limits.max_deceleration, seconds),
          approach(from.angular, wanted.angular, limits.max_angular_acceleration, limits.max_angular_acceleration,
                   seconds)};
}

std::vector<Pose> way_of(const Twist& measured, std::span<const DueCommand> commands, const DriveLimits& limits) {
  std::vector<Pose> way = {Pose{}};
  Twist twist = measured, wanted = measured;
  std::size_t next = 0;
  for (double t = 0.0; t < longest_way; t += walk_step) {
    while (next < commands.size() && commands[next].due <= t) wanted = commands[next++].twist;
    twist = toward(twist, wanted, limits, walk_step);
    if (next == commands.size() && twist == Twist{}) break;
    way.push_back(way.back() * arc(twist, walk_step));
  }
  return way;
}

double signed_distance(const Footprint& f, Point p) {
  const float x = static_cast<float>(p.x), y = static_cast<float>(p.y);
  return sweep::least_distance(box(f), 0.0f, 0.0f, 1.0f, 0.0f, &x, &y, nullptr, 1);
}

bool stays_clear(const Footprint& footprint, double margin, std::span<const Point> points, std::span<const Pose> way) {
  double reach = 0.0;
  for (const Pose& pose : way) reach = std::max(reach, norm(pose.position()));
  reach += footprint.circumscribed() + margin;
  std::vector<float> xs, ys, allowed;
  for (const Point& p : points) {
    if (!(norm(p) <= reach)) continue;
    xs.push_back(static_cast<float>(p.x));
    ys.push_back(static_cast<float>(p.y));
    allowed.push_back(static_cast<float>(std::min(margin, signed_distance(footprint, p))) - slack);
  }
  return std::all_of(way.begin(), way.end(), [&](const Pose& pose) {
    return sweep::least_distance(box(footprint), static_cast<float>(pose.x), static_cast<float>(pose.y),
                                 static_cast<float>(std::cos(pose.theta)), static_cast<float>(std::sin(pose.theta)),
                                 xs.data(), ys.data(), allowed.data(), xs.size()) >= 0.0f;
  });
}

}  // namespace robot
