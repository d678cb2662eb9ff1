#include "robot/localization/localizer.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <optional>

#include "robot/geometry/ray_cast.hpp"
#include "robot/localization/beams.hpp"

namespace robot {

double Estimate::sigma_position() const {
  const Eigen::Matrix2d block = covariance.topLeftCorner<2, 2>();
  const auto values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(block, Eigen::EigenvaluesOnly).eigenvalues();
  return std::sqrt(std::max(0.0, values[1]));
}
double Estimate::sigma_theta() const { return std::sqrt(std::max(0.0, covariance(2, 2))); }

struct Localizer::Parts {
  Parts(const OccupancyGrid& grid, LocalizerConfig c, std::uint64_t seed)
      : config(c), field(grid, c.likelihood), caster(grid), random(seed), filter(c.particles, random.split()) {}

  LocalizerConfig config;
  LikelihoodField field;
  RayCaster caster;
  Random random;
  MonteCarlo filter;
  std::optional<Pose> odom_now;   // newest odometry
  std::optional<Pose> odom_then;  // odometry at the belief's time
  MotionStep since;               // way and turns since then
  Time weighed_at;
  Pose mean;  // at the belief's time
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  int modes = 0;
  double mass = 0.0;

  void summarize() {
    const auto clusters = filter.clusters();
    modes = 0;
    for (const auto& c : clusters) modes += c.mass > 0.05 ? 1 : 0;
    if (clusters.empty()) return;
    mean = clusters[0].mean;
    covariance = clusters[0].covariance;
    mass = clusters[0].mass;
  }

  ScanReading read(const LaserScan& scan, const Pose& map_from_laser) const {
    ScanReading reading{map_from_laser, {}, {}, false};
    for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
      const double angle = map_from_laser.theta + scan.angle_min + static_cast<double>(i) * scan.angle_step;
      const auto expected = static_cast<float>(caster.cast(map_from_laser.position(), angle, scan.max_range));
      const float range = scan.ranges[i];
      reading.expected.push_back(expected);
      if (!is_return(range, scan.max_range)) {
        reading.kinds.push_back(BeamKind::no_return);
      } else if (range < expected - 0.3f) {
        reading.kinds.push_back(BeamKind::person);
      } else {
        reading.kinds.push_back(range > expected + 0.3f ? BeamKind::unexpected_far : BeamKind::map);
      }
    }
    return reading;
  }
};

Localizer::Localizer(const OccupancyGrid& map, LocalizerConfig config, std::uint64_t seed)
    : parts_(std::make_unique<Parts>(map, config, seed)) {}
Localizer::~Localizer() = default;
Localizer::Localizer(Localizer&&) noexcept = default;
Localizer& Localizer::operator=(Localizer&&) noexcept = default;

void Localizer::start_at(const Pose& map_from_base, double sigma_position, double sigma_theta) {
  if (!is_finite(map_from_base)) return;
  const Seed seed{map_from_base, sigma_position, sigma_theta, 1.0};
  parts_->filter.start({&seed, 1});
  parts_->odom_then = parts_->odom_now;
  parts_->since = {};
  parts_->summarize();
}

void Localizer::start_globally() {}

void Localizer::move(const Pose& odom_from_base, Time) {
  if (!is_finite(odom_from_base)) return;
  Parts& p = *parts_;
  if (p.odom_now) {
    const Pose step = relative(*p.odom_now, odom_from_base);
    p.since.path += norm(step.position());
    p.since.turned += std::abs(step.theta);
  }
  p.odom_now = odom_from_base;
  if (!p.odom_then) p.odom_then = odom_from_base;
}

ScanReading Localizer::update(const LaserScan& scan, const Pose& base_from_laser, const Pose& odom_from_base) {
  Parts& p = *parts_;
  if (!p.odom_then) move(odom_from_base, scan.time);
  p.since.moved = relative(*p.odom_then, odom_from_base);
  const bool moved = norm(p.since.moved.position()) > p.config.update_after_metres ||
                     std::abs(p.since.moved.theta) > p.config.update_after_turn;
  bool weighed = false;
  if (moved || scan.time - p.weighed_at >= p.config.update_after_rest) {
    p.filter.predict(p.since, p.config.motion);
    const int stride = std::max(1, static_cast<int>(scan.ranges.size()) / p.config.beams);
    std::vector<Point> ends;
    for (const auto& beam : beams_of(scan, base_from_laser, 0, stride).beams) ends.push_back(beam.end);
    const Particles& particles = p.filter.particles();
    std::vector<float> log_likelihood(particles.size());
    p.field.weigh(particles.x, particles.y, particles.theta, ends, log_likelihood);
    p.filter.weigh(log_likelihood);
    p.summarize();
    p.filter.resample_when_uneven();
    p.odom_then = odom_from_base;
    p.since = {};
    p.weighed_at = scan.time;
    weighed = true;
  }
  const Pose map_from_base = p.mean * relative(*p.odom_then, odom_from_base);
  ScanReading reading = p.read(scan, map_from_base * base_from_laser);
  reading.weighed = weighed;
  return reading;
}

bool Localizer::work(int) { return false; }

Estimate Localizer::estimate() const {
  const Parts& p = *parts_;
  Estimate e;
  e.map_from_base = p.odom_now && p.odom_then ? p.mean * relative(*p.odom_then, *p.odom_now) : p.mean;
  e.covariance = p.covariance;
  e.particles = static_cast<int>(p.filter.particles().size());
  e.modes = p.modes;
  e.localized = p.mass > 0.9;
  return e;
}

std::vector<Pose> Localizer::samples(int at_most) const {
  return parts_->filter.draw(std::min(at_most, static_cast<int>(parts_->filter.particles().size())));
}

}  // namespace robot
