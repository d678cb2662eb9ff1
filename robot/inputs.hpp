// Everything that can happen to the robot, as plain values: what sensors say, what people ask, the control tick,
// and what comes back from jobs and memory. Robot::handle takes nothing else.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "robot/geometry/pose.hpp"
#include "robot/time.hpp"

namespace robot {

// ---- Sensors -------------------------------------------------------------------------------------------------

enum class LaserId : std::uint8_t { front, rear };

// One sweep of a laser. Beam i points at angle_min + i * angle_step in the laser's frame; NaN: no return.
struct LaserScan {
  Time time;  // of the measurement
  LaserId laser = LaserId::front;
  double angle_min = 0.0;     // rad
  double angle_step = 0.0;    // rad
  float max_range = 0.0f;     // m
  std::vector<float> ranges;  // m
};

// Dead reckoning of the base: where the wheels say it is. The odom frame is smooth and drifts.
struct Odometry {
  Time time;
  Pose odom_from_base;
  Twist twist;  // measured by the wheels
};

struct SonarReading {
  int sonar = 0;
  float range = 0.0f;  // m; NaN: no echo
};

// The sonars that fired since the last report.
struct SonarScan {
  Time time;
  std::vector<SonarReading> readings;
};

struct BaseState {
  Time time;
  double battery_volts = 0.0;
  double battery_fraction = -1.0;  // 0..1; negative: the gauge is absent
  bool motors_enabled = false;
  bool emergency_stop = false;
  bool stalled = false;
  bool bumper_front = false;
  bool bumper_rear = false;
};

enum class Device : std::uint8_t { base, laser_front, laser_rear };

// A serial line was lost or came back.
struct DeviceState {
  Device device = Device::base;
  bool connected = false;
  std::string reason;  // why not, in words for staff
};

// ---- People --------------------------------------------------------------------------------------------------

enum class Channel : std::uint8_t { web, kiosk, console, program };

// Who asks. The server has checked the name's length and characters and what this person may do.
struct Requester {
  std::string name;
  Channel channel = Channel::web;
  std::string session;  // opaque; the same person's requests share it
};

using RequestId = std::uint64_t;
using Ticket = std::uint64_t;  // chosen by the caller; the answer carries it back

struct ExhibitTarget {
  std::string exhibit;
  std::optional<int> viewpoint;  // index; none: the nearest one that is free
};
struct PointTarget {
  Point point;                  // map frame
  std::optional<double> theta;  // heading wanted on arrival
};
using Target = std::variant<ExhibitTarget, PointTarget>;

struct RequestVisit {
  Ticket ticket = 0;
  Requester requester;
  Target target;
};
struct CancelRequest {
  Ticket ticket = 0;
  RequestId id = 0;
  std::string session;  // must be the requester's own, unless staff
  bool staff = false;
};
struct StartTour {
  Ticket ticket = 0;
  Requester requester;
  std::string tour;
};
enum class TourAnswer : std::uint8_t { more, move_on, end_tour };
// At an exhibit, someone at the touch-screen (or the web) wants more, or wants to go on.
struct AnswerTour {
  Ticket ticket = 0;
  TourAnswer answer = TourAnswer::move_on;
};

// The red button on any screen. Answered inside the same call; stays until Resume.
struct Stop {
  std::string who;
};
struct Resume {
  std::string who;
};

enum class Mode : std::uint8_t { open, web_only, staff };  // museum open / closed and web decides / staff
struct SetMode {
  Mode mode = Mode::open;
};
// Staff say where it is, or that nobody knows.
struct SetPose {
  Pose map_from_base;
};
struct LocalizeGlobally {};

// ---- Time and memory -----------------------------------------------------------------------------------------

// The control tick, 20 Hz.
struct Tick {};

// Requests that were accepted before a restart and are still open, oldest first.
struct RememberedRequest {
  RequestId id = 0;
  Requester requester;
  Target target;
};
struct Remember {
  RequestId next_id = 1;
  std::vector<RememberedRequest> open;
};

using Event = std::variant<Tick, LaserScan, Odometry, SonarScan, BaseState, DeviceState, RequestVisit, CancelRequest,
                           StartTour, AnswerTour, Stop, Resume, SetMode, SetPose, LocalizeGlobally, Remember>;

// What happened, and when the robot heard of it. Times never run backwards from one input to the next.
struct Input {
  Time now;
  Event event;
};

}  // namespace robot
