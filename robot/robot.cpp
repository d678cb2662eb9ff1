#include "robot/robot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "robot/interaction/words.hpp"
#include "robot/localization/localizer.hpp"
#include "robot/mapping/obstacle_layers.hpp"
#include "robot/motion/dynamic_window.hpp"
#include "robot/motion/safety_gate.hpp"
#include "robot/motion/scan_memory.hpp"
#include "robot/motion/virtual_sensors.hpp"
#include "robot/perception/people.hpp"
#include "robot/planning/path.hpp"
#include "robot/planning/planner.hpp"
#include "robot/tasks/guide.hpp"
#include "robot/tasks/travel_table.hpp"

namespace robot {
namespace {

using Outputs = std::vector<Output>;

// True at most once a period; the first time at once.
class Every {
 public:
  explicit Every(Seconds period) : period_(period) {}
  bool due(Time now) {
    if (last_ && now - *last_ < period_) return false;
    last_ = now;
    return true;
  }
  void reset() { last_.reset(); }

 private:
  Seconds period_;
  std::optional<Time> last_;
};

constexpr int search_units_per_tick = 30;    // of global localization, about 0.1 ms each
constexpr int plan_cells_per_tick = 150000;  // of the value function
constexpr int belief_samples = 120;          // for virtual sensors and the console

Refusal refusal_of(PlaceKind kind) {
  switch (kind) {
    case PlaceKind::traversable:
      return Refusal::none;
    case PlaceKind::off_the_map:
      return Refusal::off_the_map;
    case PlaceKind::inside_obstacle:
      return Refusal::inside_obstacle;
    case PlaceKind::in_hazard:
      return Refusal::in_hazard;
    case PlaceKind::too_tight:
      return Refusal::inside_obstacle;
  }
  return Refusal::off_the_map;
}

Why why_of(GateReason reason) {
  switch (reason) {
    case GateReason::bumper:
      return Why::bumped;
    case GateReason::emergency_stop:
      return Why::emergency_stop;
    case GateReason::sensor_stale:
      return Why::laser_silent;
    case GateReason::base_lost:
      return Why::base_silent;
    case GateReason::pose_unknown:
      return Why::hazard_near;
    case GateReason::motors_off:
      return Why::motors_off;
    default:
      return Why::none;
  }
}

}  // namespace

struct Robot::Parts {
  Parts(Museum museum_in, Config config_in)
      : museum(std::move(museum_in)),
        config(std::move(config_in)),
        localizer(museum.map, config.localizer, config.seed),
        layers(museum.map),
        planner(museum, config.body.footprint),
        virtual_sensors(museum),
        window(config.body),
        gate(config.body, virtual_sensors.has_hazards()),
        scans(config.body),
        travel(museum, planner),
        guide(
            museum, {}, [this](Point p) { return refuse(p); },
            [this](const Target& a, const Target& b) { return travel.between(a, b); }) {
    if (config.start) {
      localizer.start_at(*config.start, 0.1, radians(5));
    } else {
      localizer.start_globally();
    }
    set_mode(Mode::open);
  }

  Refusal refuse(Point point) const {
    const PlaceKind kind = planner.place(point);
    if (kind == PlaceKind::too_tight && planner.nearest_traversable(point)) return Refusal::none;
    if (kind != PlaceKind::traversable) return refusal_of(kind);
    const double way = planner.travel_from(museum.home.position(), {point}).front();
    return std::isfinite(way) ? Refusal::none : Refusal::unreachable;
  }

  void set_mode(Mode new_mode) {
    mode = new_mode;
    const SpeedLimits& speed = museum.speed;
    const double limit = mode == Mode::open       ? speed.open_mps
                         : mode == Mode::web_only ? speed.web_only_mps
                                                  : speed.staff_mps;
    speed_limit = std::min(limit, config.body.drive.max_linear);
    gate.set_speed_limit(speed_limit);
  }

  // ---- Sensors -------------------------------------------------------------------------------------------------

  void take(const Odometry& odometry, Time now, Outputs&) {
    gate.add(odometry, now);
    scans.add(odometry);
    localizer.move(odometry.odom_from_base, odometry.time);
    measured = odometry.twist;
  }

  void take(const LaserScan& scan, Time now, Outputs& out) {
    gate.add(scan, now);
    scans.add(scan);
    // Whoever steps in front of the robot is answered at once, not on the next tick.
    const WheelCommand passed = gate.limit(wanted, now);
    if (passed.twist != last_command.twist) out.push_back(command(passed));
    const auto laser = static_cast<std::size_t>(scan.laser);
    const auto odom_from_base = scans.odom_from_base(scan.time);
    if (laser >= config.body.lasers.size() || !odom_from_base || !understand[laser].due(scan.time)) return;
    const Pose& base_from_laser = config.body.lasers[laser].base_from_laser;
    const ScanReading reading = localizer.update(scan, base_from_laser, *odom_from_base);
    estimate = localizer.estimate();
    ScanView view{.time = scan.time,
                  .laser = scan.laser,
                  .map_from_laser = reading.map_from_laser,
                  .angle_min = scan.angle_min,
                  .angle_step = scan.angle_step,
                  .ranges = scan.ranges,
                  .kinds = reading.kinds};
    if (estimate.localized) {
      layers.add(view);
      people.add(view);
    }
    if (show_scan[laser].due(scan.time)) out.push_back(std::move(view));
  }

  void take(const SonarScan& sonars, Time, Outputs&) {
    if (estimate.localized) layers.add(sonars, estimate.map_from_base, config.body.sonars);
  }

  void take(const BaseState& state, Time now, Outputs& out) {
    gate.add(state, now);
    base = state;
    // Motors are off after every connection and after an emergency stop: switch them on when nobody wants them off.
    if (!state.motors_enabled && !state.emergency_stop && !gate.stopped() && ask_motors.due(now))
      out.push_back(EnableMotors{true});
  }

  void take(const DeviceState& state, Time now, Outputs& out) {
    gate.add(state);
    static constexpr const char* names[] = {"base", "laser-front", "laser-rear"};
    const std::string name = names[static_cast<std::size_t>(state.device)];
    out.push_back(state.connected
                      ? Note{Severity::info, name + "-back", "The " + name + " answers again."}
                      : Note{Severity::incident, name + "-lost", "The " + name + " was lost: " + state.reason});
    out.push_back(command(gate.limit(wanted, now)));
  }

  // ---- People --------------------------------------------------------------------------------------------------

  template <typename Wish>
  void pass_on(const Wish& wish, Time now, Outputs& out) {
    guide.handle(wish, now, out);
  }
  void take(const RequestVisit& wish, Time now, Outputs& out) { pass_on(wish, now, out); }
  void take(const CancelRequest& wish, Time now, Outputs& out) { pass_on(wish, now, out); }
  void take(const StartTour& wish, Time now, Outputs& out) { pass_on(wish, now, out); }
  void take(const AnswerTour& wish, Time now, Outputs& out) { pass_on(wish, now, out); }
  void take(const Remember& memory, Time now, Outputs& out) { pass_on(memory, now, out); }

  void take(const Stop& stop, Time now, Outputs& out) {
    gate.stop();
    wanted = {};
    out.push_back(command(gate.limit(wanted, now)));
    out.push_back(Note{Severity::warning, "stopped", "Stopped by " + (stop.who.empty() ? "someone" : stop.who) + "."});
    out.push_back(status(now));
  }
  void take(const Resume& resume, Time now, Outputs& out) {
    gate.resume();
    window.reset();
    out.push_back(
        Note{Severity::info, "resumed", "Released by " + (resume.who.empty() ? "someone" : resume.who) + "."});
    out.push_back(status(now));
  }
  void take(const SetMode& set, Time now, Outputs& out) {
    set_mode(set.mode);
    out.push_back(status(now));
  }
  void take(const SetPose& set, Time, Outputs& out) {
    if (!is_finite(set.map_from_base)) return;
    localizer.start_at(set.map_from_base, 0.3, radians(15));
    relocated(out, "Staff said where the robot is.");
  }
  void take(const LocalizeGlobally&, Time, Outputs& out) {
    localizer.start_globally();
    relocated(out, "The robot looks for its place in the whole museum.");
  }
  void relocated(Outputs& out, const char* text) {
    estimate = localizer.estimate();
    layers.forget();
    window.reset();
    out.push_back(Note{Severity::info, "relocated", text});
  }

  // ---- The control tick ------------------------------------------------------------------------------------------

  void take(const Tick&, Time now, Outputs& out) {
    localizer.work(search_units_per_tick);
    estimate = localizer.estimate();
    layers.decay(now);
    if (replan.due(now)) planner.update(layers);
    planner.work(plan_cells_per_tick);
    if (look_for_hazards.due(now)) {
      readings = virtual_sensors.read(localizer.samples(belief_samples));
      gate.add(readings, estimate.localized && !estimate.lost, now);
    }
    seen = people.people(now);
    if (estimate.localized) gate.add(seen, estimate.map_from_base, now);
    follow_guide(now, out);
    steer(now);
    out.push_back(command(gate.limit(wanted, now)));
    tell(now, out);
  }

  bool knows_where() const { return estimate.localized && !estimate.lost; }

  void follow_guide(Time now, Outputs& out) {
    if (!knows_where() || gate.stopped()) return;
    const Point here = estimate.map_from_base.position();
    Progress progress;
    progress.map_from_base = estimate.map_from_base;
    progress.people_near = people_within(seen, here, 3.0);
    if (goal_pose) {
      progress.arrived = choice.state == MotionState::arrived;
      progress.blocked = choice.blocked_for > Seconds(0.3);
      progress.reachable = !planner.ready(here) || std::isfinite(planner.value_at(here));
      progress.goal_distance = distance(here, goal_pose->position());
      progress.distance_to_go = path.empty() ? progress.goal_distance : path_length(path);
      progress.people_ahead = people_on_path(seen, path, 3.0, 0.7);
    }
    guide.tick(progress, now, out);
    if (guide.goal_version() == goal_version && !(progress.blocked && reconsider.due(now))) return;
    const bool changed = guide.goal_version() != goal_version;
    goal_version = guide.goal_version();
    choose_place(changed);
  }

  // Of the goal's places the one with the least travel from here; places where somebody stands come last.
  void choose_place(bool goal_changed) {
    const auto& goal = guide.goal();
    std::optional<Pose> best;
    if (goal) {
      std::vector<Point> points;
      for (const Pose& place : goal->places) points.push_back(place.position());
      const std::vector<double> travel_to = planner.travel_from(estimate.map_from_base.position(), points);
      double least = 0.0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const bool taken =
            std::ranges::any_of(seen.people,
                                [&](const PersonSeen& p) { return distance(p.position, points[i]) < 0.6; }) &&
            distance(points[i], estimate.map_from_base.position()) > 0.6;
        const double cost = (std::isfinite(travel_to[i]) ? travel_to[i] : 1e6) + (taken ? 6.0 : 0.0);
        if (!best || cost < least) best = goal->places[i], least = cost;
      }
    }
    if (!goal_changed && best == goal_pose) return;
    goal_pose = best;
    window.reset();
    choice = {};
    path.clear();
    plan_path.reset();
    if (goal_pose) {
      planner.set_goal(goal_pose->position());
      planner.work(plan_cells_per_tick);
    } else {
      planner.clear_goal();
    }
  }

  void steer(Time now) {
    wanted = {};
    if (!knows_where()) {
      wanted.angular = gate.stopped() ? 0.0 : 0.35;  // look round; the gate sees to it that nothing is touched
      return;
    }
    if (!goal_pose || gate.stopped()) return;
    if (plan_path.due(now)) path = planner.path_from(estimate.map_from_base.position());
    std::vector<Obstacle> obstacles = with_motion(scans.points(4.0), seen, estimate.map_from_base);
    const Pose base_from_map = inverse(estimate.map_from_base);
    for (const Point& p : layers.sonar_obstacles_near(estimate.map_from_base.position(), 2.0))
      obstacles.push_back({base_from_map * p, {}});
    const bool heading = guide.goal() && guide.goal()->heading;
    const MotionTask task{.path = path, .goal = *goal_pose, .final_heading = heading, .speed_limit = speed_limit};
    choice = window.choose(task, estimate.map_from_base, measured, obstacles, readings, now);
    wanted = choice.twist;
  }

  WheelCommand command(const WheelCommand& passed) {
    last_command = passed;
    return passed;
  }

  // ---- What everybody may know -------------------------------------------------------------------------------------

  Status status(Time now) const {
    Status s;
    guide.describe(s, now);
    s.mode = mode;
    s.battery_fraction = base.battery_fraction;
    s.speed_limit = speed_limit;
    s.lost = estimate.lost;
    s.people_near = estimate.localized ? people_within(seen, estimate.map_from_base.position(), 3.0) : 0;
    if (s.activity == Activity::driving && s.people_near >= 4 && std::abs(measured.linear) < 0.5 * speed_limit)
      s.why = Why::crowded_slow;
    const GateReason reason = last_command.reason;
    if (gate.stopped()) {
      s.activity = Activity::stopped;
      s.why = Why::pressed_stop;
    } else if (why_of(reason) != Why::none && reason != GateReason::pose_unknown) {
      s.activity = Activity::faulted;
      s.why = why_of(reason);
    } else if (!knows_where()) {
      s.activity = Activity::localizing;
      s.why = Why::lost;
    }
    return s;
  }

  PoseEstimate pose(Time now) const {
    return {.time = now,
            .map_from_base = estimate.map_from_base,
            .sigma_position = estimate.sigma_position(),
            .sigma_theta = estimate.sigma_theta(),
            .particles = estimate.particles,
            .localized = knows_where(),
            .twist = measured};
  }

  void tell(Time now, Outputs& out) {
    out.push_back(pose(now));
    const Status current = status(now);
    if (current.activity != told_activity || tell_status.due(now)) {
      told_activity = current.activity;
      out.push_back(current);
    }
    if (tell_people.due(now)) out.push_back(seen);
    if (tell_path.due(now)) out.push_back(Path{path, path_length(path)});
    if (tell_belief.due(now)) {
      out.push_back(Belief{now, localizer.samples(belief_samples)});
      if (!choice.space.linear.empty()) out.push_back(choice.space);
    }
  }

  Museum museum;
  Config config;
  Localizer localizer;
  ObstacleLayers layers;
  Planner planner;
  VirtualSensors virtual_sensors;
  DynamicWindow window;
  SafetyGate gate;
  ScanMemory scans;
  PeopleTracker people;
  TravelTable travel;
  Guide guide;

  Mode mode = Mode::open;
  double speed_limit = 0.7;  // m/s
  Estimate estimate;
  Twist measured;
  BaseState base;
  VirtualReadings readings;
  People seen;
  std::optional<Pose> goal_pose;
  int goal_version = 0;
  std::vector<Point> path;
  MotionChoice choice;
  Twist wanted;
  WheelCommand last_command;

  std::array<Every, 2> understand{Every(Seconds(0.04)), Every(Seconds(0.04))};
  std::array<Every, 2> show_scan{Every(Seconds(0.1)), Every(Seconds(0.1))};
  Every replan{Seconds(0.5)};
  Every look_for_hazards{Seconds(0.1)};
  Every plan_path{Seconds(0.15)};
  Every reconsider{Seconds(5.0)};
  Every ask_motors{Seconds(1.0)};
  Every tell_status{Seconds(0.5)};
  Every tell_people{Seconds(0.1)};
  Every tell_path{Seconds(0.5)};
  Every tell_belief{Seconds(0.5)};
  Activity told_activity = Activity::starting;
};

Robot::Robot(Museum museum, Config config) : parts_(std::make_unique<Parts>(std::move(museum), std::move(config))) {}
Robot::~Robot() = default;
Robot::Robot(Robot&&) noexcept = default;
Robot& Robot::operator=(Robot&&) noexcept = default;

std::vector<Output> Robot::handle(const Input& input) {
  Outputs out;
  std::visit([&](const auto& event) { parts_->take(event, input.now, out); }, input.event);
  return out;
}

}  // namespace robot
