// Everything the robot says, as plain values. The server turns them into wheel bytes, web messages and rows.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "robot/inputs.hpp"
#include "robot/museum.hpp"

namespace robot {

// ---- To the base ---------------------------------------------------------------------------------------------

enum class GateReason : std::uint8_t {
  none,             // the command passed as it was wanted
  slowed,           // limited by speed limits, obstacles or hazards
  stopped_by_hand,  // Stop was pressed
  obstacle,
  hazard,
  bumper,
  emergency_stop,
  sensor_stale,
  base_lost,
  pose_unknown,  // hazards are near and the robot does not know well enough where it is
  motors_off,
};

// The only thing that moves the wheels: what the safety gate let through.
struct WheelCommand {
  Twist twist;
  GateReason reason = GateReason::none;
};
struct EnableMotors {
  bool on = true;
};

// ---- State: the newest value replaces the older ---------------------------------------------------------------

struct PoseEstimate {
  Time time;
  Pose map_from_base;
  double sigma_position = 0.0;  // m, one standard deviation (larger axis)
  double sigma_theta = 0.0;     // rad
  int particles = 0;
  bool localized = false;  // false: still searching, or lost
  Twist twist;             // measured
};

// A thinned picture of the belief, for the console.
struct Belief {
  Time time;
  std::vector<Pose> samples;  // at most 200, equally weighted
};

enum class BeamKind : std::uint8_t { no_return, map, person, unexpected_far };
// The scan as the localizer understood it: which beams met the map and which met people.
struct ScanView {
  Time time;
  LaserId laser = LaserId::front;
  Pose map_from_laser;
  double angle_min = 0.0;       // rad
  double angle_step = 0.0;      // rad
  std::vector<float> ranges;    // m, NaN: no return
  std::vector<BeamKind> kinds;  // one a beam
};

struct PersonSeen {
  Point position;  // map frame
  Point velocity;  // m/s, map frame; about zero while standing or just seen
  int id = 0;      // the same person keeps it while being tracked
};
struct People {
  Time time;
  std::vector<PersonSeen> people;
};

struct Path {
  std::vector<Point> points;  // map frame, from the robot to the goal; empty: no goal
  double length = 0.0;        // m
};

enum class Activity : std::uint8_t {
  starting,    // waiting for sensors
  localizing,  // looking where it is
  idle,        // standing at its homing position
  homing,      // going there
  driving,     // to a request's goal
  waiting,     // people are in the way
  explaining,  // at an exhibit
  asking,      // "more, or move on?"
  stopped,     // by hand
  faulted,     // a device or the gate does not let it move
};

// Why, beyond the activity itself.
enum class Why : std::uint8_t {
  none,
  requested,
  tour,
  nothing_to_do,
  people_in_the_way,
  way_blocked,
  crowded_slow,
  pressed_stop,
  laser_silent,
  base_silent,
  bumped,
  emergency_stop,
  lost,
  hazard_near,
  motors_off,
  recording,  // what is seen was recorded; nothing can be asked for
};

// What the robot does and why, with the facts that a sentence needs. Words are made of it per language.
struct Status {
  Activity activity = Activity::starting;
  Why why = Why::none;
  Mode mode = Mode::open;
  std::string exhibit;         // id of the exhibit it is about, or empty
  std::optional<Point> point;  // when the goal is a place on the map
  std::string requester;       // name, or empty
  std::string tour;            // id of the running tour, or empty
  int stop_number = 0;         // of the tour, from 1
  int stop_count = 0;
  double distance_to_go = 0.0;     // m
  double seconds_to_go = 0.0;      // s, of travel, explanation or waiting
  int people_near = 0;             // within 3 m
  double battery_fraction = -1.0;  // negative: unknown
  double speed_limit = 0.0;        // m/s
  bool lost = false;
};

// The dynamic window as it was last judged, for the console: linear x angular samples.
struct VelocitySpace {
  std::vector<double> linear;   // m/s
  std::vector<double> angular;  // rad/s
  std::vector<float> score;     // linear-major; NaN: would hit, or not attainable
  Twist chosen;
};

// ---- Events: each matters -------------------------------------------------------------------------------------

enum class RequestState : std::uint8_t { pending, active, fulfilled, cancelled, failed };

struct Request {
  RequestId id = 0;
  Requester requester;
  Target target;
  RequestState state = RequestState::pending;
  std::string reason;  // in plain words, when cancelled or failed
  Time asked;
  int position = 0;          // in the order of visits from 1; 0 when it is no longer waiting
  double eta_seconds = 0.0;  // estimated time to arrival
  std::string tour;          // id of the tour it belongs to, or empty
};
// A request appeared or changed.
struct RequestChanged {
  Request request;
};

enum class Refusal : std::uint8_t {
  none,
  unknown_exhibit,
  unknown_viewpoint,
  unknown_tour,
  not_finite,
  off_the_map,
  inside_obstacle,
  in_hazard,
  unreachable,
  queue_full,
  unknown_request,
  not_yours,
  already_over,
  nothing_to_answer,
  recording,  // this robot only repeats what was recorded
};
// The answer to anything that carried a ticket.
struct Answer {
  Ticket ticket = 0;
  Refusal refusal = Refusal::none;
  std::vector<RequestId> requests;  // those made or changed
};

// The robot says something: an exhibit's text, or a word to people in its way.
enum class Cue : std::uint8_t { narration, greeting, make_way, horn, arrived, farewell };
struct Speech {
  Cue cue = Cue::narration;
  std::string exhibit;  // narration: whose
  int narration = 0;    // narration: which of its texts
  Text text;
  Seconds duration{0};
};

// A visit that ended, for the statistics.
struct VisitEnded {
  std::string exhibit;
  std::vector<RequestId> requests;
  Time arrived;
  Time left;
  bool complete = false;  // false: cut short
};

enum class Severity : std::uint8_t { info, warning, incident };
// Something that staff should be able to read later. Code is stable, text is in English.
struct Note {
  Severity severity = Severity::info;
  std::string code;
  std::string text;
};

using Output = std::variant<WheelCommand, EnableMotors, PoseEstimate, Belief, ScanView, People, Path, Status,
                            VelocitySpace, RequestChanged, Answer, Speech, VisitEnded, Note>;

}  // namespace robot
