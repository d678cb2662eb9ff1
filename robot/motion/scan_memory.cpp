#include "robot/motion/scan_memory.hpp"

#include <algorithm>
#include <cmath>

namespace robot {
namespace {

constexpr double person_reach = 0.5;  // m from a person's centre within which beam ends are theirs
constexpr double torso = 0.23;        // m, radius of a body seen from above
constexpr int outline_points = 12;
constexpr double walking = 0.15;  // m/s; slower people count as standing

constexpr double hidden_reach = 0.8;  // m to the side within which hidden points matter
constexpr Seconds hidden_for{10.0};   // how long they are remembered
constexpr std::size_t most_hidden = 200;

Pose between(const Odometry& a, const Odometry& b, Time time) {
  const double span = Seconds(b.time - a.time).count();
  const double t = span > 0.0 ? std::clamp(Seconds(time - a.time).count() / span, 0.0, 1.0) : 1.0;
  const Pose step = relative(a.odom_from_base, b.odom_from_base);
  return a.odom_from_base * Pose{t * step.x, t * step.y, t * step.theta};
}

}  // namespace

void ScanMemory::add(const Odometry& odometry) {
  if (!is_finite(odometry.odom_from_base)) return;
  newest_ = odometry;
  odometry_[count_++ % history] = odometry;
}

std::optional<Pose> ScanMemory::odom_from_base(Time time) const {
  if (count_ == 0) return std::nullopt;
  const std::size_t oldest = count_ > history ? count_ - history : 0;
  for (std::size_t i = count_; i-- > oldest;) {
    const Odometry& before = odometry_[i % history];
    if (before.time > time) continue;
    if (i + 1 < count_) return between(before, odometry_[(i + 1) % history], time);
    // Younger than all odometry: it goes on as it was measured, for a moment.
    const double ahead = std::clamp(Seconds(time - before.time).count(), 0.0, 0.1);
    return before.odom_from_base * arc(before.twist, ahead);
  }
  return odometry_[oldest % history].odom_from_base;
}

void ScanMemory::add(const LaserScan& scan) {
  const auto id = static_cast<std::size_t>(scan.laser);
  const auto base = odom_from_base(scan.time);
  if (id >= sweeps_.size() || id >= body_.lasers.size() || !base) return;
  const LaserMount& mount = body_.lasers[id];
  const Pose odom_from_laser = *base * mount.base_from_laser;
  Sweep& sweep = sweeps_[id];
  remember_hidden(sweep, inverse(*base), scan.time);
  sweep.seen = true;
  sweep.time = scan.time;
  sweep.points.clear();
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range = scan.ranges[i];
    if (!(range > 0.0) || !(range < mount.max_range)) continue;
    const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_step;
    sweep.points.push_back(odom_from_laser * Point{range * std::cos(angle), range * std::sin(angle)});
  }
}

// Beside the body, behind the front laser and ahead of the rear one: the half circles that they see end there.
bool ScanMemory::hidden(Point p) const {
  if (body_.lasers.size() < 2) return false;
  return p.x < body_.lasers[0].base_from_laser.x && p.x > body_.lasers[1].base_from_laser.x &&
         std::abs(p.y) < hidden_reach;
}

void ScanMemory::remember_hidden(const Sweep& old, const Pose& base_from_odom, Time now) {
  std::erase_if(unseen_,
                [&](const Unseen& u) { return now - u.time > hidden_for || !hidden(base_from_odom * u.point); });
  for (const Point& p : old.points) {
    if (unseen_.size() < most_hidden && hidden(base_from_odom * p)) unseen_.push_back({now, p});
  }
}

std::vector<Point> ScanMemory::points(double reach) const {
  std::vector<Point> near;
  if (count_ == 0) return near;
  const Pose base_from_odom = inverse(newest_.odom_from_base);
  for (const Sweep& sweep : sweeps_) {
    for (const Point& p : sweep.points) {
      const Point seen = base_from_odom * p;
      if (dot(seen, seen) <= reach * reach) near.push_back(seen);
    }
  }
  for (const Unseen& u : unseen_) near.push_back(base_from_odom * u.point);
  return near;
}

std::optional<Time> ScanMemory::scanned(LaserId laser) const {
  const Sweep& sweep = sweeps_[static_cast<std::size_t>(laser)];
  if (!sweep.seen) return std::nullopt;
  return sweep.time;
}

std::vector<Point> body_outline(const PersonSeen& person) {
  std::vector<Point> outline;
  for (int i = 0; i < outline_points; ++i) {
    const double angle = 2.0 * pi * i / outline_points;
    outline.push_back(person.position + torso * Point{std::cos(angle), std::sin(angle)});
  }
  return outline;
}

std::vector<Obstacle> with_motion(std::span<const Point> base_points, const People& people, const Pose& map_from_base) {
  const Pose base_from_map = inverse(map_from_base), turn{0.0, 0.0, base_from_map.theta};
  std::vector<Obstacle> walkers, obstacles;
  for (const PersonSeen& person : people.people) {
    const bool walks = norm(person.velocity) >= walking;
    const Point velocity = walks ? turn * person.velocity : Point{};
    if (walks) walkers.push_back({base_from_map * person.position, velocity});
    for (const Point& p : body_outline(person)) obstacles.push_back({base_from_map * p, velocity});
  }
  for (const Point& p : base_points) {
    Obstacle obstacle{p, {}};
    double nearest = person_reach;
    for (const Obstacle& person : walkers) {
      const double away = distance(p, person.position);
      if (away >= nearest) continue;
      nearest = away;
      obstacle.velocity = person.velocity;
    }
    obstacles.push_back(obstacle);
  }
  return obstacles;
}

}  // namespace robot
