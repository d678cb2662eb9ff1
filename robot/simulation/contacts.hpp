// Where the robot touches something, and whose fault it is.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "robot/body.hpp"
#include "robot/museum.hpp"
#include "robot/simulation/person.hpp"
#include "robot/simulation/walls.hpp"
#include "robot/time.hpp"

namespace robot::simulation {

enum class ContactKind : std::uint8_t { fixed, hazard, person_robot_fault, person_own_fault };

// Beginning of a touch.
struct Contact {
  Time time;
  ContactKind kind = ContactKind::fixed;
  Point place;       // map frame
  Pose robot;        // map_from_base
  Twist twist;       // of the body over the ground
  std::string with;  // "map", a hazard's id, "boundary", "person 17"
};

// The footprint's corners in the map frame, counter-clockwise from the front left.
Polygon corners(const Footprint& footprint, const Pose& map_from_base);

// The place of the footprint that is nearest to a point of the map, and how far off it is (0 inside).
struct Nearest {
  Point place;      // map frame
  double distance;  // m
};
Nearest nearest_place(const Footprint& footprint, const Pose& map_from_base, Point point);

// A cell of the map under the footprint: where, or nothing.
std::optional<Point> touched_wall(const Footprint& footprint, const Pose& map_from_base, const Walls& walls);

// Whether the footprint overlaps a polygon.
bool overlaps(const Footprint& footprint, const Pose& map_from_base, const Polygon& polygon);

// A hazard touched, or left the operational area.
struct TouchedHazard {
  std::string id;
  Point place;
  bool solid;  // it holds the body: glass, plates
};
class Hazards {
 public:
  explicit Hazards(const Museum& museum);
  std::optional<TouchedHazard> touched(const Footprint& footprint, const Pose& map_from_base) const;

 private:
  struct Area {
    Hazard hazard;
    Point low, high;  // corners of the box round it
  };
  std::vector<Area> areas_;
  Polygon boundary_;
};

// Fault of the robot: its body moved towards the person at the place of contact, faster than 2 cm/s and not slower than
// the person towards it.
bool robot_at_fault(const Footprint& footprint, const Pose& map_from_base, Twist ground, const Person& person,
                    Point velocity);

// Whether the robot, braking with `deceleration` after `reaction` seconds, still touches a person who stands at a
// place: inevitable whatever it does from now on (on its present arc).
bool inevitable(const Footprint& footprint, const Pose& map_from_base, Twist ground, double deceleration,
                double reaction, Point place, double radius);

}  // namespace robot::simulation
