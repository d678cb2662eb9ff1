#include "robot/simulation/crowd.hpp"

#include <cmath>

#include "robot/simulation/contacts.hpp"

namespace robot::simulation {

Crowd::Crowd(const Museum& museum, const Walls& walls, int count, Random random) : walls_(&walls), random_(random) {
  const auto& map = museum.map;
  for (int tries = 0; static_cast<int>(people_.size()) < count && tries < 1000 * count; ++tries) {
    const Point p{map.origin().x + random_.uniform() * map.width() * map.resolution(),
                  map.origin().y + random_.uniform() * map.height() * map.resolution()};
    if (!is_free(map.at_or(map.cell(p), unknown_cell)) || walls.clearance(p) < 0.4) continue;
    if (distance(p, museum.home.position()) < 1.5) continue;
    Person person;
    person.position = p;
    person.heading = random_.uniform(-pi, pi);
    person.look = static_cast<std::uint32_t>(random_.index(1u << 31));
    people_.push_back(person);
  }
}

void Crowd::step(double dt, const RobotSeen& robot) {
  for (auto& person : people_) {
    const Point next = person.position + (0.8 * dt) * Point{std::cos(person.heading), std::sin(person.heading)};
    if (walls_->clearance(next) < 0.3 || nearest_place(robot.footprint, robot.pose, next).distance < 0.35) {
      person.heading = random_.uniform(-pi, pi);
      person.velocity = {};
      continue;
    }
    person.velocity = (1.0 / dt) * (next - person.position);
    person.position = next;
    person.stride = wrap_angle(person.stride + 6.0 * dt);
  }
}

void Crowd::hear(Cue, const RobotSeen&) {}

}  // namespace robot::simulation
