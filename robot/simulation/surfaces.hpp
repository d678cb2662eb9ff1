// What the museum's floor, ceiling, walls and exhibits look like from near: tiles, wainscot, arched windows, plinths.
// The palette is the product's: chalk, lime, green iron, warm light.
#pragma once

#include "robot/simulation/scene.hpp"

namespace robot::simulation {

Color floor_color(const Scene& scene, const SceneCell& ground, Point p, double depth);
Color top_color(const Scene& scene, const SceneCell& cell, Point p);
Color ceiling_color(Point p, double depth);

// One vertical line of a side: everything that does not change with the height is worked out once.
class SidePainter {
 public:
  // metres: of the place that one pixel covers.
  SidePainter(const Scene& scene, const SceneCell& cell, Point p, double metres);
  Color color(double z) const;

 private:
  Color wall(double z) const;
  Color window(double z, Color chalk) const;

  Material material_;
  Color base_;
  float light_;
  double along_;  // m along the wall
  double metres_;
  double height_;
};

}  // namespace robot::simulation
