// Pictures of the simulated museum: one ray a column over a field of heights, front to back (as in Wolfenstein and
// Comanche), then people, the robot and the exhibits' ornaments as figures with the same depths. Pure: the same museum,
// view and moment give the same picture; may be called from any thread.
#pragma once

#include <cstdint>
#include <vector>

#include "robot/museum.hpp"
#include "robot/simulation/person.hpp"
#include "robot/simulation/scene.hpp"

namespace robot::simulation {

struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  // rows from the top, 3 bytes a pixel
};

struct CameraView {
  Pose pose;                    // where it is and looks, map frame
  double height = 1.2;          // m
  double tilt = -0.08;          // rad, down is negative; verticals stay vertical, as with a shift lens
  double field_of_view = 1.15;  // rad, horizontal
  int width = 640;              // pixels
  int height_px = 360;
  bool robot = true;  // whether the robot itself is in the picture
};

// The robot's eyes; pan and tilt in rad, left and up positive.
CameraView onboard_view(const Pose& map_from_base, double pan = 0.0, double tilt = -0.06);
CameraView wall_view(const WallCamera& camera);

class Painter {
 public:
  explicit Painter(const Museum& museum) : scene_(museum) {}

  Image render(const CameraView& view, const Snapshot& moment) const;

 private:
  Scene scene_;
};

}  // namespace robot::simulation
