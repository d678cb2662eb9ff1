#include "robot/simulation/contacts.hpp"

#include <algorithm>
#include <cmath>

#include "robot/geometry/polygon.hpp"

namespace robot::simulation {
namespace {

// Whether an upright square cell and the footprint overlap: no axis of either parts them.
bool meets_cell(const Footprint& f, const Pose& base_from_map, Point center, double half) {
  const Point local = base_from_map * center;
  const double reach = half * (std::abs(std::cos(base_from_map.theta)) + std::abs(std::sin(base_from_map.theta)));
  return local.x - reach < f.front && local.x + reach > -f.rear && std::abs(local.y) - reach < f.half_width;
}

}  // namespace

Polygon corners(const Footprint& f, const Pose& map_from_base) {
  return {map_from_base * Point{f.front, f.half_width}, map_from_base * Point{-f.rear, f.half_width},
          map_from_base * Point{-f.rear, -f.half_width}, map_from_base * Point{f.front, -f.half_width}};
}

Nearest nearest_place(const Footprint& f, const Pose& map_from_base, Point point) {
  const Point local = inverse(map_from_base) * point;
  const Point inside{std::clamp(local.x, -f.rear, f.front), std::clamp(local.y, -f.half_width, f.half_width)};
  return {map_from_base * inside, length(inside - local)};
}

std::optional<Point> touched_wall(const Footprint& f, const Pose& map_from_base, const Walls& walls) {
  if (walls.clearance(map_from_base.position()) > f.circumscribed() + 0.1) return std::nullopt;
  const auto& cells = walls.cells();
  const double r = cells.resolution(), reach = f.circumscribed() + r;
  const Pose base_from_map = inverse(map_from_base);
  for (double y = map_from_base.y - reach; y <= map_from_base.y + reach; y += r) {
    for (double x = map_from_base.x - reach; x <= map_from_base.x + reach; x += r) {
      const Cell cell = cells.cell({x, y});
      if (!walls.occupied(cell)) continue;
      const Point center = cells.center(cell);
      if (!meets_cell(f, base_from_map, center, 0.5 * r)) continue;
      const Polygon square{center + Point{-0.5 * r, -0.5 * r}, center + Point{0.5 * r, -0.5 * r},
                           center + Point{0.5 * r, 0.5 * r}, center + Point{-0.5 * r, 0.5 * r}};
      if (overlaps(f, map_from_base, square)) return center;
    }
  }
  return std::nullopt;
}

bool overlaps(const Footprint& f, const Pose& map_from_base, const Polygon& polygon) {
  const Polygon box = corners(f, map_from_base);
  for (const Point corner : box) {
    if (contains(polygon, corner)) return true;
  }
  for (const Point corner : polygon) {
    if (contains(box, corner)) return true;
  }
  for (std::size_t i = 0; i < box.size(); ++i) {
    for (std::size_t j = 0; j < polygon.size(); ++j) {
      if (segments_meet(box[i], box[(i + 1) % 4], polygon[j], polygon[(j + 1) % polygon.size()])) return true;
    }
  }
  return false;
}

Hazards::Hazards(const Museum& museum) : boundary_(museum.boundary) {
  for (const auto& hazard : museum.hazards) {
    if (hazard.polygon.empty()) continue;
    Point low = hazard.polygon.front(), high = low;
    for (const Point p : hazard.polygon) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    areas_.push_back({hazard, low, high});
  }
}

std::optional<TouchedHazard> Hazards::touched(const Footprint& f, const Pose& map_from_base) const {
  const double reach = f.circumscribed();
  const Point p = map_from_base.position();
  for (const auto& [hazard, low, high] : areas_) {
    if (p.x < low.x - reach || p.x > high.x + reach || p.y < low.y - reach || p.y > high.y + reach) continue;
    if (!overlaps(f, map_from_base, hazard.polygon)) continue;
    const bool solid = hazard.kind == HazardKind::glass || hazard.kind == HazardKind::low_obstacle;
    return TouchedHazard{hazard.id, p, solid};
  }
  if (boundary_.empty()) return std::nullopt;
  const Polygon box = corners(f, map_from_base);
  for (const Point corner : box) {
    if (!contains(boundary_, corner)) return TouchedHazard{"boundary", corner, false};
  }
  for (const Point corner : boundary_) {
    if (contains(box, corner)) return TouchedHazard{"boundary", corner, false};
  }
  return std::nullopt;
}

bool robot_at_fault(const Footprint& f, const Pose& map_from_base, Twist ground, const Person& person, Point velocity) {
  const Nearest touch = nearest_place(f, map_from_base, person.position);
  const Point arm = touch.place - map_from_base.position();
  const double c = std::cos(map_from_base.theta), s = std::sin(map_from_base.theta);
  const Point body{ground.linear * c - ground.angular * arm.y, ground.linear * s + ground.angular * arm.x};
  const Point apart = person.position - touch.place;
  const double gap = length(apart);
  const Point normal = gap > 1e-6 ? (1.0 / gap) * apart : Point{c, s};
  const double robot_closing = dot(body, normal), person_closing = -dot(velocity, normal);
  return robot_closing > 0.02 && robot_closing >= person_closing;
}

bool inevitable(const Footprint& f, const Pose& map_from_base, Twist ground, double deceleration, double reaction,
                Point place, double radius) {
  const double speed = std::abs(ground.linear);
  if (speed < 0.02) return false;
  // The stopping way is travelled at constant curvature; only its length matters, so it is walked at full speed.
  const double seconds = reaction + 0.5 * speed / deceleration;
  constexpr int samples = 6;
  for (int i = 0; i <= samples; ++i) {
    const Pose ahead = map_from_base * arc(ground, seconds * i / samples);
    if (nearest_place(f, ahead, place).distance < radius) return true;
  }
  return false;
}

}  // namespace robot::simulation
