// Social forces, as accelerations of a person of unit mass.
#include <algorithm>
#include <cmath>

#include "robot/simulation/contacts.hpp"
#include "robot/simulation/crowd.hpp"

namespace robot::simulation {
namespace {

constexpr double cell_size = 1.2;                             // m, and how far people feel each other
constexpr double relaxation = 0.5;                            // s to the desired velocity
constexpr double people_strength = 2.2, people_reach = 0.28;  // m/s2, m
constexpr double behind_weight = 0.35;                        // of those whom one does not see
constexpr double body_stiffness = 60.0;                       // 1/s2, when bodies overlap
constexpr double wall_strength = 3.0, wall_reach = 0.12;      // m/s2, m
constexpr double look_ahead = 0.7;                            // s in which people foresee where the robot goes
constexpr double max_push = 8.0;                              // m/s2

Point limited(Point a, double most) {
  const double size = length(a);
  return size > most ? (most / size) * a : a;
}

}  // namespace

void Crowd::sort_into_cells() {
  const auto& cells = walls_.cells();
  columns_ = std::max(1, static_cast<int>(cells.width() * cells.resolution() / cell_size) + 1);
  rows_ = std::max(1, static_cast<int>(cells.height() * cells.resolution() / cell_size) + 1);
  start_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
  cell_of_.resize(people_.size());
  order_.resize(people_.size());
  for (std::size_t i = 0; i < people_.size(); ++i) {
    const Point p = people_[i].position - cells.origin();
    const int x = std::clamp(static_cast<int>(p.x / cell_size), 0, columns_ - 1);
    const int y = std::clamp(static_cast<int>(p.y / cell_size), 0, rows_ - 1);
    cell_of_[i] = y * columns_ + x;
    ++start_[static_cast<std::size_t>(cell_of_[i]) + 1];
  }
  for (std::size_t k = 1; k < start_.size(); ++k) start_[k] += start_[k - 1];
  std::vector<int>& next = order_;
  std::vector<int> filled(start_.begin(), start_.end() - 1);
  for (std::size_t i = 0; i < people_.size(); ++i) {
    next[static_cast<std::size_t>(filled[static_cast<std::size_t>(cell_of_[i])]++)] = static_cast<int>(i);
  }
}

Point Crowd::push(std::size_t i, const RobotSeen& robot) const {
  const Person& person = people_[i];
  const Point drive = (1.0 / relaxation) * (minds_[i].wanted - person.velocity);
  return limited(drive + push_of_people(i) + push_of_walls(person) + push_of_robot(i, robot), max_push);
}

Point Crowd::push_of_people(std::size_t i) const {
  const Person& person = people_[i];
  const int column = cell_of_[i] % columns_, row = cell_of_[i] / columns_;
  const Point ahead{std::cos(person.heading), std::sin(person.heading)};
  const bool walking = length(minds_[i].wanted) > 0.2;
  Point sum;
  for (int y = std::max(0, row - 1); y <= std::min(rows_ - 1, row + 1); ++y) {
    const auto first = static_cast<std::size_t>(y * columns_ + std::max(0, column - 1));
    const auto last = static_cast<std::size_t>(y * columns_ + std::min(columns_ - 1, column + 1));
    for (int k = start_[first]; k < start_[last + 1]; ++k) {
      const auto j = static_cast<std::size_t>(order_[static_cast<std::size_t>(k)]);
      if (j == i) continue;
      const Point apart = person.position - people_[j].position;
      const double squared = dot(apart, apart);
      if (squared > cell_size * cell_size) continue;
      const double d = std::max(1e-3, std::sqrt(squared)), touch = person.radius + people_[j].radius;
      const Point normal = (1.0 / d) * apart;
      const double cosine = -dot(normal, ahead);  // 1: straight ahead
      const double seen = behind_weight + (1.0 - behind_weight) * 0.5 * (1.0 + cosine);
      sum = sum + (people_strength * seen * std::exp((touch - d) / people_reach)) * normal;
      if (d < touch) sum = sum + (body_stiffness * (touch - d)) * normal;
      // Those who meet head-on pass on the right, as people do.
      if (walking && cosine > 0.7) sum = sum + (1.2 * seen * std::exp((touch - d) / 0.5)) * Point{ahead.y, -ahead.x};
    }
  }
  return sum;
}

Point Crowd::push_of_walls(const Person& person) const {
  if (walls_.roomy(person.position, person.radius + 5.0 * wall_reach)) return {};
  const double clearance = walls_.clearance(person.position);
  if (clearance > person.radius + 5.0 * wall_reach) return {};
  return (wall_strength * std::exp((person.radius - clearance) / wall_reach)) * walls_.away(person.position);
}

Point Crowd::push_of_robot(std::size_t i, const RobotSeen& robot) const {
  const Person& person = people_[i];
  const double near = length(person.position - robot.pose.position());
  if (near > 3.0 || minds_[i].distracted) return {};
  double strength = 4.0, reach = 0.25;
  if (person.doing == Doing::blocking || person.doing == Doing::crowding) strength = 2.0, reach = 0.10;
  if (person.doing == Doing::running) strength = 5.0, reach = 0.20;
  if (person.temper == Temper::scared) strength = 5.0, reach = 0.60;
  const auto from = [&](const Pose& pose, double weight) -> Point {
    const Nearest touch = nearest_place(robot.footprint, pose, person.position);
    const double d = touch.distance;
    const Point apart = d > 1e-6 ? person.position - touch.place : person.position - pose.position();
    const double far = std::max(1e-6, length(apart));
    return (weight * strength * std::exp((person.radius - d) / reach) / far) * apart;
  };
  const Point now = from(robot.pose, 1.0);
  if (std::abs(robot.twist.linear) < 0.05 && std::abs(robot.twist.angular) < 0.1) return now;
  if (person.doing == Doing::blocking && std::abs(robot.twist.angular) < 0.1) return now;
  return now + from(robot.pose * arc(robot.twist, look_ahead), 0.7);
}

}  // namespace robot::simulation
