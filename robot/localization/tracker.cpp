#include "robot/localization/tracker.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <limits>

namespace robot {
namespace {

// What no scan tells: how far a map is off from the building. From recorded logs against their references.
constexpr double map_sigma_position = 0.02, map_sigma_theta = 0.008;  // m, rad

constexpr double anywhere = 1e3;  // a metre: slipping samples weigh like all others

// What is left unsaid by samples that are few and by a map that is not perfect.
Eigen::Matrix3d with_floor(Eigen::Matrix3d covariance, double metres, double angle) {
  covariance.diagonal() += Eigen::Vector3d(metres * metres, metres * metres, angle * angle);
  return covariance;
}

}  // namespace

double position_sigma(const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix2d block = covariance.topLeftCorner<2, 2>();
  const auto values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(block, Eigen::EigenvaluesOnly).eigenvalues();
  return std::sqrt(std::max(0.0, values[1]));
}

double heading_sigma(const Eigen::Matrix3d& covariance) { return std::sqrt(std::max(0.0, covariance(2, 2))); }

Tracker::Tracker(const OccupancyGrid& map, const LocalizerConfig& config, Random random)
    : config_(config),
      map_(map),
      field_(map_, config.likelihood, config.surface_offset),
      caster_(map_),
      reader_(caster_, field_, config.reading),
      random_(random),
      filter_(config.particles, random_.split()),
      offset_(config.surface_offset) {}

void Tracker::start(std::span<const Seed> seeds) {
  filter_.start(seeds);
  found_ = false;
  if (odom_now_) forget_motion(*odom_now_);
  usual_far_ = last_far_ = 0.05;
  summarize();
}

void Tracker::start_anywhere() {
  std::vector<Pose> everywhere;
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < map_.size(); ++i) {
    if (is_free(map_.cells()[i])) open.push_back(i);
  }
  for (int i = 0; i < config_.particles.max_particles && !open.empty(); ++i) {
    const Point at = map_.center(map_.cell_at(open[random_.index(open.size())]));
    everywhere.push_back({at.x, at.y, random_.uniform(-pi, pi)});
  }
  filter_.start_from(everywhere);
  found_ = false;
  if (odom_now_) forget_motion(*odom_now_);
  summarize();
}

void Tracker::move(const Pose& odom_from_base) {
  if (odom_now_) {
    const Pose step = relative(*odom_now_, odom_from_base);
    since_.path += norm(step.position());
    since_.turned += std::abs(step.theta);
  }
  odom_now_ = odom_from_base;
  if (odom_then_) return;
  odom_then_ = odom_from_base;
  pose_odom_ = odom_from_base;
}

void Tracker::forget_motion(const Pose& odom) {
  odom_then_ = odom;
  since_ = {};
}

// Brings the samples up to an odometry.
void Tracker::advance(const Pose& odom) {
  since_.moved = relative(*odom_then_, odom);
  MotionNoise noise = config_.motion;
  if (!found_) noise.slip_rate = anywhere;  // a place that is not quite right must be free to creep to the right one
  filter_.predict(since_, noise);
  forget_motion(odom);
}

void Tracker::summarize() {
  const auto clusters = filter_.clusters();
  modes_ =
      static_cast<int>(std::count_if(clusters.begin(), clusters.end(), [](const auto& c) { return c.mass > 0.05; }));
  best_ = clusters.empty() ? Cluster{} : clusters.front();
  pose_ = best_.mean;
  pose_odom_ = odom_then_.value_or(Pose{});
  covariance_ = best_.covariance;
  predicted_covariance_ = best_.covariance;
}

// A thinned scan, a different comb of beams each time.
Beams Tracker::comb(const LaserScan& scan, const Pose& base_from_laser) const {
  const int stride = std::max(1, (static_cast<int>(scan.ranges.size()) + config_.beams - 1) / config_.beams);
  return beams_of(scan, base_from_laser, weighed_ % stride, stride);
}

// The beams to weigh the samples by: those that did not surely meet somebody, and some that nobody asks about.
std::vector<Point> Tracker::trusted_ends(const Beams& beams) {
  const std::vector<Pose> belief = filter_.draw(config_.filter_samples, random_.uniform());
  std::vector<Point> result;
  for (const Beam& beam : beams.beams) {
    const bool untested = random_.chance(config_.unfiltered_share);
    if (untested || !reader_.is_short(beam, beams.origin, belief)) result.push_back(beam.end);
  }
  return result;
}

// What an end in unknown space costs. `telling` are the ends that meet known cells from the belief's mean.
void Tracker::price_unknown(std::span<const Point> telling, const Pose& mean) {
  field_.set_unknown_cost(std::numeric_limits<double>::max());
  if (!sure_ || position_sigma(best_.covariance) > 0.3 || telling.empty()) return;
  // Driving off the map must not cost much more than staying: else samples that stay behind win against the wheels.
  const double usual = -field_.log_likelihood(mean, telling) / static_cast<double>(telling.size());
  field_.set_unknown_cost(config_.unknown_cost * usual);
}

// How much a scan counts where the map is not what is there. Samples take each scan for news, but a door or a cupboard
// that has moved tells scan after scan the same untruth, and along a corridor little speaks against it.
double Tracker::trust(const Cluster& before) const {
  const bool tracked = found_ && before.mass > 0.9 && position_sigma(before.covariance) < 0.3;
  if (!tracked || match_fit_ <= 0.0) return 1.0;
  const double fit = std::min(1.0, match_fit_ / config_.match_fit);
  return std::max(config_.least_trust, fit * fit);
}

// `once_more`: the belief was found wrong, and the scan that showed it counts in full.
void Tracker::weigh(const Beams& beams, double temper, bool once_more) {
  std::vector<Point> ends = trusted_ends(beams);
  const Cluster before = filter_.clusters().front();
  const auto unknown = std::partition(ends.begin(), ends.end(), [&](Point e) { return field_.tells(before.mean * e); });
  const std::span<const Point> telling(ends.begin(), unknown);
  // Beyond the map's rim chance hits would pull the belief back: there the wheels know better.
  const double known = ends.empty() ? 0.0 : static_cast<double>(telling.size()) / static_cast<double>(ends.size());
  if (position_sigma(before.covariance) < 1.0) temper *= known * known;
  if (!once_more) temper *= trust(before);
  price_unknown(telling, before.mean);
  const Particles& particles = filter_.particles();
  std::vector<float> log_likelihood(particles.size());
  field_.weigh(particles.x, particles.y, particles.theta, ends, log_likelihood);
  for (auto& value : log_likelihood) value *= static_cast<float>(temper);
  filter_.weigh(log_likelihood);
  summarize();
  if (modes_ <= 1) predicted_covariance_ = before.covariance;
  filter_.resample_when_uneven();
  ++weighed_;
}

// All that a scan does to the belief.
void Tracker::take_in(const LaserScan& scan, const Pose& base_from_laser, const Pose& odom, double temper) {
  const Beams beams = comb(scan, base_from_laser);
  advance(odom);
  weigh(beams, temper);
  const bool agrees = refine(scan, base_from_laser, odom);
  // Where the map is wrong, the nearest walls are not those that were seen: the belief must not be drawn to them.
  const bool teaches = agrees && (!found_ || match_fit_ >= config_.match_fit);
  if (teaches && position_sigma(covariance_) < 0.3) {
    filter_.infuse({pose_, position_sigma(covariance_), heading_sigma(covariance_), 1.0}, config_.match_share);
  }
  if (!doubt(beams, read(scan, pose_ * base_from_laser))) return;
  weigh(beams, 1.0, true);
  refine(scan, base_from_laser, odom);
}

ScanReading Tracker::read(const LaserScan& scan, const Pose& map_from_laser) const {
  return reader_.read(scan, map_from_laser, position_sigma(covariance_), heading_sigma(covariance_));
}

// The estimate between the samples: the scan aligned with the map, held by the belief. False when the scan fits well
// only where the belief is not.
bool Tracker::refine(const LaserScan& scan, const Pose& base_from_laser, const Pose& odom) {
  const Pose predicted = best_.mean * relative(*odom_then_, odom);
  const Eigen::Matrix3d prior = with_floor(predicted_covariance_, 0.01, 0.005);
  pose_ = predicted;
  pose_odom_ = odom;
  covariance_ = with_floor(best_.covariance, map_sigma_position, map_sigma_theta);
  match_fit_ = 0.0;
  if (position_sigma(best_.covariance) > 0.5) return true;
  const int stride = std::max(1, (static_cast<int>(scan.ranges.size()) + 180) / 181);
  Beams beams = beams_of(scan, base_from_laser, 0, stride);
  // Only ends near a surface can say where it is; no ray needs to be cast for that.
  const double slack = config_.reading.tolerance + 2.0 * position_sigma(covariance_);
  std::erase_if(beams.beams, [&](const Beam& beam) {
    const Point end = predicted * beam.end;
    return !field_.tells(end) || interpolate(field_.distances(), end).value > slack;
  });
  if (beams.beams.size() < 10) return true;
  const ScanMatch match =
      match_scan(field_.distances(), field_.surface_offset(), beams.beams, predicted, prior, config_.match);
  match_fit_ = match.fit;
  const Eigen::Vector3d off(match.pose.x - predicted.x, match.pose.y - predicted.y,
                            wrap_angle(match.pose.theta - predicted.theta));
  if (match.fit < 0.3 || off.dot(prior.inverse() * off) > 16.0) return false;
  pose_ = match.pose;
  covariance_ = with_floor(match.covariance, map_sigma_position, map_sigma_theta);
  learn_offset(match);
  return true;
}

bool Tracker::surprising(const ScanReading& reading) const {
  return count_beams(reading).far_share() >= std::max(usual_far_, last_far_) + config_.doubt_above;
}

// Augmented MCL (Thrun et al., "Probabilistic Robotics", table 8.3) with a local proposal: when more beams than usual
// are longer than the map allows, which people cannot cause, or the belief had spread on a blind stretch, some samples
// are drawn where the scan would fit. Only a place that explains the scan by far better counts: along a corridor with
// open doors, or on a map that somebody drew, many places explain it a little better than the true one. True then, and
// the scan is to be weighed once more.
bool Tracker::doubt(const Beams& beams, const ScanReading& reading) {
  last_far_ = count_beams(reading).far_share();
  if (map_.empty() || position_sigma(best_.covariance) > 0.5 || beams.beams.size() < 10) return false;
  const bool contradicted = last_far_ >= usual_far_ + config_.doubt_above;
  if (!contradicted) usual_far_ += 0.02 * (last_far_ - usual_far_);
  const bool vague = position_sigma(predicted_covariance_) > config_.doubt_blind;
  if (!contradicted && !vague) return false;
  const Look look{{beams}};
  // The end points alone would look through walls to find a place; the beam model does not.
  const Peak here = judge_place(caster_, field_, look, best_.mean);
  if (here.share >= config_.doubt_explains) return false;
  const Pose nearby = search_nearby(field_, beams.beams, best_.mean, config_.match).pose;
  const Peak there = judge_place(caster_, field_, look, nearby);
  if (there.share < config_.doubt_explains || there.score < here.score + config_.doubt_gain) return false;
  filter_.infuse({nearby, 0.05, 0.02, 1.0}, config_.doubt_share);
  last_far_ = usual_far_;
  return true;
}

void Tracker::learn_offset(const ScanMatch& match) {
  if (!config_.learn_surface_offset || !sure_ || match.fit < 0.6 || match.beams < 30.0) return;
  const double gain = std::max(0.02, 1.0 / (10.0 + offsets_learned_++));
  offset_ = std::clamp(offset_ + gain * match.residual, -0.5 * map_.resolution(), map_.resolution());
  if (std::abs(offset_ - field_.surface_offset()) > 0.001) field_.set_surface_offset(offset_);
}

std::vector<Pose> Tracker::samples(int at_most) const {
  std::vector<Pose> poses = filter_.draw(std::min(at_most, particles()));
  if (!odom_now_) return poses;
  const Pose step = relative(*odom_then_, *odom_now_);
  for (Pose& pose : poses) pose = pose * step;
  return poses;
}

}  // namespace robot
