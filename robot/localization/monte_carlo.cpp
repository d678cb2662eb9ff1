#include "robot/localization/monte_carlo.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace robot {
namespace {

// Calls use(index) `count` times, each index as often as its weight deserves: one offset in [0, 1), equal steps.
template <typename Use>
void systematic(const std::vector<double>& weight, std::size_t count, double offset, Use use) {
  const double total = std::accumulate(weight.begin(), weight.end(), 0.0);
  const double step = total / static_cast<double>(count);
  double sum = weight.empty() ? 0.0 : weight[0];
  std::size_t i = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double at = (static_cast<double>(k) + offset) * step;
    while (sum < at && i + 1 < weight.size()) sum += weight[++i];
    use(k, i);
  }
}

Pose sample(const Seed& seed, Random& random) {
  return {seed.mean.x + random.normal(seed.sigma_position), seed.mean.y + random.normal(seed.sigma_position),
          wrap_angle(seed.mean.theta + random.normal(seed.sigma_theta))};
}

}  // namespace

void Particles::resize(std::size_t count) {
  x.resize(count);
  y.resize(count);
  theta.resize(count);
  weight.resize(count);
}

void Particles::set(std::size_t i, const Pose& pose, double w) {
  x[i] = pose.x;
  y[i] = pose.y;
  theta[i] = pose.theta;
  weight[i] = w;
}

int kld_samples(int bins, double error, double quantile) {
  if (bins <= 1) return 1;
  const double k = bins - 1, a = 2.0 / (9.0 * k);
  const double root = 1.0 - a + quantile * std::sqrt(a);
  return static_cast<int>(std::ceil(k / (2.0 * error) * root * root * root));
}

MonteCarlo::MonteCarlo(MonteCarloConfig config, Random random)
    : config_(config), random_(random), bins_(config.bin_metres, config.bin_radians) {}

int MonteCarlo::wanted(int bins) const {
  return std::clamp(kld_samples(bins, config_.kld_error, config_.kld_quantile), config_.min_particles,
                    config_.max_particles);
}

void MonteCarlo::start(std::span<const Seed> seeds) {
  particles_.resize(0);
  const auto most = static_cast<std::size_t>(config_.max_particles);
  seeds = seeds.first(std::min(seeds.size(), most));
  double mass = 0.0;
  for (const auto& seed : seeds) mass += seed.mass;
  // Seed by seed, not in turn: systematic resampling would beat against an alternating order.
  for (const auto& seed : seeds) {
    const std::size_t count = std::min(static_cast<std::size_t>(config_.min_particles), most / seeds.size());
    const std::size_t first = particles_.size();
    particles_.resize(first + count);
    const double w = seed.mass / (mass * static_cast<double>(count));
    for (std::size_t i = 0; i < count; ++i) particles_.set(first + i, sample(seed, random_), w);
  }
}

void MonteCarlo::start_from(std::span<const Pose> poses) {
  const std::size_t count = std::min(poses.size(), static_cast<std::size_t>(config_.max_particles));
  particles_.resize(count);
  for (std::size_t i = 0; i < count; ++i) particles_.set(i, poses[i], 1.0 / static_cast<double>(count));
}

void MonteCarlo::infuse(const Seed& seed, double share) {
  const std::size_t size = particles_.size();
  if (size == 0) return;
  const double w = 1.0 / static_cast<double>(size);
  for (auto k = static_cast<std::size_t>(share * static_cast<double>(size)); k > 0; --k) {
    particles_.set(random_.index(size), sample(seed, random_), w);
  }
  const double total = std::accumulate(particles_.weight.begin(), particles_.weight.end(), 0.0);
  for (auto& weight : particles_.weight) weight /= total;
}

void MonteCarlo::predict(const MotionStep& step, const MotionNoise& noise) {
  const MotionSpread spread = spread_of(step, noise);
  before_ = particles_;
  for (int round = 0; round < 3; ++round) {
    bins_.clear();
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      const MotionSample sample = sample_motion(particles_.pose(i), step, spread, random_);
      particles_.set(i, sample.pose, particles_.weight[i] * sample.weight);
      bins_.add(sample.pose);
    }
    const auto count = static_cast<std::size_t>(wanted(bins_.size()));
    if (static_cast<double>(count) < 1.2 * static_cast<double>(particles_.size())) return;
    // They spread over more boxes than their number can fill: once more from before the step, with more of them.
    resample(before_, count);
  }
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const MotionSample sample = sample_motion(particles_.pose(i), step, spread, random_);
    particles_.set(i, sample.pose, particles_.weight[i] * sample.weight);
  }
}

void MonteCarlo::weigh(std::span<const float> log_likelihood) {
  if (particles_.size() == 0) return;
  const float best = *std::max_element(log_likelihood.begin(), log_likelihood.end());
  double total = 0.0;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    particles_.weight[i] *= std::exp(static_cast<double>(log_likelihood[i] - best));
    total += particles_.weight[i];
  }
  if (!(total > 0.0)) {  // every sample's old weight was next to nothing where the scan fits: trust the scan alone
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      particles_.weight[i] = std::exp(static_cast<double>(log_likelihood[i] - best));
      total += particles_.weight[i];
    }
  }
  for (auto& w : particles_.weight) w /= total;
}

double MonteCarlo::effective_share() const {
  double squares = 0.0;
  for (const double w : particles_.weight) squares += w * w;
  return squares > 0.0 ? 1.0 / (squares * static_cast<double>(particles_.size())) : 0.0;
}

void MonteCarlo::resample(const Particles& from, std::size_t count) {
  particles_.resize(count);
  systematic(from.weight, count, random_.uniform(),
             [&](std::size_t k, std::size_t i) { particles_.set(k, from.pose(i), 1.0 / static_cast<double>(count)); });
}

void MonteCarlo::resample_when_uneven() {
  const bool uneven = effective_share() < config_.resample_below;
  if (particles_.size() == 0 || (!uneven && particles_.size() <= static_cast<std::size_t>(config_.min_particles)))
    return;
  // Boxes are counted on what resampling would keep, before the number of samples is known.
  bins_.clear();
  std::size_t last = particles_.size();
  systematic(particles_.weight, particles_.size(), 0.5, [&](std::size_t, std::size_t i) {
    if (i != last) bins_.add(particles_.pose(i));
    last = i;
  });
  const auto count = static_cast<std::size_t>(wanted(bins_.size()));
  if (!uneven && 3 * count > 2 * particles_.size()) return;
  before_ = particles_;
  resample(before_, count);
}

std::vector<Cluster> MonteCarlo::clusters() const {
  PoseBins bins(config_.bin_metres, config_.bin_radians);
  std::vector<int> bin(particles_.size());
  for (std::size_t i = 0; i < particles_.size(); ++i) bin[i] = bins.add(particles_.pose(i));
  const std::vector<int> group = bins.groups();
  const int count = group.empty() ? 0 : *std::max_element(group.begin(), group.end()) + 1;
  struct Sums {
    double mass = 0, x = 0, y = 0, cos = 0, sin = 0;
  };
  std::vector<Sums> sums(static_cast<std::size_t>(count));
  const auto group_of = [&](std::size_t i) {
    return static_cast<std::size_t>(group[static_cast<std::size_t>(bin[i])]);
  };
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    Sums& s = sums[group_of(i)];
    const double w = particles_.weight[i];
    s.mass += w;
    s.x += w * particles_.x[i];
    s.y += w * particles_.y[i];
    s.cos += w * std::cos(particles_.theta[i]);
    s.sin += w * std::sin(particles_.theta[i]);
  }
  std::vector<Cluster> clusters(sums.size());
  for (std::size_t g = 0; g < sums.size(); ++g) {
    const double mass = std::max(sums[g].mass, 1e-300);
    clusters[g].mass = sums[g].mass;
    clusters[g].mean = {sums[g].x / mass, sums[g].y / mass, std::atan2(sums[g].sin, sums[g].cos)};
  }
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    Cluster& c = clusters[group_of(i)];
    const Eigen::Vector3d off(particles_.x[i] - c.mean.x, particles_.y[i] - c.mean.y,
                              wrap_angle(particles_.theta[i] - c.mean.theta));
    c.covariance += particles_.weight[i] / std::max(c.mass, 1e-300) * off * off.transpose();
  }
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const Cluster& a, const Cluster& b) { return a.mass > b.mass; });
  return clusters;
}

std::vector<Pose> MonteCarlo::draw(int count, double offset) const {
  std::vector<Pose> poses;
  if (particles_.size() == 0 || count <= 0) return poses;
  poses.reserve(static_cast<std::size_t>(count));
  systematic(particles_.weight, static_cast<std::size_t>(count), offset,
             [&](std::size_t, std::size_t i) { poses.push_back(particles_.pose(i)); });
  return poses;
}

}  // namespace robot
