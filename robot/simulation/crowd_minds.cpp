// What people are about. A mind is asked five times a second; between that, forces move the body.
#include <algorithm>
#include <cmath>

#include "robot/simulation/contacts.hpp"
#include "robot/simulation/crowd.hpp"

namespace robot::simulation {
namespace {

constexpr double notice_within = 9.0;   // m from which the robot catches the eye
constexpr double ear_shot = 4.0;        // m
constexpr double in_the_way = 0.9;      // m before the footprint
constexpr double lose_interest = 11.0;  // m

double exponential(Random& random, double mean) { return -mean * std::log(1.0 - random.uniform()); }

// Bearing of a place as the robot sees it, rad.
double bearing_from(const RobotSeen& robot, Point place) {
  const Point local = inverse(robot.pose) * place;
  return std::atan2(local.y, local.x);
}

bool moving(const RobotSeen& robot) {
  return std::abs(robot.twist.linear) > 0.08 || std::abs(robot.twist.angular) > 0.25;
}

bool with_robot(Doing doing) {
  return doing == Doing::following || doing == Doing::crowding || doing == Doing::blocking;
}

}  // namespace

void Crowd::think(std::size_t i, double dt, const RobotSeen& robot) {
  Person& person = people_[i];
  Mind& mind = minds_[i];
  if (length(person.velocity) > 0.25) mind.gaze = std::atan2(person.velocity.y, person.velocity.x);
  if (mind.distracted && random_.chance(0.05 * dt)) mind.distracted = false;
  if (now_ < mind.aside_until) return go(i, mind.aside, 1.0, 0.2);
  make_room(i, dt, robot);
  if (now_ < mind.aside_until) return;
  if (with_robot(person.doing)) return attend_robot(i, dt, robot);
  notice_robot(i, dt, robot);
  switch (person.doing) {
    case Doing::looking:
      mind.wanted = {};
      if (now_ > mind.until) finish(i);
      break;
    case Doing::running:
      go(i, mind.spot, 2.1, 0.5);
      if (length(person.position - mind.spot) < 0.8) {
        const double angle = random_.uniform(-pi, pi), far = random_.uniform(3.0, 8.0);
        const Point next = person.position + far * Point{std::cos(angle), std::sin(angle)};
        if (routes_.passable(next)) mind.spot = next;
      }
      if (now_ > mind.until) choose_exhibit(i);
      break;
    default:
      stroll(i);
  }
}

void Crowd::choose_exhibit(std::size_t i) {
  Person& person = people_[i];
  Mind& mind = minds_[i];
  person.doing = Doing::strolling;
  const int count = routes_.exhibits();
  if (count == 0) {
    mind.destination = routes_.entrance();
    mind.spot = routes_.anywhere(random_);
    return;
  }
  if (mind.family >= 0 && minds_[static_cast<std::size_t>(mind.family)].destination < count) {
    mind.destination = minds_[static_cast<std::size_t>(mind.family)].destination;
  } else {
    // The nearer of two, mostly: people wander on to what stands next.
    const auto draw = [&] { return static_cast<int>(random_.index(static_cast<std::uint64_t>(count))); };
    const int a = draw(), b = draw();
    mind.destination = routes_.way(a, person.position) < routes_.way(b, person.position) ? a : b;
  }
  mind.spot = routes_.spot(mind.destination, random_);
  mind.until = now_ + 240.0;
}

void Crowd::stroll(std::size_t i) {
  Person& person = people_[i];
  Mind& mind = minds_[i];
  double left = length(mind.spot - person.position);
  const bool there = routes_.way(mind.destination, person.position) < 0.1;
  const bool in_sight = left < 6.0 && sees(person.position, mind.spot);
  if (there && !in_sight) {  // round a corner, or through glass: another place will do
    mind.spot = routes_.spot(mind.destination, random_);
    if (length(mind.spot - person.position) > 3.0 || !sees(person.position, mind.spot)) mind.spot = person.position;
    left = length(mind.spot - person.position);
  }
  mind.wanted = mind.pace * routes_.direction(mind.destination, person.position);
  if (there || (in_sight && left < 2.0)) go(i, mind.spot, mind.pace, 0.5);
  if (left > 0.5 && now_ < mind.until) return;
  if (person.doing == Doing::leaving) return enter(i, routes_.spot(routes_.entrance(), random_));
  look_at_exhibit(i);
}

bool Crowd::sees(Point from, Point to) const {
  const double d = length(to - from);
  return d < 1e-6 || walls_.ray(from, (1.0 / d) * (to - from), d) >= d - 0.05;
}

void Crowd::look_at_exhibit(std::size_t i) {
  Person& person = people_[i];
  Mind& mind = minds_[i];
  person.doing = Doing::looking;
  mind.wanted = {};
  mind.until = now_ + 6.0 + exponential(random_, 25.0);
  if (mind.destination >= routes_.exhibits()) return;
  Point middle;
  const auto& outline = museum_.exhibits[static_cast<std::size_t>(mind.destination)].outline;
  for (const Point p : outline) middle = middle + (1.0 / static_cast<double>(outline.size())) * p;
  mind.gaze = std::atan2(middle.y - person.position.y, middle.x - person.position.x);
}

// After an exhibit: the next one, a run, or home.
void Crowd::finish(std::size_t i) {
  Person& person = people_[i];
  Mind& mind = minds_[i];
  if (person.child && random_.chance(0.35)) {
    person.doing = Doing::running;
    mind.spot = person.position;
    mind.until = now_ + random_.uniform(8.0, 20.0);
  } else if (random_.chance(0.08)) {
    person.doing = Doing::leaving;
    mind.destination = routes_.entrance();
    mind.spot = routes_.spot(mind.destination, random_);
    mind.until = now_ + 240.0;
  } else {
    choose_exhibit(i);
  }
}

void Crowd::notice_robot(std::size_t i, double dt, const RobotSeen& robot) {
  Person& person = people_[i];
  Mind& mind = minds_[i];
  const double d = length(person.position - robot.pose.position());
  if (d > notice_within || now_ < mind.interest_from || mind.distracted || person.doing == Doing::leaving) return;
  const double a_second = person.temper == Temper::curious ? 0.3 : person.temper == Temper::regular ? 0.08 : 0.0;
  if (!random_.chance(a_second * dt)) return;
  if (!sees(person.position, robot.pose.position())) return;
  person.doing = moving(robot) ? Doing::following : Doing::crowding;
  mind.bearing = bearing_from(robot, person.position);
  mind.until = now_ + 15.0 + exponential(random_, person.temper == Temper::curious ? 90.0 : 40.0);
}

void Crowd::attend_robot(std::size_t i, double dt, const RobotSeen& robot) {
  Person& person = people_[i];
  Mind& mind = minds_[i];
  const Point to = robot.pose.position() - person.position;
  const double d = length(to);
  mind.gaze = std::atan2(to.y, to.x);
  if (now_ > mind.until || d > lose_interest) {
    mind.interest_from = now_ + 30.0 + exponential(random_, 60.0);
    return choose_exhibit(i);
  }
  const double bearing = bearing_from(robot, person.position);
  const double gap = nearest_place(robot.footprint, robot.pose, person.position).distance;
  if (person.doing == Doing::blocking) {
    // Round the robot, not through it.
    const Point local = inverse(robot.pose) * person.position;
    const bool beside = local.x < robot.footprint.front + 0.2;
    const double side = local.y >= 0.0 ? 0.85 : -0.85;
    return go(i, robot.pose * Point{robot.footprint.front + (beside ? 0.4 : 0.75), beside ? side : 0.0}, 1.5, 0.3);
  }
  // What happens when one steps before it? Children run round it for that, others need to be there already.
  const bool may_block =
      person.temper == Temper::curious && robot.twist.linear > 0.1 && (person.child || std::abs(bearing) < 0.8);
  if (may_block && gap < 3.0 && random_.chance((person.child ? 0.04 : 0.06) * dt)) {
    person.doing = Doing::blocking;
    mind.until = std::min(mind.until, now_ + 4.0 + exponential(random_, 8.0));
    return;
  }
  if (moving(robot)) {
    person.doing = Doing::following;
    // Own place in the tail, to the side where one is already.
    const double side = bearing >= 0.0 ? 1.0 : -1.0;
    const double tail = side * std::clamp(std::abs(mind.bearing), radians(110), radians(165));
    const double off = person.child ? 1.1 : 1.4;
    go(i, robot.pose * (off * Point{std::cos(tail), std::sin(tail)}), mind.pace + 0.3, 1.0);
  } else {
    // The ring: near enough to see, in the bearing where one stands.
    person.doing = Doing::crowding;
    const double ring = person.child ? 0.45 : 0.75;
    if (gap > ring + 0.25) {
      mind.wanted = (std::min(mind.pace, gap - ring) / std::max(d, 1e-6)) * to;
    } else {
      mind.wanted = {};
    }
  }
}

// Someone who stands where the robot wants to go, and has seen that, gives way in the end.
void Crowd::make_room(std::size_t i, double dt, const RobotSeen& robot) {
  const Person& person = people_[i];
  Mind& mind = minds_[i];
  const double gap = nearest_place(robot.footprint, robot.pose, person.position).distance;
  const bool before_it = gap < in_the_way && std::abs(bearing_from(robot, person.position)) < 0.7;
  if (!before_it || length(person.velocity) > 0.6) {
    mind.blocked_for = std::max(0.0, mind.blocked_for - dt);
    return;
  }
  mind.blocked_for += dt;
  // The ring round a standing robot has no reason to open: it is told to, by the robot's voice.
  const double patience = person.doing == Doing::blocking                     ? 4.0 * mind.patience
                          : person.doing == Doing::crowding && !moving(robot) ? 6.0 * mind.patience
                                                                              : mind.patience;
  if (mind.blocked_for > patience) step_aside(i, robot);
}

// Two steps out of the robot's way, to the nearer side where there is room.
void Crowd::step_aside(std::size_t i, const RobotSeen& robot) {
  Person& person = people_[i];
  Mind& mind = minds_[i];
  const Point local = inverse(robot.pose) * person.position;
  const double side = local.y >= 0.0 ? 1.0 : -1.0;
  mind.aside = person.position;
  const double lane = robot.footprint.half_width + 0.75;
  for (const Point aside : {Point{local.x, side * lane}, Point{local.x, -side * lane},
                            Point{local.x + 2.0, side * lane}, Point{local.x + 2.5, 0.0}}) {
    const Point place = robot.pose * aside;
    if (walls_.clearance(place) < 0.25) continue;
    mind.aside = place;
    break;
  }
  mind.aside_until = now_ + random_.uniform(2.0, 4.0);
  mind.blocked_for = 0.0;
  mind.distracted = false;
  if (person.doing == Doing::blocking) {
    person.doing = Doing::following;
    mind.interest_from = now_ + 20.0;
  }
  go(i, mind.aside, 1.0, 0.2);
}

void Crowd::hear(Cue cue, const RobotSeen& robot) {
  const bool asks = cue == Cue::make_way || cue == Cue::horn;
  for (std::size_t i = 0; i < people_.size(); ++i) {
    Person& person = people_[i];
    Mind& mind = minds_[i];
    const double d = length(person.position - robot.pose.position());
    if (d > (asks ? ear_shot : notice_within)) continue;
    mind.distracted = false;
    if (asks) {
      const double gap = nearest_place(robot.footprint, robot.pose, person.position).distance;
      if (gap > 2.0 || std::abs(bearing_from(robot, person.position)) > radians(70)) continue;
      double obeys = person.doing == Doing::blocking ? 0.45 : person.child ? 0.6 : 0.8;
      if (cue == Cue::horn) obeys = 0.5 * (1.0 + obeys);
      if (random_.chance(obeys)) step_aside(i, robot);
    } else if (cue == Cue::narration || cue == Cue::greeting) {
      const bool listens =
          person.temper == Temper::curious || (person.temper == Temper::regular && random_.chance(0.3));
      if (!listens || with_robot(person.doing) || person.doing == Doing::leaving || now_ < mind.interest_from) continue;
      person.doing = Doing::crowding;
      mind.until = now_ + 10.0 + exponential(random_, 30.0);
    }
  }
}

// Towards a place, slowing down within `arrive` metres of it.
void Crowd::go(std::size_t i, Point target, double pace, double arrive) {
  const Point to = target - people_[i].position;
  const double d = length(to);
  minds_[i].wanted = d < 0.1 ? Point{} : (pace * std::min(1.0, d / arrive) / d) * to;
}

}  // namespace robot::simulation
