#include "robot/motion/stopping.hpp"

#include <algorithm>
#include <cmath>

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

float signed_distance(float front, float rear, float half, float x, float y) {
  const float dx = std::max(x - front, -rear - x), dy = std::abs(y) - half;
  const float ox = std::max(dx, 0.0f), oy = std::max(dy, 0.0f);
  return std::sqrt(ox * ox + oy * oy) + std::min(std::max(dx, dy), 0.0f);
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
  return signed_distance(static_cast<float>(f.front), static_cast<float>(f.rear), static_cast<float>(f.half_width),
                         static_cast<float>(p.x), static_cast<float>(p.y));
}

bool stays_clear(const Footprint& footprint, double margin, std::span<const Point> points, std::span<const Pose> way) {
  double reach = 0.0;
  for (const Pose& pose : way) reach = std::max(reach, norm(pose.position()));
  reach += footprint.circumscribed() + margin;
  const float front = static_cast<float>(footprint.front), rear = static_cast<float>(footprint.rear);
  const float half = static_cast<float>(footprint.half_width);
  std::vector<float> xs, ys, allowed;
  for (const Point& p : points) {
    if (norm(p) > reach) continue;
    xs.push_back(static_cast<float>(p.x));
    ys.push_back(static_cast<float>(p.y));
    const float now = signed_distance(front, rear, half, xs.back(), ys.back());
    allowed.push_back(std::min(static_cast<float>(margin), now) - slack);
  }
  for (const Pose& pose : way) {
    const float c = static_cast<float>(std::cos(pose.theta)), s = static_cast<float>(std::sin(pose.theta));
    const float px = static_cast<float>(pose.x), py = static_cast<float>(pose.y);
    float worst = 1.0f;
    for (std::size_t i = 0; i < xs.size(); ++i) {
      const float dx = xs[i] - px, dy = ys[i] - py;
      const float d = signed_distance(front, rear, half, c * dx + s * dy, c * dy - s * dx);
      worst = std::min(worst, d - allowed[i]);
    }
    if (worst < 0.0f) return false;
  }
  return true;
}

}  // namespace robot
