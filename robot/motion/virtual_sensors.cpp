#include "robot/motion/virtual_sensors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "robot/geometry/distance_field.hpp"
#include "robot/geometry/polygon.hpp"

namespace robot {
namespace {

constexpr double far_away = 1e9;           // m
constexpr double sharp_band = 0.3;         // m round hazards within which distances are exact
constexpr double near_by = 0.06;           // m; nearer hazards are looked at between the cells' centres
constexpr double outward_at_least = 0.17;  // sine of the least angle by which motion must point out of a hazard

// Lowers a field to the exact distance from a polygon's edges within sharp_band of them.
void lower_near_edges(Grid<float>& field, const Polygon& polygon) {
  const double band = sharp_band + field.resolution();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const auto column = [&](double x) { return std::clamp((x - field.origin().x) / field.resolution(), -1.0, 1e6); };
    const auto row = [&](double y) { return std::clamp((y - field.origin().y) / field.resolution(), -1.0, 1e6); };
    const int x0 = std::max(0, static_cast<int>(column(std::min(a.x, b.x) - band)));
    const int y0 = std::max(0, static_cast<int>(row(std::min(a.y, b.y) - band)));
    const int x1 = std::min(field.width() - 1, static_cast<int>(column(std::max(a.x, b.x) + band)));
    const int y1 = std::min(field.height() - 1, static_cast<int>(row(std::max(a.y, b.y) + band)));
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const auto exact = static_cast<float>(distance_to_segment(field.center({x, y}), a, b));
        field[{x, y}] = std::min(field[{x, y}], exact);
      }
    }
  }
}

// Signed metres from cell centres to the edge of the hazards, negative inside: exact within sharp_band of an edge, and
// farther away never too long.
Grid<float> signed_distances(const Museum& museum) {
  const OccupancyGrid& map = museum.map;
  Grid<float> field(map.width(), map.height(), map.resolution(), map.origin(), 1e6f);
  for (const Hazard& hazard : museum.hazards) lower_near_edges(field, hazard.polygon);
  lower_near_edges(field, museum.boundary);
  Mask inside(map.width(), map.height(), map.resolution(), map.origin(), 0), safe = inside, touched = inside;
  const auto half_diagonal = static_cast<float>(std::sqrt(0.5) * map.resolution());
  for (std::size_t i = 0; i < field.size(); ++i) {
    const Point p = field.center(field.cell_at(i));
    const auto holds = [&](const Hazard& h) { return contains(h.polygon, p); };
    const bool outside = !museum.boundary.empty() && !contains(museum.boundary, p);
    inside.cells()[i] = outside || std::any_of(museum.hazards.begin(), museum.hazards.end(), holds) ? 1 : 0;
    safe.cells()[i] = inside.cells()[i] ? 0 : 1;
    touched.cells()[i] = inside.cells()[i] || field.cells()[i] <= half_diagonal ? 1 : 0;
  }
  const Grid<float> to_hazard = distance_to(touched), to_safe = distance_to(safe);
  for (std::size_t i = 0; i < field.size(); ++i) {
    float& d = field.cells()[i];
    const float far = (inside.cells()[i] ? to_safe.cells()[i] : to_hazard.cells()[i]) - half_diagonal;
    if (d > sharp_band) d = std::clamp(far, static_cast<float>(sharp_band), 1e6f);
    if (inside.cells()[i]) d = -d;
  }
  return field;
}

}  // namespace

VirtualSensors::VirtualSensors(const Museum& museum, const VirtualSensorsConfig& config) : config_(config) {
  has_hazards_ = !museum.hazards.empty() || !museum.boundary.empty();
  if (has_hazards_) distance_ = signed_distances(museum);
}

double VirtualSensors::signed_distance(Point point) const {
  if (!has_hazards_) return far_away;
  const Cell cell = distance_.cell(point);
  return distance_.contains(cell) ? distance_[cell] : far_away;
}

// Metres from a point along a direction to the first hazard, at most `limit`: as far as the nearest hazard is away it
// can be walked at once. Half a cell before it is there: hazards may be thinner than a cell.
double VirtualSensors::cast(Point from, Point direction, double limit) const {
  const double half = 0.5 * distance_.resolution(), off_centre = std::sqrt(2.0) * half, cells = 1.0 / (2.0 * half);
  const double x0 = from.x - distance_.origin().x, y0 = from.y - distance_.origin().y;
  double way = 0.0;
  while (way < limit) {
    const double x = (x0 + way * direction.x) * cells, y = (y0 + way * direction.y) * cells;
    if (!(x >= 0.0 && y >= 0.0 && x < distance_.width() && y < distance_.height())) return limit;
    double free = distance_[{static_cast<int>(x), static_cast<int>(y)}] - off_centre;  // the centre may be farther away
    if (free < near_by) {
      free = interpolate(distance_, from + way * direction).value;
      if (free <= half) return way;
    }
    way += std::max(free, half);
  }
  return limit;
}

VirtualReadings VirtualSensors::read(std::span<const Pose> samples) const {
  VirtualReadings readings;
  readings.ranges.assign(static_cast<std::size_t>(config_.directions), static_cast<float>(config_.max_range));
  if (!has_hazards_ || samples.empty()) return readings;
  struct Seat {
    double distance;
    Pose pose;
    Point heading;
  };
  std::vector<Seat> seats;  // nearest to a hazard first
  for (const Pose& pose : samples) {
    seats.push_back({signed_distance(pose.position()), pose, {std::cos(pose.theta), std::sin(pose.theta)}});
  }
  std::stable_sort(seats.begin(), seats.end(), [](const Seat& a, const Seat& b) { return a.distance < b.distance; });
  // Of n equally likely samples so many may be nearer than the reading: eq. (24), eq. (15).
  const auto spare = static_cast<std::size_t>((1.0 - config_.likelihood) * static_cast<double>(seats.size()) + 1e-9);
  readings.clearance = seats[spare].distance - config_.trust;
  if (readings.clearance > config_.max_range) return readings;
  for (const Seat& seat : seats) {
    const Point gradient = interpolate(distance_, seat.pose.position()).gradient;
    readings.outward = readings.outward + Point{dot(gradient, seat.heading), cross(seat.heading, gradient)};
  }
  const double length = norm(readings.outward);
  readings.outward = length > 1e-9 ? (1.0 / length) * readings.outward : Point{};

  std::vector<double> nearest;  // the spare + 1 shortest so far, ascending
  for (int i = 0; i < config_.directions; ++i) {
    const double angle = 2.0 * pi * i / config_.directions;
    const Point ahead{std::cos(angle), std::sin(angle)};
    nearest.assign(spare + 1, config_.max_range + config_.trust);
    for (const Seat& seat : seats) {
      if (seat.distance - distance_.resolution() >= nearest.back())
        break;  // neither this one nor those after it can be nearer
      const Point direction{dot(ahead, {seat.heading.x, -seat.heading.y}),
                            dot(ahead, {seat.heading.y, seat.heading.x})};
      const double range = cast(seat.pose.position(), direction, nearest.back());
      if (range >= nearest.back()) continue;
      nearest.back() = range;
      for (std::size_t k = spare; k > 0 && nearest[k] < nearest[k - 1]; --k) std::swap(nearest[k], nearest[k - 1]);
    }
    const double range = std::max(0.0, nearest.back() - config_.trust);
    if (range >= config_.max_range) continue;
    readings.ranges[static_cast<std::size_t>(i)] = static_cast<float>(range);
    readings.points.push_back(range * ahead);
  }
  return readings;
}

bool leads_outward(const VirtualReadings& readings, const Twist& twist) {
  if (twist.linear == 0.0) return true;  // turning towards the way out is always possible
  return (twist.linear > 0.0 ? readings.outward.x : -readings.outward.x) > outward_at_least;
}

double time_to_hazard(const VirtualReadings& readings, const PointColumns& points, const Footprint& footprint,
                      const Twist& twist) {
  if (readings.clearance > footprint.inscribed()) return time_to_contact(footprint, points, twist);
  return leads_outward(readings, twist) ? no_contact : 0.0;
}

}  // namespace robot
