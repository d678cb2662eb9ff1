// The fields of the robot's values, each named once: what is encoded and decoded by it cannot drift apart. A visitor is
// called as visit("name", field) for every field of a value, in a fixed order. Names are part of recordings: never
// rename.
#pragma once

#include "robot/config.hpp"
#include "robot/inputs.hpp"
#include "robot/outputs.hpp"

namespace files {

// The greatest value of an enumeration, so that a decoder can refuse what lies beyond.
template <typename E>
inline constexpr E last_of = E{};
template <>
inline constexpr auto last_of<robot::LaserId> = robot::LaserId::rear;
template <>
inline constexpr auto last_of<robot::Device> = robot::Device::laser_rear;
template <>
inline constexpr auto last_of<robot::Channel> = robot::Channel::program;
template <>
inline constexpr auto last_of<robot::TourAnswer> = robot::TourAnswer::end_tour;
template <>
inline constexpr auto last_of<robot::Mode> = robot::Mode::staff;
template <>
inline constexpr auto last_of<robot::GateReason> = robot::GateReason::motors_off;
template <>
inline constexpr auto last_of<robot::BeamKind> = robot::BeamKind::unexpected_far;
template <>
inline constexpr auto last_of<robot::Activity> = robot::Activity::faulted;
template <>
inline constexpr auto last_of<robot::Why> = robot::Why::recording;
template <>
inline constexpr auto last_of<robot::RequestState> = robot::RequestState::failed;
template <>
inline constexpr auto last_of<robot::Refusal> = robot::Refusal::recording;
template <>
inline constexpr auto last_of<robot::Cue> = robot::Cue::farewell;
template <>
inline constexpr auto last_of<robot::Severity> = robot::Severity::incident;

// T is the value or its const; one overload a struct.
template <typename T, typename U>
concept Is = std::same_as<std::remove_const_t<T>, U>;

// ---- Geometry and the body -------------------------------------------------------------------------------------

template <Is<robot::Point> T, typename V>
void fields(T& t, V& visit) {
  visit("x", t.x), visit("y", t.y);
}
template <Is<robot::Pose> T, typename V>
void fields(T& t, V& visit) {
  visit("x", t.x), visit("y", t.y), visit("theta", t.theta);
}
template <Is<robot::Twist> T, typename V>
void fields(T& t, V& visit) {
  visit("linear", t.linear), visit("angular", t.angular);
}
template <Is<robot::Footprint> T, typename V>
void fields(T& t, V& visit) {
  visit("front", t.front), visit("rear", t.rear), visit("half_width", t.half_width);
}
template <Is<robot::DriveLimits> T, typename V>
void fields(T& t, V& visit) {
  visit("max_linear", t.max_linear), visit("max_reverse", t.max_reverse), visit("max_angular", t.max_angular);
  visit("max_acceleration", t.max_acceleration), visit("max_deceleration", t.max_deceleration);
  visit("max_angular_acceleration", t.max_angular_acceleration);
}
template <Is<robot::LaserMount> T, typename V>
void fields(T& t, V& visit) {
  visit("base_from_laser", t.base_from_laser), visit("angle_min", t.angle_min), visit("angle_step", t.angle_step);
  visit("beams", t.beams), visit("max_range", t.max_range);
}
template <Is<robot::SonarMount> T, typename V>
void fields(T& t, V& visit) {
  visit("base_from_sonar", t.base_from_sonar), visit("opening_angle", t.opening_angle);
  visit("max_range", t.max_range);
}
template <Is<robot::Body> T, typename V>
void fields(T& t, V& visit) {
  visit("footprint", t.footprint), visit("drive", t.drive), visit("lasers", t.lasers), visit("sonars", t.sonars);
}

// ---- Inputs ----------------------------------------------------------------------------------------------------

template <Is<robot::LaserScan> T, typename V>
void fields(T& t, V& visit) {
  visit("time", t.time), visit("laser", t.laser), visit("angle_min", t.angle_min), visit("angle_step", t.angle_step);
  visit("max_range", t.max_range), visit("ranges", t.ranges);
}
template <Is<robot::Odometry> T, typename V>
void fields(T& t, V& visit) {
  visit("time", t.time), visit("odom_from_base", t.odom_from_base), visit("twist", t.twist);
}
template <Is<robot::SonarReading> T, typename V>
void fields(T& t, V& visit) {
  visit("sonar", t.sonar), visit("range", t.range);
}
template <Is<robot::SonarScan> T, typename V>
void fields(T& t, V& visit) {
  visit("time", t.time), visit("readings", t.readings);
}
template <Is<robot::BaseState> T, typename V>
void fields(T& t, V& visit) {
  visit("time", t.time), visit("battery_volts", t.battery_volts), visit("battery_fraction", t.battery_fraction);
  visit("motors_enabled", t.motors_enabled), visit("emergency_stop", t.emergency_stop), visit("stalled", t.stalled);
  visit("bumper_front", t.bumper_front), visit("bumper_rear", t.bumper_rear);
}
template <Is<robot::DeviceState> T, typename V>
void fields(T& t, V& visit) {
  visit("device", t.device), visit("connected", t.connected), visit("reason", t.reason);
}
template <Is<robot::Requester> T, typename V>
void fields(T& t, V& visit) {
  visit("name", t.name), visit("channel", t.channel), visit("session", t.session);
}
template <Is<robot::ExhibitTarget> T, typename V>
void fields(T& t, V& visit) {
  visit("exhibit", t.exhibit), visit("viewpoint", t.viewpoint);
}
template <Is<robot::PointTarget> T, typename V>
void fields(T& t, V& visit) {
  visit("point", t.point), visit("theta", t.theta);
}
template <Is<robot::RequestVisit> T, typename V>
void fields(T& t, V& visit) {
  visit("ticket", t.ticket), visit("requester", t.requester), visit("target", t.target);
}
template <Is<robot::CancelRequest> T, typename V>
void fields(T& t, V& visit) {
  visit("ticket", t.ticket), visit("id", t.id), visit("session", t.session), visit("staff", t.staff);
}
template <Is<robot::StartTour> T, typename V>
void fields(T& t, V& visit) {
  visit("ticket", t.ticket), visit("requester", t.requester), visit("tour", t.tour);
}
template <Is<robot::AnswerTour> T, typename V>
void fields(T& t, V& visit) {
  visit("ticket", t.ticket), visit("answer", t.answer);
}
template <Is<robot::Stop> T, typename V>
void fields(T& t, V& visit) {
  visit("who", t.who);
}
template <Is<robot::Resume> T, typename V>
void fields(T& t, V& visit) {
  visit("who", t.who);
}
template <Is<robot::SetMode> T, typename V>
void fields(T& t, V& visit) {
  visit("mode", t.mode);
}
template <Is<robot::SetPose> T, typename V>
void fields(T& t, V& visit) {
  visit("map_from_base", t.map_from_base);
}
template <Is<robot::LocalizeGlobally> T, typename V>
void fields(T&, V&) {}
template <Is<robot::Tick> T, typename V>
void fields(T&, V&) {}
template <Is<robot::RememberedRequest> T, typename V>
void fields(T& t, V& visit) {
  visit("id", t.id), visit("requester", t.requester), visit("target", t.target);
}
template <Is<robot::Remember> T, typename V>
void fields(T& t, V& visit) {
  visit("next_id", t.next_id), visit("open", t.open);
}
template <Is<robot::Input> T, typename V>
void fields(T& t, V& visit) {
  visit("now", t.now), visit("event", t.event);
}

// ---- Outputs ---------------------------------------------------------------------------------------------------

template <Is<robot::WheelCommand> T, typename V>
void fields(T& t, V& visit) {
  visit("twist", t.twist), visit("reason", t.reason);
}
template <Is<robot::EnableMotors> T, typename V>
void fields(T& t, V& visit) {
  visit("on", t.on);
}
template <Is<robot::PoseEstimate> T, typename V>
void fields(T& t, V& visit) {
  visit("time", t.time), visit("map_from_base", t.map_from_base), visit("sigma_position", t.sigma_position);
  visit("sigma_theta", t.sigma_theta), visit("particles", t.particles), visit("localized", t.localized);
  visit("twist", t.twist);
}
template <Is<robot::Belief> T, typename V>
void fields(T& t, V& visit) {
  visit("time", t.time), visit("samples", t.samples);
}
template <Is<robot::ScanView> T, typename V>
void fields(T& t, V& visit) {
  visit("time", t.time), visit("laser", t.laser), visit("map_from_laser", t.map_from_laser);
  visit("angle_min", t.angle_min), visit("angle_step", t.angle_step), visit("ranges", t.ranges);
  visit("kinds", t.kinds);
}
template <Is<robot::PersonSeen> T, typename V>
void fields(T& t, V& visit) {
  visit("position", t.position), visit("velocity", t.velocity), visit("id", t.id);
}
template <Is<robot::People> T, typename V>
void fields(T& t, V& visit) {
  visit("time", t.time), visit("people", t.people);
}
template <Is<robot::Path> T, typename V>
void fields(T& t, V& visit) {
  visit("points", t.points), visit("length", t.length);
}
template <Is<robot::Status> T, typename V>
void fields(T& t, V& visit) {
  visit("activity", t.activity), visit("why", t.why), visit("mode", t.mode), visit("exhibit", t.exhibit);
  visit("point", t.point), visit("requester", t.requester), visit("tour", t.tour);
  visit("stop_number", t.stop_number), visit("stop_count", t.stop_count);
  visit("distance_to_go", t.distance_to_go), visit("seconds_to_go", t.seconds_to_go);
  visit("people_near", t.people_near), visit("battery_fraction", t.battery_fraction);
  visit("speed_limit", t.speed_limit), visit("lost", t.lost);
}
template <Is<robot::VelocitySpace> T, typename V>
void fields(T& t, V& visit) {
  visit("linear", t.linear), visit("angular", t.angular), visit("score", t.score), visit("chosen", t.chosen);
}
template <Is<robot::Request> T, typename V>
void fields(T& t, V& visit) {
  visit("id", t.id), visit("requester", t.requester), visit("target", t.target), visit("state", t.state);
  visit("reason", t.reason), visit("asked", t.asked), visit("position", t.position);
  visit("eta_seconds", t.eta_seconds), visit("tour", t.tour);
}
template <Is<robot::RequestChanged> T, typename V>
void fields(T& t, V& visit) {
  visit("request", t.request);
}
template <Is<robot::Answer> T, typename V>
void fields(T& t, V& visit) {
  visit("ticket", t.ticket), visit("refusal", t.refusal), visit("requests", t.requests);
}
template <Is<robot::Speech> T, typename V>
void fields(T& t, V& visit) {
  visit("cue", t.cue), visit("exhibit", t.exhibit), visit("narration", t.narration), visit("text", t.text);
  visit("duration", t.duration);
}
template <Is<robot::VisitEnded> T, typename V>
void fields(T& t, V& visit) {
  visit("exhibit", t.exhibit), visit("requests", t.requests), visit("arrived", t.arrived), visit("left", t.left);
  visit("complete", t.complete);
}
template <Is<robot::Note> T, typename V>
void fields(T& t, V& visit) {
  visit("severity", t.severity), visit("code", t.code), visit("text", t.text);
}

}  // namespace files
