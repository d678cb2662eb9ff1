#include "server/tools/replay.hpp"

#include <time.h>

#include <algorithm>

namespace tools {
namespace {

constexpr double search_units_per_second = 2500.0;  // a quarter of a core: a unit is about 0.1 ms
constexpr double longest_search = 1.0;              // s of search between two scans, however long the log was silent

// How unsure a given start pose is: a hand's breadth and a few degrees, as staff would place the robot.
constexpr double start_sigma_position = 0.1;  // m
constexpr double start_sigma_theta = 0.05;    // rad

// This thread's processor time: what a scan costs, however busy the machine is with other things.
class Stopwatch {
 public:
  double ms() const { return now_ms() - begun_; }

 private:
  static double now_ms() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
  }
  double begun_ = now_ms();
};

}  // namespace

Replay::Replay(ReplaySetup setup)
    : setup_(std::move(setup)),
      localizer_(std::make_unique<robot::Localizer>(setup_.map, setup_.localizer, setup_.seed)),
      drive_(hull_of(setup_.windows)),
      truth_(files::poses_of_scans(setup_.log, setup_.truth)) {
  if (setup_.start) {
    localizer_->start_at(*setup_.start, start_sigma_position, start_sigma_theta);
  } else {
    localizer_->start_globally();
  }
}
Replay::~Replay() = default;
Replay::Replay(Replay&&) noexcept = default;
Replay& Replay::operator=(Replay&&) noexcept = default;

bool Replay::next() {
  for (; at_ < setup_.log.entries.size(); ++at_) {
    const auto& entry = setup_.log.entries[at_];
    if (const auto* odometry = std::get_if<robot::Odometry>(&entry)) {
      if (drive_.contains(robot::to_seconds(odometry->time))) move(*odometry);
      continue;
    }
    const auto& logged = std::get<files::LoggedScan>(entry);
    const auto number = scan_++;
    if (!in_any(setup_.windows, robot::to_seconds(logged.scan.time)) || !odometry_) continue;
    take(logged);
    step_.truth = truth_[number];
    ++at_;
    return true;
  }
  return false;
}

void Replay::move(const robot::Odometry& odometry) {
  if (odometry_) {
    step_.path_m += robot::distance(odometry_->odom_from_base.position(), odometry.odom_from_base.position());
  }
  const Stopwatch watch;
  localizer_->move(odometry.odom_from_base, odometry.time);
  pending_ms_ += watch.ms();
  odometry_ = odometry;
}

// The search gets what a live robot would spare for it between two scans, in units of work, so that it does not depend
// on this machine's speed.
void Replay::search_until(double time) {
  const double elapsed = std::clamp(time - searched_until_.value_or(time), 0.0, longest_search);
  searched_until_ = time;
  const Stopwatch watch;
  localizer_->work(static_cast<int>(elapsed * search_units_per_second));
  step_.search_ms = watch.ms();
}

void Replay::take(const files::LoggedScan& logged) {
  step_.time = robot::to_seconds(logged.scan.time);
  search_until(step_.time);
  const Stopwatch watch;
  auto reading = localizer_->update(logged.scan, logged.base_from_laser, odometry_->odom_from_base);
  const auto estimate = localizer_->estimate();
  step_.scan_ms = pending_ms_ + watch.ms();
  pending_ms_ = 0.0;
  step_.weighed = reading.weighed;
  step_.lost = estimate.lost;
  step_.pose = {logged.scan.time,   estimate.map_from_base, estimate.sigma_position(), estimate.sigma_theta(),
                estimate.particles, estimate.localized,     odometry_->twist};
  step_.scan = {logged.scan.time,       logged.scan.laser,  reading.map_from_laser,  logged.scan.angle_min,
                logged.scan.angle_step, logged.scan.ranges, std::move(reading.kinds)};
}

robot::Belief Replay::belief(int at_most) const { return {step_.pose.time, localizer_->samples(at_most)}; }

}  // namespace tools
