#include "robot/simulation/world.hpp"

#include <algorithm>
#include <cmath>

namespace robot::simulation {
namespace {

constexpr auto physics_step = 5ms;
constexpr int crowd_every = 5;      // physics steps
constexpr double crowd_dt = 0.025;  // s
constexpr Seconds touch_ends{2.0};  // without touch, then a new one counts again
constexpr Seconds cut_in_lasts{2.0};
constexpr double reaction = 0.15;  // s, from a person's step to braking wheels: scan, tick, base

constexpr double capacity_wh = 250.0, idle_watts = 25.0, watts_per_mps = 60.0, charger_watts = 400.0;

}  // namespace

World::World(const Museum& museum, const Body& body, const WorldConfig& config, std::uint64_t seed)
    : museum_(museum),
      body_(body),
      config_(config),
      walls_(museum_.map),
      hazards_(museum_),
      drive_(body.drive, config.drive, Random(seed * 4 + 1)),
      sensors_(museum_, body, config.sensors, Random(seed * 4 + 2)),
      crowd_(museum_, config.visitors, Random(seed * 4 + 3)),
      pose_(config.start.value_or(museum.home)),
      next_rear_(Time{} + Seconds(0.5 * config.laser_period.count())),
      battery_(config.battery_fraction) {}

void World::drive_to(Twist wanted) {
  last_command_ = now_;
  const bool usable = std::isfinite(wanted.linear) && std::isfinite(wanted.angular);
  drive_.command(motors_ && !emergency_stop_ && usable ? wanted : Twist{});
}

void World::enable_motors(bool on) {
  motors_ = on && !emergency_stop_;
  if (!motors_) drive_.command({});
}

void World::press_emergency_stop(bool pressed) {
  emergency_stop_ = pressed;
  if (pressed) enable_motors(false);
}

void World::hear(const Speech& speech) { crowd_.hear(speech.cue, seen()); }

void World::place(const Pose& map_from_base) {
  pose_ = map_from_base;
  drive_.block();
}

std::vector<Input> World::advance(Time now) {
  std::vector<Input> events;
  while (now_ + physics_step <= now) {
    now_ += physics_step;
    step();
    sense(events);
  }
  return events;
}

void World::step() {
  if (now_ - last_command_ > config_.watchdog) drive_.command({});
  move_body();
  drain(to_seconds(Time(physics_step)));
  if (++steps_ % crowd_every != 0) return;
  places_before_.clear();
  for (const auto& person : crowd_.people()) places_before_.push_back(person.position);
  crowd_.step(crowd_dt, seen());
  meet_people();
}

void World::move_body() {
  constexpr double dt = 0.005;
  const Pose next = pose_ * drive_.step(dt);
  const bool moving = std::abs(drive_.ground().linear) > 1e-4 || std::abs(drive_.ground().angular) > 1e-4;
  if (!moving) return;
  const bool forward = drive_.ground().linear >= 0.0;
  const auto wall = touched_wall(body_.footprint, next, walls_);
  const auto hazard = hazards_.touched(body_.footprint, next);
  if (wall) note(ContactKind::fixed, *wall, "map");
  if (hazard) note(ContactKind::hazard, hazard->place, hazard->id);
  const bool held = (wall && !touched_wall(body_.footprint, pose_, walls_)) ||
                    (hazard && hazard->solid && !hazards_.touched(body_.footprint, pose_));
  bumper_front_ = (wall || (hazard && hazard->solid)) && forward;
  bumper_rear_ = (wall || (hazard && hazard->solid)) && !forward;
  stalled_ = held;
  if (held) {
    drive_.block();
    return;
  }
  pose_ = next;
}

// People who overlap the body now: someone is at fault, and the softer one yields.
void World::meet_people() {
  const auto& f = body_.footprint;
  auto& people = crowd_.people();
  const Twist ground = drive_.ground();
  for (std::size_t i = 0; i < people.size(); ++i) {
    Person& person = people[i];
    const Point to = person.position - pose_.position();
    if (dot(to, to) > 9.0) continue;
    const int id = static_cast<int>(i);
    const double brake = body_.drive.max_deceleration;
    if (inevitable(f, pose_, ground, brake, reaction, person.position, person.radius)) {
      const bool stepped_in = !inevitable(f, pose_, ground, brake, reaction, places_before_[i], person.radius);
      if (stepped_in) cut_in_[id] = now_;
    }
    const Nearest touch = nearest_place(f, pose_, person.position);
    if (touch.distance >= person.radius) continue;
    const auto cut = cut_in_.find(id);
    const bool cut_in = cut != cut_in_.end() && now_ - cut->second < cut_in_lasts &&
                        std::abs(drive_.wanted().linear) < std::abs(ground.linear) + 0.01;
    const bool robots = !cut_in && robot_at_fault(f, pose_, ground, person, person.velocity);
    note(robots ? ContactKind::person_robot_fault : ContactKind::person_own_fault, touch.place,
         "person " + std::to_string(i));
    const Point out = touch.distance > 1e-6 ? (1.0 / touch.distance) * (person.position - touch.place)
                                            : (1.0 / std::max(1e-6, distance(person.position, pose_.position()))) *
                                                  (person.position - pose_.position());
    const Point aside = person.position + (person.radius - touch.distance + 1e-3) * out;
    if (walls_.clearance(aside) > 0.1) person.position = aside;
  }
}

void World::note(ContactKind kind, Point place, const std::string& with) {
  const auto [entry, fresh] = touching_.try_emplace(with, now_);
  const bool again = !fresh && now_ - entry->second > touch_ends;
  entry->second = now_;
  if (fresh || again) contacts_.push_back({now_, kind, place, pose_, drive_.ground(), with});
}

void World::drain(double dt) {
  const bool docked = distance(pose_.position(), museum_.home.position()) < 0.5 && drive_.wheels() == Twist{};
  const double watts = docked ? -charger_watts : idle_watts + watts_per_mps * std::abs(drive_.wheels().linear);
  battery_ = std::clamp(battery_ - watts * dt / 3600.0 / capacity_wh, 0.0, 1.0);
}

void World::sense(std::vector<Input>& events) {
  if (config_.base_period.count() > 0.0 && now_ >= next_base_) {
    next_base_ = next_base_ + config_.base_period;
    events.push_back({now_, odometry()});
    events.push_back({now_, base()});
    events.push_back({now_, sonars()});
  }
  if (config_.laser_period.count() <= 0.0) return;
  if (now_ >= next_front_) {
    next_front_ = next_front_ + config_.laser_period;
    events.push_back({now_, scan(LaserId::front)});
  }
  if (body_.lasers.size() > 1 && now_ >= next_rear_) {
    next_rear_ = next_rear_ + config_.laser_period;
    events.push_back({now_, scan(LaserId::rear)});
  }
}

LaserScan World::scan(LaserId laser) { return sensors_.scan(laser, walls_, crowd_.people(), pose_, now_); }

SonarScan World::sonars() { return sensors_.sonars(walls_, crowd_.people(), pose_, now_); }

Odometry World::odometry() const { return {now_, drive_.odometry(), drive_.wheels()}; }

BaseState World::base() const {
  BaseState state{.time = now_};
  const double load = 0.15 * std::abs(drive_.wheels().linear);
  state.battery_volts = 11.6 + 1.2 * battery_ - load;  // a 12 V lead battery
  state.battery_fraction = battery_;
  state.motors_enabled = motors_;
  state.emergency_stop = emergency_stop_;
  state.stalled = stalled_;
  state.bumper_front = bumper_front_;
  state.bumper_rear = bumper_rear_;
  return state;
}

}  // namespace robot::simulation
