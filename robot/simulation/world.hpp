// The simulated museum: a body with its sensors among walls and people. Wheel commands in, sensor events out, seeded
// and free of any clock: the same calls give the same events, bit for bit, however the time is cut into advance()
// calls.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "robot/body.hpp"
#include "robot/inputs.hpp"
#include "robot/museum.hpp"
#include "robot/outputs.hpp"
#include "robot/simulation/contacts.hpp"
#include "robot/simulation/crowd.hpp"
#include "robot/simulation/drive.hpp"
#include "robot/simulation/sensors.hpp"
#include "robot/simulation/walls.hpp"

namespace robot::simulation {

struct WorldConfig {
  int visitors = 100;
  std::optional<Pose> start{};    // map_from_base; none: the museum's home
  Seconds base_period{0.05};      // odometry, state, sonars
  Seconds laser_period{0.05};     // each laser; zero: no scans among the events, devices ask for them
  double battery_fraction = 1.0;  // at the start
  Seconds watchdog{2.0};          // the base stops when no command comes for this long
  DriveNoise drive{};
  SensorNoise sensors{};
};

class World {
 public:
  World(const Museum& museum, const Body& body, const WorldConfig& config, std::uint64_t seed);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  // ---- What the robot does.
  void command(const WheelCommand& command) { drive_to(command.twist); }
  void drive_to(Twist wanted);
  void enable_motors(bool on);
  void hear(const Speech& speech);

  // ---- Time. Returns what the sensors said up to `now`, oldest first; Input::now is the time of measurement.
  std::vector<Input> advance(Time now);
  Time now() const { return now_; }

  // ---- Devices on demand, as of now().
  LaserScan scan(LaserId laser);
  Odometry odometry() const;
  BaseState base() const;
  SonarScan sonars();
  void press_emergency_stop(bool pressed);

  // ---- Truth.
  Pose truth() const { return pose_; }
  Twist twist() const { return drive_.ground(); }
  const std::vector<Person>& people() const { return crowd_.people(); }
  const std::vector<Contact>& contacts() const { return contacts_; }
  const Museum& museum() const { return museum_; }
  const Body& body() const { return body_; }
  Snapshot snapshot() const { return {now_, pose_, crowd_.people()}; }
  // Carries the robot elsewhere; its wheels do not notice.
  void place(const Pose& map_from_base);
  // The visitors, to set a scene by hand.
  std::vector<Person>& visitors() { return crowd_.people(); }

 private:
  void step();
  void move_body();
  void meet_people();
  void note(ContactKind kind, Point place, const std::string& with);
  void drain(double dt);
  void sense(std::vector<Input>& events);
  RobotSeen seen() const { return {pose_, drive_.ground(), body_.footprint}; }

  Museum museum_;
  Body body_;
  WorldConfig config_;
  Walls walls_;
  Hazards hazards_;
  Drive drive_;
  Sensors sensors_;
  Crowd crowd_;
  Time now_{};
  Pose pose_;
  std::int64_t steps_ = 0;
  Time next_base_{}, next_front_{}, next_rear_{};
  Time last_command_{};
  bool motors_ = false, emergency_stop_ = false, stalled_ = false;
  bool bumper_front_ = false, bumper_rear_ = false;
  double battery_;  // 0..1
  std::vector<Contact> contacts_;
  std::map<std::string, Time> touching_;  // by what: last moment of touch
  std::map<int, Time> cut_in_;            // person by index: stepped into the robot's stopping way
  std::vector<Point> places_before_;      // of the people, a crowd step ago
};

}  // namespace robot::simulation
