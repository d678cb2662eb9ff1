#include "robot/body.hpp"

#include <algorithm>
#include <cmath>

namespace robot {

double Footprint::circumscribed() const { return std::hypot(std::max(front, rear), half_width); }
double Footprint::inscribed() const { return std::min({front, rear, half_width}); }

Body standard_body() {
  Body body;
  body.lasers = {LaserMount{.base_from_laser = {0.22, 0.0, 0.0}}, LaserMount{.base_from_laser = {-0.22, 0.0, pi}}};
  constexpr int sonars = 24;
  constexpr double ring = 0.27;  // m
  for (int i = 0; i < sonars; ++i) {
    const double bearing = wrap_angle(2.0 * pi * i / sonars);
    body.sonars.push_back({.base_from_sonar = {ring * std::cos(bearing), ring * std::sin(bearing), bearing}});
  }
  return body;
}

}  // namespace robot
