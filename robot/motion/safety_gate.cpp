#include "robot/motion/safety_gate.hpp"

#include <algorithm>
#include <cmath>

#include "robot/motion/stopping.hpp"

namespace robot {
namespace {

constexpr double crawling = 0.02;                         // m/s and rad/s below which slowed counts as stopped
constexpr double shares[] = {1.0, 0.75, 0.5, 0.3, 0.15};  // of a wanted twist that are tried

bool younger(const std::optional<Time>& heard, Seconds limit, Time now) { return heard && now - *heard <= limit; }

Twist scaled(const Twist& twist, double share) { return {share * twist.linear, share * twist.angular}; }

bool stands(const Twist& twist) { return twist.linear == 0.0 && twist.angular == 0.0; }

}  // namespace

SafetyGate::SafetyGate(const Body& body, bool hazards, const SafetyGateConfig& config)
    : body_(body), config_(config), hazards_(hazards), scans_(body) {}

void SafetyGate::add(const LaserScan& scan, Time now) {
  const auto id = static_cast<std::size_t>(scan.laser);
  if (id > 1) return;
  scans_.add(scan);
  laser_heard_[id] = now;
  laser_connected_[id] = true;
}

void SafetyGate::add(const Odometry& odometry, Time now) {
  scans_.add(odometry);
  odometry_heard_ = now;
}

void SafetyGate::add(const BaseState& state, Time now) {
  if (state.bumper_front) bumped_[0] = now;
  if (state.bumper_rear) bumped_[1] = now;
  const bool over = stalled_ && now - *stalled_ > 2.0 * config_.stall_hold;
  if (state.stalled && !stands(last_) && (!stalled_ || over)) stalled_ = now;
  base_ = state;
  base_heard_ = now;
}

void SafetyGate::add(const DeviceState& state) {
  switch (state.device) {
    case Device::base:
      base_connected_ = state.connected;
      break;
    case Device::laser_front:
      laser_connected_[0] = state.connected;
      break;
    case Device::laser_rear:
      laser_connected_[1] = state.connected;
      break;
  }
}

void SafetyGate::add(const VirtualReadings& readings, bool localized, Time now) {
  readings_ = readings;
  readings_at_ = scans_.odometry().odom_from_base;
  localized_ = localized;
  readings_heard_ = now;
}

void SafetyGate::add(const People& people, const Pose& map_from_base, Time now) {
  const Pose odom_from_map = scans_.odometry().odom_from_base * inverse(map_from_base);
  bodies_.clear();
  for (const PersonSeen& person : people.people) {
    if (!is_finite(person.position) || distance(person.position, map_from_base.position()) > config_.reach) continue;
    for (const Point& p : body_outline(person)) bodies_.push_back(odom_from_map * p);
  }
  bodies_heard_ = now;
}

void SafetyGate::set_speed_limit(double linear) {
  speed_limit_ = std::isfinite(linear) ? std::clamp(linear, 0.0, body_.drive.max_linear) : 0.0;
}

bool SafetyGate::bumper_held(std::size_t side, Time now) const {
  const bool pressed = side == 0 ? base_.bumper_front : base_.bumper_rear;
  return pressed || younger(bumped_[side], config_.bumper_hold, now);
}

// What the base itself says.
SafetyGate::Verdict SafetyGate::body_verdict(const Twist& wanted, Time now) const {
  using enum GateReason;
  if (!base_connected_ || !base_heard_ || !younger(odometry_heard_, config_.odometry_stale, now)) {
    return {base_lost, Answer::zero, {}};
  }
  if (base_.emergency_stop) return {emergency_stop, Answer::zero, {}};
  if (!base_.motors_enabled) return {motors_off, Answer::zero, {}};
  const bool front = bumper_held(0, now), rear = bumper_held(1, now);
  if (front || rear) {
    const bool away = (wanted.linear < 0.0 && !rear) || (wanted.linear > 0.0 && !front);
    if (!away) return {bumper, Answer::zero, {}};
    const double share = std::min(1.0, config_.creep_speed / std::abs(wanted.linear));
    return {bumper, Answer::pass, {share * wanted.linear, 0.0}};
  }
  if (younger(stalled_, config_.stall_hold, now)) return {obstacle, Answer::zero, {}};
  return {none, Answer::pass, wanted};
}

SafetyGate::Verdict SafetyGate::verdict(const Twist& wanted, Time now) const {
  using enum GateReason;
  const Verdict body = body_verdict(wanted, now);
  if (body.answer == Answer::zero) return body;
  if (stopped_) return {stopped_by_hand, Answer::ramp, {}};
  for (std::size_t i = 0; i < std::min<std::size_t>(2, body_.lasers.size()); ++i) {
    if (!laser_connected_[i] || !younger(laser_heard_[i], config_.laser_stale, now)) {
      return {sensor_stale, Answer::ramp, {}};
    }
  }
  if (body.reason != none) return body;
  if (hazards_ && (!localized_ || !younger(readings_heard_, config_.pose_stale, now))) {
    if (wanted.linear != 0.0) return {pose_unknown, Answer::ramp, {}};
    return {pose_unknown, Answer::pass, {0.0, std::clamp(wanted.angular, -config_.blind_turn, config_.blind_turn)}};
  }
  // The speed limit keeps the arc.
  const double limit = wanted.linear > 0.0 ? speed_limit_ : std::min(speed_limit_, body_.drive.max_reverse);
  double share = std::abs(wanted.linear) > limit ? limit / std::abs(wanted.linear) : 1.0;
  if (std::abs(wanted.angular) > body_.drive.max_angular) {
    share = std::min(share, body_.drive.max_angular / std::abs(wanted.angular));
  }
  return {share < 0.999 ? slowed : none, Answer::pass, scaled(wanted, share)};
}

// A controlled stop: along the same arc, from what the wheels do or were last told, whichever is less.
Twist SafetyGate::ramp_down(Seconds step) const {
  const Twist& measured = scans_.odometry().twist;
  const auto less = [](double a, double b) {
    return a * b <= 0.0 ? 0.0 : std::copysign(std::min(std::abs(a), std::abs(b)), a);
  };
  const Twist from{less(last_.linear, measured.linear), less(last_.angular, measured.angular)};
  const double stopping = std::max(std::abs(from.linear) / body_.drive.max_deceleration,
                                   std::abs(from.angular) / body_.drive.max_angular_acceleration);
  return stopping > step.count() ? scaled(from, 1.0 - step.count() / stopping) : Twist{};
}

// The largest share of a twist that a robot which moved so already could stop from before a contact that is
// `contact_seconds` away at full share: share * latency + share^2 * braking / 2 <= contact_seconds. It lets the robot
// approach an obstacle in a smooth ramp.
double SafetyGate::share_that_can_stop(const Twist& twist, double contact_seconds) const {
  if (!std::isfinite(contact_seconds)) return 1.0;
  const double braking = std::max(std::abs(twist.linear) / body_.drive.max_deceleration,
                                  std::abs(twist.angular) / body_.drive.max_angular_acceleration);
  const double l = config_.latency.count();
  return braking > 0.0 ? std::min(1.0, (std::sqrt(l * l + 2.0 * braking * contact_seconds) - l) / braking) : 1.0;
}

// What keeps the robot from stopping in time if this twist were commanded now; none: nothing.
GateReason SafetyGate::in_the_way(const Twist& twist, const std::vector<Point>& seen, const VirtualReadings* hazards,
                                  Time now) const {
  std::vector<DueCommand> commands;
  for (const Sent& sent : sent_) commands.push_back({Seconds(sent.time + config_.latency - now).count(), sent.twist});
  commands.push_back({config_.latency.count(), twist});
  commands.push_back({(config_.latency + config_.hold).count(), {}});
  const std::vector<Pose> way = way_of(scans_.odometry().twist, commands, body_.drive);
  if (hazards) {
    const bool close = hazards->clearance <= body_.footprint.inscribed();
    const bool clear = close ? leads_outward(*hazards, twist)
                             : stays_clear(body_.footprint, config_.hazard_margin, hazards->points, way);
    if (!clear) return GateReason::hazard;
  }
  return stays_clear(body_.footprint, config_.margin, seen, way) ? GateReason::none : GateReason::obstacle;
}

// The virtual readings, carried along by odometry since they were made.
VirtualReadings SafetyGate::readings_now() const {
  const Pose base_from_then = inverse(scans_.odometry().odom_from_base) * readings_at_;
  VirtualReadings moved = readings_;
  for (Point& p : moved.points) p = base_from_then * p;
  moved.outward = Pose{0.0, 0.0, base_from_then.theta} * readings_.outward;
  moved.clearance -= norm(base_from_then.position());
  return moved;
}

// What the lasers see, and the bodies above the legs.
std::vector<Point> SafetyGate::obstacles_now(Time now) const {
  std::vector<Point> seen = scans_.points(config_.reach);
  if (!younger(bodies_heard_, config_.people_stale, now)) return seen;
  const Pose base_from_odom = inverse(scans_.odometry().odom_from_base);
  for (const Point& p : bodies_) seen.push_back(base_from_odom * p);
  return seen;
}

WheelCommand SafetyGate::clear_ahead(const Twist& wanted, Time now) {
  if (stands(wanted)) return {wanted, GateReason::none};
  if (younger(held_, config_.stop_hold, now) && wanted.linear * held_direction_ > 0.0) return {{}, held_reason_};
  const std::vector<Point> seen = obstacles_now(now);
  const bool near_hazards = hazards_ && younger(readings_heard_, config_.pose_stale, now);
  const VirtualReadings readings = near_hazards ? readings_now() : VirtualReadings{};
  PointColumns points;
  for (const Point& p : seen) points.push_back(p);
  const double contact = time_to_contact(grown(body_.footprint, config_.margin), points, wanted);
  const double smooth = share_that_can_stop(wanted, contact);
  GateReason reason = GateReason::obstacle;
  for (const double part : shares) {
    const double share = part * smooth;
    const Twist tried = scaled(wanted, share);
    if (std::max(std::abs(tried.linear), std::abs(tried.angular)) < crawling) break;
    const GateReason cause = in_the_way(tried, seen, near_hazards ? &readings : nullptr, now);
    if (cause == GateReason::none) return {tried, share < 1.0 ? GateReason::slowed : GateReason::none};
    reason = cause;
  }
  held_ = now;
  held_direction_ = wanted.linear;
  held_reason_ = reason;
  return {{}, reason};
}

WheelCommand SafetyGate::limit(const Twist& wanted, Time now) {
  const bool sane = std::isfinite(wanted.linear) && std::isfinite(wanted.angular);
  const Seconds step = last_time_ ? std::clamp(Seconds(now - *last_time_), Seconds(0.0), Seconds(0.1)) : Seconds(0.05);
  const Verdict found = verdict(sane ? wanted : Twist{}, now);
  WheelCommand command;
  if (found.answer == Answer::zero) {
    command.reason = found.reason;
  } else {
    command = clear_ahead(found.answer == Answer::ramp ? ramp_down(step) : found.allowed, now);
    const bool graver = found.reason != GateReason::none && found.reason != GateReason::slowed;
    if (graver || command.reason == GateReason::none) command.reason = found.reason;
  }
  last_ = command.twist;
  last_time_ = now;
  std::erase_if(sent_, [&](const Sent& sent) { return now - sent.time > 2.0 * config_.latency; });
  sent_.push_back({now, command.twist});
  return command;
}

}  // namespace robot
