#include "robot/motion/dynamic_window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "robot/motion/sweep.hpp"

namespace robot {
namespace {

constexpr double carrot_near = 0.5, carrot_seconds = 1.3, carrot_far = 1.5;  // m, s, m
constexpr double carrot_deviation = 0.15;                                    // m
constexpr double clearance_reach = 2.2;      // m from the base within which standing things matter for clearance
constexpr int judged_poses = 4;              // along an arc, for clearance
constexpr int predicted_places = 3;          // on a walker's way
constexpr double enough_progress = 0.05;     // m within the lookahead
constexpr double slow = 0.25;                // m/s at which the robot may turn on the spot without braking first
constexpr double least_turn = 0.25;          // rad/s; wheels stick below
constexpr double least_speed = 0.07;         // m/s, likewise
constexpr double at_ease = 0.25;             // m/s that are never too fast
constexpr double ease_a_metre = 1.4;         // m/s more that a metre of clearance allows
constexpr double hit_penalty = 1.0;          // for meeting a walker who goes on walking
constexpr double leave_hazard_speed = 0.15;  // m/s

double sample(double low, double high, int i, int count) {
  return count > 1 ? low + (high - low) * i / (count - 1) : 0.5 * (low + high);
}

}  // namespace

void DynamicWindow::reset() {
  state_ = MotionState::standing;
  blocked_since_.reset();
  backing_since_.reset();
}

DynamicWindow::Scene DynamicWindow::look(const MotionTask& task, const Pose& map_from_base, const Twist& current,
                                         std::span<const Obstacle> obstacles, const VirtualReadings& hazards) const {
  Scene scene{PathAhead(task.path, map_from_base, config_.reach), {}, {}, {}, {}, {}, &hazards, current, 0.0};
  for (const Obstacle& o : obstacles) {
    if (!is_finite(o.position) || norm(o.position) > config_.reach) continue;
    scene.solid.push_back(o.position);
    const bool walks = o.velocity.x != 0.0 || o.velocity.y != 0.0;
    // Whoever crosses may stop anywhere on the way.
    for (int i = 1; walks && i <= predicted_places; ++i) {
      scene.solid.push_back(o.position + (config_.prediction.count() * i / predicted_places) * o.velocity);
    }
    if (walks) {
      scene.walking.push_back(o.position);
      scene.velocity.push_back(o.velocity);
    }
    if (!walks && norm(o.position) < clearance_reach) scene.near.push_back(o.position);
  }
  for (const Point& p : hazards.points) {
    scene.hazard.push_back(p);
    if (norm(p) < clearance_reach) scene.near.push_back(p);
  }
  const double to_goal = std::max(scene.path.remaining(), distance(task.path.back(), map_from_base.position()));
  const double approach = std::sqrt(2.0 * config_.goal_deceleration * to_goal);
  scene.speed_limit = std::clamp(std::min(task.speed_limit, approach), least_speed, body_.drive.max_linear);
  return scene;
}

double DynamicWindow::contact(const Scene& scene, const Twist& twist) const {
  return std::min(time_to_contact(grown(body_.footprint, config_.margin), scene.solid, twist),
                  time_to_hazard(*scene.readings, scene.hazard, body_.footprint, twist));
}

// The safety constraint: after the latency it can brake to rest before the contact, v <= sqrt(2 a d) for both
// velocities.
bool DynamicWindow::can_stop(const Twist& twist, double contact_seconds) const {
  const double braking = std::max(std::abs(twist.linear) / body_.drive.max_deceleration,
                                  std::abs(twist.angular) / body_.drive.max_angular_acceleration);
  return contact_seconds >= config_.latency.count() + 0.5 * braking;
}

// The least distance between the footprint and anything along the arc, walkers met where they will be by then.
double DynamicWindow::clearance(const Scene& scene, const Twist& twist, double seconds) const {
  const Footprint& f = body_.footprint;
  const sweep::Box box{static_cast<float>(f.front), static_cast<float>(f.rear), static_cast<float>(f.half_width)};
  double least = config_.comfortable;
  for (int i = 1; i <= judged_poses; ++i) {
    const double t = seconds * i / judged_poses;
    const Pose pose = arc(twist, t);
    const auto x = static_cast<float>(pose.x), y = static_cast<float>(pose.y);
    const auto c = static_cast<float>(std::cos(pose.theta)), d = static_cast<float>(std::sin(pose.theta));
    const float standing =
        sweep::least_distance(box, x, y, c, d, scene.near.x.data(), scene.near.y.data(), nullptr, scene.near.size());
    const float walking = sweep::least_distance_moving(box, x, y, c, d, scene.walking.x.data(), scene.walking.y.data(),
                                                       scene.velocity.x.data(), scene.velocity.y.data(),
                                                       static_cast<float>(t), scene.walking.size());
    least = std::min(least, static_cast<double>(std::max(0.0f, std::min(standing, walking))));
  }
  return least;
}

// Hard constraints first: none when it could not stop. Then the soft ones.
std::optional<DynamicWindow::Best> DynamicWindow::judge(const Scene& scene, const Twist& twist) const {
  const double meets = contact(scene, twist);
  if (!can_stop(twist, meets)) return std::nullopt;
  double seconds = std::min(config_.lookahead.count(), 0.9 * meets);
  if (twist.linear * seconds > scene.path.remaining()) seconds = scene.path.remaining() / twist.linear;
  const Pose end = arc(twist, seconds);
  const PathAhead::Place place = scene.path.project(end.position());
  const double off = wrap_angle(end.theta - scene.path.heading(place.along + 0.2));
  const double clear = clearance(scene, twist, seconds);
  const double tight = 1.0 - clear / config_.comfortable;
  const double haste = std::max(0.0, twist.linear - at_ease - ease_a_metre * clear);
  Best best{twist, 0.0, place.along};
  best.score = place.along / (scene.speed_limit * config_.lookahead.count());
  best.score -= config_.offset_weight * std::min(place.offset, 1.0);
  best.score -= config_.heading_weight * (1.0 - std::cos(off));
  best.score -= config_.clearance_weight * tight * tight;
  best.score -= config_.haste_weight * haste;
  best.score -= config_.turning_weight * std::abs(twist.angular - last_.angular);
  if (clear <= 0.0) best.score -= hit_penalty * twist.linear;
  return best;
}

DynamicWindow::Best DynamicWindow::best_of_window(const Scene& scene, VelocitySpace& space) const {
  const DriveLimits& limits = body_.drive;
  const double window = config_.window.count(), v = std::max(0.0, scene.current.linear), w = scene.current.angular;
  const double low = std::max(0.0, v - limits.max_deceleration * window);
  const double high = std::max(low, std::min(scene.speed_limit, v + limits.max_acceleration * window));
  const double turn = limits.max_angular_acceleration * window;
  const double right = std::clamp(w - turn, -limits.max_angular, limits.max_angular);
  const double left = std::clamp(w + turn, -limits.max_angular, limits.max_angular);
  for (int i = 0; i < config_.linear_samples; ++i) space.linear.push_back(sample(low, high, i, config_.linear_samples));
  for (int i = 0; i < config_.angular_samples; ++i) {
    space.angular.push_back(sample(right, left, i, config_.angular_samples));
  }
  // To stand is always possible, and what everything else has to beat.
  Best best = judge(scene, {}).value_or(Best{});
  const auto consider = [&](const Twist& twist) {
    const auto judged = judge(scene, twist);
    if (judged && judged->score > best.score) best = *judged;
    return judged ? static_cast<float>(judged->score) : std::numeric_limits<float>::quiet_NaN();
  };
  for (const double linear : space.linear) {
    for (const double angular : space.angular) space.score.push_back(consider({linear, angular}));
  }
  for (const double linear : space.linear) consider({linear, 0.0});  // exactly straight is rarely among the samples
  return best;
}

// Turning on the spot by an angle, the other way round when this way is blocked; none when both are.
std::optional<Twist> DynamicWindow::turn_by(const Scene& scene, double angle) const {
  const double sign = angle >= 0.0 ? 1.0 : -1.0;
  // Near half a turn either side will do: the one that was begun.
  const bool either = std::abs(angle) > 2.6 && last_.angular * sign < 0.0;
  for (const double side : {either ? -sign : sign, either ? sign : -sign}) {
    const double way = side == sign ? std::abs(angle) : 2.0 * pi - std::abs(angle);
    double speed = std::clamp(1.6 * way, least_turn, config_.turn_speed);
    const double free = contact(scene, {0.0, side}) * 1.0;  // rad, at one rad/s
    if (std::isfinite(free) && free < way + 0.05) continue;
    while (speed >= least_turn && !can_stop({0.0, side * speed}, contact(scene, {0.0, side * speed}))) speed *= 0.7;
    if (speed >= 0.7 * least_turn) return Twist{0.0, side * speed};
  }
  return std::nullopt;
}

std::optional<Twist> DynamicWindow::back_out(const Scene& scene) const {
  const Twist back{-std::min(config_.back_speed, body_.drive.max_reverse), 0.0};
  const double room = contact(scene, back);
  if (room < 1.0) return std::nullopt;
  return back;
}

// Within a hazard, or too near to one: turn until the way out lies ahead or behind, then go.
Twist DynamicWindow::leave_hazard(const Scene& scene) const {
  const Point out = scene.readings->outward;
  const double bearing = std::atan2(out.y, out.x);
  const bool behind = std::abs(bearing) > 0.5 * pi;
  const double off = behind ? wrap_angle(bearing - pi) : bearing;
  if (std::abs(off) > 1.0) return turn_by(scene, off).value_or(Twist{});
  const Twist twist{behind ? -leave_hazard_speed : leave_hazard_speed, std::clamp(off, -0.3, 0.3)};
  for (const Twist& tried : {twist, Twist{twist.linear, 0.0}, Twist{-twist.linear, 0.0}}) {
    if (can_stop(tried, contact(scene, tried))) return tried;
  }
  return {};
}

void DynamicWindow::note_progress(bool progress, Time now, MotionChoice& choice) {
  if (progress) blocked_since_.reset();
  if (!progress && !blocked_since_) blocked_since_ = now;
  choice.blocked_for = blocked_since_ ? Seconds(now - *blocked_since_) : Seconds(0);
}

// bearing: of the carrot, rad.
void DynamicWindow::drive(const Scene& scene, double bearing, Time now, MotionChoice& choice) {
  const bool turning = state_ == MotionState::turning;
  bool turn_blocked = false;
  if (std::abs(bearing) > (turning ? config_.turn_to : config_.turn_from)) {
    if (scene.current.linear > slow) {  // brake along the present arc first
      choice = {{0.0, 0.3 * scene.current.angular}, MotionState::turning, {}, {}};
      return note_progress(true, now, choice);
    }
    if (const auto turn = turn_by(scene, bearing)) {
      choice.twist = *turn;
      choice.state = MotionState::turning;
      return note_progress(true, now, choice);
    }
    turn_blocked = true;
  }
  const Best best = best_of_window(scene, choice.space);
  choice.twist = best.twist;
  const bool progress = best.progress >= std::min(enough_progress, scene.path.remaining());
  note_progress(progress && best.twist.linear > 0.0, now, choice);
  choice.state = progress ? MotionState::driving : MotionState::blocked;
  if (choice.blocked_for > (turn_blocked ? config_.patience : 2.0 * config_.patience)) {
    if (const auto back = back_out(scene)) {
      backing_since_ = now;
      choice.twist = *back;
      choice.state = MotionState::backing_out;
    }
  }
}

MotionChoice DynamicWindow::choose(const MotionTask& task, const Pose& map_from_base, const Twist& current,
                                   std::span<const Obstacle> obstacles, const VirtualReadings& hazards, Time now) {
  MotionChoice choice;
  const auto done = [&] {
    state_ = choice.state;
    last_ = choice.twist;
    choice.space.chosen = choice.twist;
    return choice;
  };
  if (task.path.empty() || !is_finite(map_from_base)) {
    reset();
    return done();
  }
  const Scene scene = look(task, map_from_base, current, obstacles, hazards);
  if (hazards.clearance <= body_.footprint.inscribed()) {
    choice.twist = leave_hazard(scene);
    choice.state = choice.twist == Twist{} ? MotionState::blocked : MotionState::driving;
    note_progress(choice.state == MotionState::driving, now, choice);
    return done();
  }
  // The path ends where the robot can stand, as near to the goal as that is.
  const Pose goal = relative(map_from_base, {task.path.back().x, task.path.back().y, task.goal.theta});
  const bool was_there = state_ == MotionState::arriving || state_ == MotionState::arrived;
  if (norm(goal.position()) <= (was_there ? 2.5 : 1.0) * config_.goal_distance) {
    const bool faces = !task.final_heading || std::abs(goal.theta) <= config_.goal_heading;
    const auto turn = faces ? std::optional<Twist>{} : turn_by(scene, goal.theta);
    choice.twist = turn.value_or(Twist{});
    choice.state = faces ? MotionState::arrived : MotionState::arriving;
    note_progress(faces || turn, now, choice);
    return done();
  }
  if (state_ == MotionState::backing_out && now - *backing_since_ < config_.back_time) {
    if (const auto back = back_out(scene)) {
      choice.twist = *back;
      choice.state = MotionState::backing_out;
      return done();
    }
  }
  if (state_ == MotionState::backing_out) blocked_since_.reset();
  const double lookahead = std::clamp(carrot_near + carrot_seconds * current.linear, carrot_near, carrot_far);
  const Point carrot = scene.path.carrot(lookahead, carrot_deviation);
  drive(scene, std::atan2(carrot.y, carrot.x), now, choice);
  return done();
}

}  // namespace robot
