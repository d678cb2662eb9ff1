#include "robot/mapping/obstacle_layers.hpp"

#include <algorithm>
#include <cmath>

namespace robot {
namespace {

constexpr int certain = 100;             // per cent
constexpr Seconds fading_step{1.0};      // evidence fades in steps of at least this
constexpr double explained_near = 0.25;  // m before an echo in which a known obstacle explains it
constexpr double explained_far = 0.20;   // m behind it
constexpr double nearest_hit = 0.05;     // m; nearer returns are the housing

// Whether the beams on both sides of a point (laser frame) fly past it by a margin.
bool beams_pass(const ScanView& scan, Point in_laser, double margin) {
  const double beam = (std::atan2(in_laser.y, in_laser.x) - scan.angle_min) / scan.angle_step;
  if (!(beam >= 0.0) || beam + 1.0 >= static_cast<double>(scan.ranges.size())) return false;
  const auto i = static_cast<std::size_t>(beam);
  const double needed = norm(in_laser) + margin;
  return scan.ranges[i] > needed && scan.ranges[i + 1] > needed;  // false for NaN
}

}  // namespace

void EvidenceLayer::set(Cell cell, int value) {
  std::uint8_t& held = grid_[cell];
  const int bounded = std::clamp(value, 0, certain);
  if ((held >= blocked_from) != (bounded >= blocked_from)) flipped_.push_back(cell);
  held = static_cast<std::uint8_t>(bounded);
}

void EvidenceLayer::change(Cell cell, int by) {
  if (!grid_.contains(cell)) return;
  const int before = grid_[cell];
  if (before == 0 && by > 0) active_.push_back(cell);
  // A cell that falls to nothing leaves the list at the next revision.
  if (before == 0 && by <= 0) return;
  set(cell, std::max(1, before + by));
}

template <typename F>
void EvidenceLayer::revise(F f) {
  std::size_t kept = 0;
  for (const Cell c : active_) {
    set(c, f(c, static_cast<int>(grid_[c])));
    if (grid_[c] > 0) active_[kept++] = c;
  }
  active_.resize(kept);
}

void EvidenceLayer::scale(double factor) {
  revise([&](Cell, int evidence) { return static_cast<int>(factor * evidence); });
}

std::vector<Cell> EvidenceLayer::take_flipped() { return std::exchange(flipped_, {}); }

ObstacleLayers::ObstacleLayers(const OccupancyGrid& map, const ObstacleLayersConfig& config)
    : config_(config),
      map_(map),
      laser_(map.width(), map.height(), map.resolution(), map.origin()),
      sonar_(map.width(), map.height(), map.resolution(), map.origin()) {}

void ObstacleLayers::add(const ScanView& scan) {
  if (scan.kinds.size() != scan.ranges.size() || !(scan.angle_step > 0.0) || !is_finite(scan.map_from_laser)) return;
  const Pose laser_from_map = inverse(scan.map_from_laser);
  laser_.revise([&](Cell c, int evidence) {
    const Point p = laser_from_map * map_.center(c);
    if (norm(p) > config_.laser_reach) return evidence;
    return beams_pass(scan, p, config_.clear_margin) ? 0 : evidence;
  });
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range = scan.ranges[i];
    if (scan.kinds[i] != BeamKind::person || !(range > nearest_hit) || !(range <= config_.laser_reach)) continue;
    const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_step;
    const Point end = scan.map_from_laser * Point{range * std::cos(angle), range * std::sin(angle)};
    laser_.change(map_.cell(end), config_.laser_gain);
  }
}

// Whether the map or the laser layer has something about where the echo came from.
bool ObstacleLayers::explained(const Pose& map_from_sonar, double range, double half_angle) const {
  const double step = map_.resolution();
  for (double r = std::max(0.0, range - explained_near); r <= range + explained_far; r += step) {
    const double turn = std::min(half_angle, step / std::max(r, step));
    for (double a = -1.2 * half_angle; a <= 1.2 * half_angle; a += turn) {
      const Cell c = map_.cell(map_from_sonar * Point{r * std::cos(a), r * std::sin(a)});
      if (!map_.contains(c) || !is_free(map_[c]) || laser_.evidence(c) > 0) return true;
    }
  }
  return false;
}

void ObstacleLayers::add(const SonarScan& scan, const Pose& map_from_base, std::span<const SonarMount> mounts) {
  if (!is_finite(map_from_base)) return;
  for (const SonarReading& reading : scan.readings) {
    const double range = reading.range;
    if (reading.sonar < 0 || static_cast<std::size_t>(reading.sonar) >= mounts.size() || !(range > 0.0)) continue;
    const SonarMount& mount = mounts[static_cast<std::size_t>(reading.sonar)];
    const Pose map_from_sonar = map_from_base * mount.base_from_sonar, sonar_from_map = inverse(map_from_sonar);
    const double half = 0.5 * mount.opening_angle;
    sonar_.revise([&](Cell c, int evidence) {
      const Point p = sonar_from_map * map_.center(c);
      const bool inside =
          norm(p) < std::min(range, mount.max_range) - config_.clear_margin && std::abs(std::atan2(p.y, p.x)) < half;
      return inside ? evidence - config_.sonar_gain : evidence;
    });
    if (range > config_.sonar_reach || explained(map_from_sonar, range, half)) continue;
    // The middle of the cone: its flanks hear weakly, and neighbouring sonars overlap there.
    Cell last{-1, -1};
    for (double a = -0.5 * half; a <= 0.5 * half; a += 0.5 * map_.resolution() / range) {
      const Cell c = map_.cell(map_from_sonar * Point{range * std::cos(a), range * std::sin(a)});
      if (c == last) continue;
      sonar_.change(c, config_.sonar_gain);
      last = c;
    }
  }
}

void ObstacleLayers::decay(Time now) {
  const Seconds since = now - faded_;
  if (since < fading_step) return;
  faded_ = now;
  const double factor = std::exp2(-since.count() / config_.half_life.count());
  laser_.scale(factor);
  sonar_.scale(factor);
}

void ObstacleLayers::forget() {
  laser_.scale(0.0);
  sonar_.scale(0.0);
}

void ObstacleLayers::forget_near(Point center, double radius) {
  const auto fade = [&](Cell c, int evidence) { return distance(map_.center(c), center) <= radius ? 0 : evidence; };
  laser_.revise(fade);
  sonar_.revise(fade);
}

std::vector<Cell> ObstacleLayers::blocked_cells() const {
  std::vector<Cell> cells;
  for (const Cell& c : laser_.active()) {
    if (laser_.blocked(c)) cells.push_back(c);
  }
  for (const Cell& c : sonar_.active()) {
    if (sonar_.blocked(c) && !laser_.blocked(c)) cells.push_back(c);
  }
  return cells;
}

std::vector<Cell> ObstacleLayers::take_changes() {
  std::vector<Cell> changes = laser_.take_flipped();
  const std::vector<Cell> more = sonar_.take_flipped();
  changes.insert(changes.end(), more.begin(), more.end());
  return changes;
}

std::vector<Point> ObstacleLayers::sonar_obstacles_near(Point center, double reach) const {
  std::vector<Point> points;
  for (const Cell& c : sonar_.active()) {
    if (sonar_.blocked(c) && distance(map_.center(c), center) <= reach) points.push_back(map_.center(c));
  }
  return points;
}

OccupancyGrid ObstacleLayers::integrated() const {
  OccupancyGrid joined = map_;
  for (const EvidenceLayer* layer : {&laser_, &sonar_}) {
    for (const Cell& c : layer->active()) {
      if (joined[c] == unknown_cell && !layer->blocked(c)) continue;
      joined[c] = std::max(joined[c], static_cast<std::int8_t>(layer->evidence(c)));
    }
  }
  return joined;
}

}  // namespace robot
