// A museum as the robot knows it: the map of what its sensors see, the hazards they do not see, exhibits and tours.
// All in the map frame, metres and radians.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "robot/geometry/grid.hpp"
#include "robot/geometry/pose.hpp"
#include "robot/time.hpp"

namespace robot {

// Texts by language code ("en", "de"); "en" is always there.
using Text = std::map<std::string, std::string>;

using Polygon = std::vector<Point>;  // closed implicitly, at least three corners

enum class HazardKind { glass, low_obstacle, staircase, escalator, keep_out };

// Something that must not be touched and that no sensor sees (RHINO 4.1.2, MINERVA 5.1).
struct Hazard {
  std::string id;
  HazardKind kind = HazardKind::keep_out;
  Polygon polygon;
  Text title;
};

// A place from which to look at an exhibit: the robot stands here, facing it.
struct Viewpoint {
  Pose pose;
};

struct Narration {
  Text text;             // what the robot says; captioned wherever it is seen
  std::string picture;   // file below the site's folder, or empty
  Seconds duration{20};  // how long the robot stays for it
};

struct Exhibit {
  std::string id;  // short, as in URLs: "beam-engine"
  int number = 0;  // the same on map, list and wall
  Text title;
  Text to;           // inside a sentence: "to the beam engine"; missing languages are made from the title
  Text about;        // inside a sentence: "about the beam engine"
  Text summary;      // one sentence
  Polygon outline;   // for drawing and for clicks
  std::string icon;  // name of a line drawing, or empty
  std::string picture;
  std::vector<Viewpoint> viewpoints;  // at least one; the nearest free one is taken
  std::vector<Narration> narrations;  // the first on arrival, the rest on "more"
};

struct Tour {
  std::string id;
  Text title;
  Text summary;
  std::vector<std::string> exhibits;  // ids, in order
};

// A room or area with a name, for the page's plan.
struct Area {
  Text title;
  Point label;
};

struct WallCamera {
  std::string id;
  Text title;
  Pose pose;                   // where it hangs and looks
  double height = 3.5;         // m
  double tilt = -0.45;         // rad, down is negative
  double field_of_view = 1.2;  // rad, horizontal
};

struct SpeedLimits {
  double open_mps = 0.7;       // visitors are in the museum (MINERVA 6.3)
  double web_only_mps = 1.63;  // the museum is closed
  double staff_mps = 0.5;
};

struct Museum {
  std::string id;
  Text title;
  OccupancyGrid map;            // visible to the laser
  std::vector<Hazard> hazards;  // invisible
  Polygon boundary;             // operational area; empty: the whole map
  std::vector<Exhibit> exhibits;
  std::vector<Tour> tours;
  std::vector<Area> areas;
  std::vector<WallCamera> cameras;
  Pose home;  // homing position when idle
  SpeedLimits speed;
  int visitors = 50;  // in the house at a usual hour; the simulation's default
};

const Exhibit* find_exhibit(const Museum& museum, const std::string& id);
const Tour* find_tour(const Museum& museum, const std::string& id);

}  // namespace robot
