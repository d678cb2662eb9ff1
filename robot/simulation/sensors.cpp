#include "robot/simulation/sensors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace robot::simulation {
namespace {

constexpr float no_return = std::numeric_limits<float>::quiet_NaN();
constexpr double never = std::numeric_limits<double>::infinity();
constexpr int sonar_groups = 8;
constexpr int rays_per_cone = 5;

// Metres along a unit direction to a circle; infinite when it misses, 0 from inside.
double to_circle(Point center, double radius, double cosine, double sine) {
  const double along = center.x * cosine + center.y * sine, off = center.x * sine - center.y * cosine;
  const double chord = radius * radius - off * off;
  if (chord <= 0.0) return never;
  const double half = std::sqrt(chord);
  return along + half < 0.0 ? never : std::max(0.0, along - half);
}

// Metres along a unit direction from `from` to the segment a-b; infinite when it misses.
double to_segment(Point from, double cosine, double sine, Point a, Point b) {
  const Point edge = b - a, to = a - from, way{cosine, sine};
  const double turn = cross(way, edge);
  if (std::abs(turn) < 1e-12) return never;
  const double t = cross(to, edge) / turn, u = cross(to, way) / turn;
  return t >= 0.0 && u >= 0.0 && u <= 1.0 ? t : never;
}

// Shortens the beams that meet a circle given in the laser's frame; touches no others.
void meet_circle(LaserScan& scan, Point center, double radius, auto&& direction) {
  const double d = length(center);
  const int beams = static_cast<int>(scan.ranges.size());
  int first = 0, last = beams - 1;
  if (d > radius) {
    const double half = std::asin(radius / d);
    double bearing = std::atan2(center.y, center.x) - scan.angle_min;
    if (bearing > pi) bearing -= 2.0 * pi;
    // A full turn's scan may meet the circle across its seam; half-turn scans never do.
    first = static_cast<int>(std::ceil((bearing - half) / scan.angle_step));
    last = static_cast<int>(std::floor((bearing + half) / scan.angle_step));
  }
  for (int i = std::max(0, first); i <= std::min(last, beams - 1); ++i) {
    const auto [cosine, sine] = direction(i);
    const auto range = static_cast<float>(to_circle(center, radius, cosine, sine));
    auto& seen = scan.ranges[static_cast<std::size_t>(i)];
    if (range < scan.max_range && !(seen < range)) seen = range;
  }
}

}  // namespace

Sensors::Sensors(const Museum& museum, Body body, const SensorNoise& noise, Random random)
    : body_(std::move(body)), noise_(noise), laser_random_(random.split()), sonar_random_(random.split()) {
  for (auto& laser : body_.lasers) {
    laser.base_from_laser.theta += laser_random_.normal(noise_.laser_turn);
    bias_.push_back(laser_random_.normal(noise_.laser_bias));
    auto& table = beams_.emplace_back();
    for (int i = 0; i < laser.beams; ++i) {
      const double angle = laser.angle_min + i * laser.angle_step;
      table.push_back({std::cos(angle), std::sin(angle)});
    }
  }
  for (const auto& hazard : museum.hazards) {
    if (hazard.kind != HazardKind::glass) continue;
    for (std::size_t i = 0; i < hazard.polygon.size(); ++i) {
      glass_.push_back({hazard.polygon[i], hazard.polygon[(i + 1) % hazard.polygon.size()]});
    }
  }
}

LaserScan Sensors::scan(LaserId id, const Walls& walls, std::span<const Person> people, const Pose& map_from_base,
                        Time now) {
  const auto index = static_cast<std::size_t>(id);
  const LaserMount& mount = body_.lasers.at(index);
  const auto& table = beams_[index];
  LaserScan scan{now, id, mount.angle_min, mount.angle_step, static_cast<float>(mount.max_range), {}};
  scan.ranges.resize(table.size());
  const Pose map_from_laser = map_from_base * mount.base_from_laser;
  const double c = std::cos(map_from_laser.theta), s = std::sin(map_from_laser.theta);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto [bc, bs] = table[i];
    const double range = walls.ray(map_from_laser.position(), {c * bc - s * bs, s * bc + c * bs}, mount.max_range);
    scan.ranges[i] = range < mount.max_range ? static_cast<float>(range) : no_return;
  }
  const Pose laser_from_map = inverse(map_from_laser);
  const auto direction = [&](int i) { return table[static_cast<std::size_t>(i)]; };
  const bool looks_ahead = mount.angle_min > -0.51 * pi && mount.angle_min + mount.beams * mount.angle_step < 0.51 * pi;
  for (const auto& person : people) {
    const Point to = person.position - map_from_laser.position();
    if (dot(to, to) > mount.max_range * mount.max_range) continue;
    if (looks_ahead && c * to.x + s * to.y < -1.0) continue;  // behind the laser, legs and all
    for (const Point leg : legs(person)) meet_circle(scan, laser_from_map * leg, leg_radius, direction);
  }
  for (float& range : scan.ranges) {
    if (noise_.laser_dropout > 0.0 && laser_random_.chance(noise_.laser_dropout)) range = no_return;
    range += static_cast<float>(bias_[index]);
    if (noise_.laser_sigma > 0.0) range += static_cast<float>(laser_random_.normal(noise_.laser_sigma));
    range = range < scan.max_range ? std::max(0.0f, range) : no_return;
  }
  return scan;
}

double Sensors::echo(const SonarMount& mount, const Walls& walls, std::span<const Person> people,
                     const Pose& map_from_sonar) const {
  double nearest = never;
  const Point from = map_from_sonar.position();
  for (int i = 0; i < rays_per_cone; ++i) {
    const double angle =
        map_from_sonar.theta + mount.opening_angle * (static_cast<double>(i) / (rays_per_cone - 1) - 0.5);
    const double c = std::cos(angle), s = std::sin(angle);
    const double limit = std::min(nearest, mount.max_range);
    const double wall = walls.ray(from, {c, s}, limit);
    if (wall < limit) {
      // Smooth walls throw the echo away unless they are met squarely.
      const Point normal = walls.away(from + (wall - 0.05) * Point{c, s});
      if (-(normal.x * c + normal.y * s) > std::cos(noise_.sonar_specular)) nearest = wall;
    }
    for (const auto& edge : glass_) nearest = std::min(nearest, to_segment(from, c, s, edge.a, edge.b));
  }
  const double cone = std::cos(0.5 * mount.opening_angle);
  for (const auto& person : people) {
    const Point to = person.position - from;
    const double d = length(to);
    if (d - person.radius >= std::min(nearest, mount.max_range)) continue;
    const double ahead =
        (to.x * std::cos(map_from_sonar.theta) + to.y * std::sin(map_from_sonar.theta)) / std::max(d, 1e-9);
    if (ahead > cone) nearest = std::max(0.0, d - person.radius);
  }
  return nearest;
}

SonarScan Sensors::sonars(const Walls& walls, std::span<const Person> people, const Pose& map_from_base, Time now) {
  SonarScan scan{now, {}};
  for (int i = group_; i < static_cast<int>(body_.sonars.size()); i += sonar_groups) {
    const SonarMount& mount = body_.sonars[static_cast<std::size_t>(i)];
    double range = echo(mount, walls, people, map_from_base * mount.base_from_sonar);
    if (sonar_random_.chance(noise_.sonar_dropout)) range = never;
    range *= 1.0 + sonar_random_.normal(noise_.sonar_sigma);
    scan.readings.push_back({i, range < mount.max_range ? static_cast<float>(range) : no_return});
  }
  group_ = (group_ + 1) % sonar_groups;
  return scan;
}

}  // namespace robot::simulation
