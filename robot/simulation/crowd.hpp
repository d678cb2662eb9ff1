// The museum's visitors and how they move: social forces (Helbing, Farkas and Vicsek 2000) between people, walls and
// the robot, and above them what each of them is about.
#pragma once

#include <vector>

#include "robot/body.hpp"
#include "robot/geometry/random.hpp"
#include "robot/museum.hpp"
#include "robot/outputs.hpp"
#include "robot/simulation/person.hpp"
#include "robot/simulation/walls.hpp"

namespace robot::simulation {

// The robot as people see it.
struct RobotSeen {
  Pose pose;    // map_from_base
  Twist twist;  // over the ground
  Footprint footprint;
};

class Crowd {
 public:
  Crowd(const Museum& museum, const Walls& walls, int count, Random random);

  void step(double dt, const RobotSeen& robot);
  // What the robot says is heard by those near it.
  void hear(Cue cue, const RobotSeen& robot);

  const std::vector<Person>& people() const { return people_; }
  std::vector<Person>& people() { return people_; }

 private:
  const Walls* walls_;
  Random random_;
  std::vector<Person> people_;
};

}  // namespace robot::simulation
