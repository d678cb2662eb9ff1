// Virtual sensors for what no sensor sees (RHINO 4.1.2 eqs. 21-24, MINERVA 5.1 eqs. 14-15): from the belief about where
// the robot is, range readings to the nearest hazard which, with 99 % likelihood, are shorter than the true distance.
#pragma once

#include <span>
#include <vector>

#include "robot/geometry/grid.hpp"
#include "robot/geometry/pose.hpp"
#include "robot/motion/arc_collision.hpp"
#include "robot/museum.hpp"

namespace robot {

struct VirtualSensorsConfig {
  int directions = 120;      // over the full turn
  double max_range = 2.5;    // m; farther hazards give no reading
  double likelihood = 0.99;  // that a reading underestimates the distance
  double trust = 0.02;       // m added to the map's own inaccuracy: readings are shortened by it
};

// One look of all virtual sensors, base frame.
struct VirtualReadings {
  std::vector<float> ranges;  // m from the base's origin, one a direction from 0 counter-clockwise; max_range: nothing
  std::vector<Point> points;  // the ends of those that met something
  double clearance = 1e9;     // m from the base's origin to the nearest hazard, 99 %; negative: may be inside
  Point outward;              // unit vector away from the nearest hazard; zero when none is near
};

class VirtualSensors {
 public:
  // Hazards and the outside of the boundary are kept as a signed distance field on the map's grid.
  explicit VirtualSensors(const Museum& museum, const VirtualSensorsConfig& config = {});

  // samples: equally weighted poses of the base in the map; none: nothing is known, and nothing is read.
  VirtualReadings read(std::span<const Pose> samples) const;
  bool has_hazards() const { return has_hazards_; }
  // Metres to the nearest hazard, negative inside.
  double signed_distance(Point point) const;

 private:
  double cast(Point from, Point direction, double limit) const;

  VirtualSensorsConfig config_;
  Grid<float> distance_;
  bool has_hazards_ = false;
};

// Does a motion lead out of a hazard that the robot is in, or turn on the spot?
bool leads_outward(const VirtualReadings& readings, const Twist& twist);

// Seconds until a constant twist brings the footprint onto a hazard (see time_to_contact; points are the readings'
// own). When the base's centre is nearer to a hazard than the footprint is wide, or inside, only turning and outward
// motion are admissible: a hazard stops the robot but never traps it.
double time_to_hazard(const VirtualReadings& readings, const PointColumns& points, const Footprint& footprint,
                      const Twist& twist);

}  // namespace robot
