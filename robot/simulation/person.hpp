// A visitor as the world knows one: where, how fast, what for, and what a laser or a camera sees of the body.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "robot/geometry/pose.hpp"
#include "robot/time.hpp"

namespace robot::simulation {

enum class Doing : std::uint8_t {
  strolling,  // to an exhibit
  looking,    // standing at it
  following,  // walking behind the robot
  crowding,   // standing in the ring round the robot
  blocking,   // standing in its way on purpose
  running,    // children at play
  leaving,    // to the entrance
};

enum class Temper : std::uint8_t { regular, impassive, curious, scared };

struct Person {
  Point position;          // map frame
  Point velocity;          // m/s
  double heading = 0.0;    // rad, where the body faces
  double radius = 0.22;    // m, of the torso seen from above
  double height = 1.72;    // m
  double stride = 0.0;     // rad, phase of the gait
  std::uint32_t look = 0;  // picks clothes and hair
  bool child = false;
  Doing doing = Doing::strolling;
  Temper temper = Temper::regular;
};

// Cheaper than norm(), for the thousands a tick; nothing here is near overflow.
inline double length(Point a) { return std::sqrt(dot(a, a)); }

inline constexpr double leg_radius = 0.065;  // m, at the laser's height

// Where the two legs are at a laser's height: side by side when standing, fore and aft in a stride.
inline std::array<Point, 2> legs(const Person& person) {
  const double c = std::cos(person.heading), s = std::sin(person.heading);
  const double reach = std::min(0.28, 0.22 * length(person.velocity)) * std::sin(person.stride);
  const double half = person.child ? 0.07 : 0.10;
  return {person.position + Point{c * reach - s * half, s * reach + c * half},
          person.position + Point{-c * reach + s * half, -s * reach - c * half}};
}

// What can be seen at a moment, by value: pictures are made of it, on any thread.
struct Snapshot {
  Time time;
  Pose robot;  // map_from_base
  std::vector<Person> people;
};

}  // namespace robot::simulation
