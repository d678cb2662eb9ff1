// The museum's visitors and how they move: social forces (Helbing, Farkas and Vicsek 2000) between people, walls and
// the robot, and above them what each of them is about: exhibits, their family, and the robot, which they follow,
// surround, block for fun, or avoid (RHINO and MINERVA met all of them).
#pragma once

#include <cstdint>
#include <vector>

#include "robot/body.hpp"
#include "robot/geometry/random.hpp"
#include "robot/museum.hpp"
#include "robot/outputs.hpp"
#include "robot/simulation/person.hpp"
#include "robot/simulation/routes.hpp"
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
  Crowd(const Museum& museum, int count, Random random);

  // One step of dt seconds (0.025 is what the forces are tuned for; never above 0.033).
  void step(double dt, const RobotSeen& robot);
  // What the robot says is heard by those near it.
  void hear(Cue cue, const RobotSeen& robot);

  const std::vector<Person>& people() const { return people_; }
  std::vector<Person>& people() { return people_; }
  const Walls& walls() const { return walls_; }
  const Routes& routes() const { return routes_; }

 private:
  // What is on a person's mind.
  struct Mind {
    int destination = 0;
    Point spot;                // where to stand in the end
    double pace = 1.2;         // m/s when walking
    double until = 0.0;        // s, of the crowd's time: when the present doing ends
    double interest_from = 0;  // s: before this the robot is of no interest
    double aside_until = 0.0;  // s: stepping out of the robot's way
    Point aside;               // and to there
    double patience = 5.0;     // s of standing in the robot's way before noticing it
    double blocked_for = 0.0;  // s that the robot has waited in front of this person
    double bearing = 0.0;      // rad: own place behind or around the robot
    bool distracted = false;   // looks at a phone: does not see the robot
    int family = -1;           // index of the person it walks with
    Point wanted;              // m/s, desired velocity
    double gaze = 0.0;         // rad, where to look when standing
  };

  // crowd.cpp
  void enter(std::size_t i, Point where);
  void move(std::size_t i, Point push, double dt, const RobotSeen& robot);
  // crowd_minds.cpp
  void think(std::size_t i, double dt, const RobotSeen& robot);
  void choose_exhibit(std::size_t i);
  void stroll(std::size_t i);
  bool sees(Point from, Point to) const;
  void look_at_exhibit(std::size_t i);
  void finish(std::size_t i);
  void notice_robot(std::size_t i, double dt, const RobotSeen& robot);
  void attend_robot(std::size_t i, double dt, const RobotSeen& robot);
  void step_aside(std::size_t i, const RobotSeen& robot);
  void make_room(std::size_t i, double dt, const RobotSeen& robot);
  void go(std::size_t i, Point target, double pace, double arrive);
  // crowd_forces.cpp
  void sort_into_cells();
  Point push(std::size_t i, const RobotSeen& robot) const;
  Point push_of_people(std::size_t i) const;
  Point push_of_walls(const Person& person) const;
  Point push_of_robot(std::size_t i, const RobotSeen& robot) const;

  Museum museum_;
  Walls walls_;  // of the walkable map
  Routes routes_;
  Random random_;
  double now_ = 0.0;  // s
  std::int64_t steps_ = 0;
  std::vector<Person> people_;
  std::vector<Mind> minds_;
  std::vector<Point> pushes_;
  // Counting sort into cells: people of cell k are order_[start_[k] .. start_[k + 1]).
  int columns_ = 0, rows_ = 0;
  std::vector<int> start_, order_, cell_of_;
};

}  // namespace robot::simulation
