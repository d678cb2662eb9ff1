#include "robot/simulation/crowd.hpp"

#include <algorithm>
#include <cmath>

#include "robot/simulation/contacts.hpp"

namespace robot::simulation {
namespace {

constexpr double margin = 0.08;     // m that attentive people keep from the robot, whatever pushes them
constexpr double wall_core = 0.12;  // m from walls that nobody is pushed below
constexpr double max_speed = 2.6;   // m/s
constexpr int think_every = 8;      // steps; each step another eighth of the people thinks

Temper draw_temper(Random& random) {
  const double dice = random.uniform();
  return dice < 0.5    ? Temper::regular
         : dice < 0.66 ? Temper::impassive
         : dice < 0.92 ? Temper::curious
                       : Temper::scared;
}

double turn_towards(double heading, double wanted, double most) {
  const double off = wanted - heading;
  if (std::abs(off) <= most) return wanted;
  return wrap_angle(heading + std::clamp(wrap_angle(off), -most, most));
}

}  // namespace

Crowd::Crowd(const Museum& museum, int count, Random random)
    : museum_(museum), walls_(walkable_map(museum)), routes_(museum, walls_), random_(random) {
  const auto number = static_cast<std::size_t>(std::max(0, count));
  people_.resize(number);
  minds_.resize(number);
  pushes_.resize(number);
  for (std::size_t i = 0; i < number; ++i) {
    Point place = routes_.anywhere(random_);
    for (int tries = 0; tries < 50 && distance(place, museum.home.position()) < 2.0; ++tries) {
      place = routes_.anywhere(random_);
    }
    enter(i, place);
    if (random_.chance(0.5) && routes_.exhibits() > 0) {  // some have been here for a while
      people_[i].position = routes_.spot(minds_[i].destination, random_);
      if (distance(people_[i].position, museum.home.position()) < 2.0) people_[i].position = place;
      look_at_exhibit(i);
    }
  }
}

// A new visitor in this place of the list.
void Crowd::enter(std::size_t i, Point where) {
  Person& person = people_[i];
  Mind& mind = minds_[i];
  person = Person{};
  mind = Mind{};
  person.position = where;
  person.heading = random_.uniform(-pi, pi);
  person.look = static_cast<std::uint32_t>(random_.index(1u << 31));
  person.child = random_.chance(0.2);
  person.temper = draw_temper(random_);
  if (person.child && person.temper == Temper::impassive) person.temper = Temper::curious;
  person.height = person.child ? random_.uniform(1.05, 1.4) : random_.uniform(1.55, 1.92);
  person.radius = person.child ? 0.17 : random_.uniform(0.20, 0.23);
  person.stride = random_.uniform(-pi, pi);
  mind.pace = person.child ? random_.uniform(0.9, 1.4) : random_.uniform(0.7, 1.3);
  mind.patience = random_.uniform(2.0, 10.0);
  mind.distracted = !person.child && random_.chance(0.03);
  mind.interest_from = now_ + random_.uniform(0.0, 60.0);
  const bool has_family = i > 0 && minds_[i - 1].family < 0 ? random_.chance(0.45) : i > 0 && random_.chance(0.4);
  if (has_family) mind.family = minds_[i - 1].family >= 0 ? minds_[i - 1].family : static_cast<int>(i) - 1;
  choose_exhibit(i);
}

void Crowd::step(double dt, const RobotSeen& robot) {
  now_ += dt;
  sort_into_cells();
  for (std::size_t i = 0; i < people_.size(); ++i) {
    if (static_cast<std::int64_t>(i) % think_every == steps_ % think_every) think(i, think_every * dt, robot);
    pushes_[i] = push(i, robot);
  }
  for (std::size_t i = 0; i < people_.size(); ++i) move(i, pushes_[i], dt, robot);
  ++steps_;
}

// Semi-implicit Euler, then what nobody can do: walk into walls, or, seeing it, into the robot.
void Crowd::move(std::size_t i, Point acceleration, double dt, const RobotSeen& robot) {
  Person& person = people_[i];
  person.velocity = person.velocity + dt * acceleration;
  const double speed = length(person.velocity);
  if (speed > max_speed) person.velocity = (max_speed / speed) * person.velocity;
  Point next = person.position + dt * person.velocity;
  const double clearance = walls_.roomy(next, wall_core + 0.08) ? 1.0 : walls_.clearance(next);
  if (clearance < wall_core + 0.08 && clearance < walls_.clearance(person.position)) {
    const Point away = walls_.away(person.position);
    const double into = dot(person.velocity, away);
    if (into < 0.0) person.velocity = person.velocity - into * away;
    next = person.position + dt * person.velocity;
    if (walls_.clearance(next) < std::min(wall_core, walls_.clearance(person.position))) {
      next = person.position;
      person.velocity = {};
    }
  }
  if (!minds_[i].distracted && length(next - robot.pose.position()) < 1.5) {
    const Nearest touch = nearest_place(robot.footprint, robot.pose, next);
    if (touch.distance < person.radius + margin && touch.distance > 1e-6) {
      const Point away = (1.0 / touch.distance) * (next - touch.place);
      const double into = dot(person.velocity, away);
      if (into < 0.0) {
        person.velocity = person.velocity - into * away;
        next = person.position + dt * person.velocity;
        if (walls_.clearance(next) < wall_core) next = person.position;
      }
    }
  }
  person.position = next;
  const double walking = length(person.velocity);
  person.heading = turn_towards(person.heading, minds_[i].gaze, 4.0 * dt);
  if (walking > 0.05) person.stride += dt * (2.0 + 4.5 * walking);
  if (person.stride > pi) person.stride -= 2.0 * pi;
}

}  // namespace robot::simulation
