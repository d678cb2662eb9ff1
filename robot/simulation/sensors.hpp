// What the range sensors of a body say in the simulated museum. Lasers see the map's walls and people's legs; sonars
// also hear glass. Neither notices low plates, stairs or ropes.
#pragma once

#include <span>
#include <vector>

#include "robot/body.hpp"
#include "robot/geometry/random.hpp"
#include "robot/inputs.hpp"
#include "robot/museum.hpp"
#include "robot/simulation/person.hpp"
#include "robot/simulation/walls.hpp"

namespace robot::simulation {

struct SensorNoise {
  double laser_sigma = 0.01;     // m
  double laser_dropout = 0.002;  // share of beams without return (black cloth, chrome)
  double sonar_sigma = 0.015;    // share of the range
  double sonar_dropout = 0.03;   // share of echoes lost
  double sonar_specular = 0.6;   // rad from the normal beyond which a wall throws the echo away
  double laser_bias = 0.008;     // m, of each laser, drawn once
  double laser_turn = 0.003;     // rad, by which each laser sits askew, drawn once
};

class Sensors {
 public:
  Sensors(const Museum& museum, Body body, const SensorNoise& noise, Random random);

  // Beam by beam: the nearest of wall and legs, with noise; NaN beyond the laser's range. The laser must exist.
  LaserScan scan(LaserId laser, const Walls& walls, std::span<const Person> people, const Pose& map_from_base,
                 Time now);
  // The sonars of one firing group: every eighth, so that neighbours do not hear each other.
  SonarScan sonars(const Walls& walls, std::span<const Person> people, const Pose& map_from_base, Time now);

 private:
  double echo(const SonarMount& mount, const Walls& walls, std::span<const Person> people,
              const Pose& map_from_sonar) const;

  struct Direction {
    double cosine, sine;
  };
  struct Edge {
    Point a, b;
  };
  Body body_;
  SensorNoise noise_;
  Random laser_random_, sonar_random_;
  std::vector<std::vector<Direction>> beams_;  // a laser, in its own frame
  std::vector<double> bias_;                   // m, a laser
  std::vector<Edge> glass_;
  int group_ = 0;
};

}  // namespace robot::simulation
