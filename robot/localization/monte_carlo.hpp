// Monte Carlo localization: the belief as weighted samples (Thrun et al., "Probabilistic Robotics", table 8.3), their
// number adapted by KLD-sampling (Fox 2003), resampled systematically and only when the weights have become uneven.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "robot/geometry/pose.hpp"
#include "robot/geometry/random.hpp"
#include "robot/localization/motion_model.hpp"
#include "robot/localization/pose_bins.hpp"

namespace robot {

struct MonteCarloConfig {
  int min_particles = 500;
  int max_particles = 5000;
  double kld_error = 0.05;      // bound on the Kullback-Leibler distance to the true belief ...
  double kld_quantile = 2.326;  // ... kept with 99 %: a standard normal quantile, not a probability
  double bin_metres = 0.5;
  double bin_radians = radians(10);
  double resample_below = 0.5;  // effective share of the samples
};

// Structure of arrays; map frame, weights sum to one.
struct Particles {
  std::vector<double> x, y, theta, weight;
  std::size_t size() const { return x.size(); }
  Pose pose(std::size_t i) const { return {x[i], y[i], theta[i]}; }
  void resize(std::size_t count);
  void set(std::size_t i, const Pose& pose, double w);
};

// One connected lump of belief.
struct Cluster {
  double mass = 0.0;
  Pose mean;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // x, y, theta; m and rad
};

// A place the robot may be at, as a Gaussian.
struct Seed {
  Pose mean;
  double sigma_position = 0.1;  // m, each axis
  double sigma_theta = 0.05;    // rad
  double mass = 1.0;            // relative to the other seeds
};

// Samples needed so that the error bound holds when the belief fills `bins` boxes (Fox 2003, eq. 7, by Wilson and
// Hilferty). 1 for bins <= 1.
int kld_samples(int bins, double error, double quantile);

class MonteCarlo {
 public:
  MonteCarlo(MonteCarloConfig config, Random random);

  // Forgets everything: samples drawn from the seeds, whose masses must be positive.
  void start(std::span<const Seed> seeds);
  // The same from poses that are given one by one, all of equal weight; at most max_particles are kept.
  void start_from(std::span<const Pose> poses);

  // Replaces this share of the samples, drawn blindly, by samples of the seed.
  void infuse(const Seed& seed, double share);

  // Moves every sample by the step with noise of its own; draws more of them when they spread over more boxes.
  void predict(const MotionStep& step, const MotionNoise& noise);
  // Multiplies the weights by exp(log_likelihood), one a sample, and normalises.
  void weigh(std::span<const float> log_likelihood);
  // Systematic resampling to the KLD number, when the effective share has fallen below the limit or the belief has
  // become so compact that far fewer samples will do.
  void resample_when_uneven();

  double effective_share() const;  // 1 / (N sum w^2)
  // Lumps of belief, the heaviest first.
  std::vector<Cluster> clusters() const;
  // `count` samples of equal weight.
  std::vector<Pose> draw(int count, double offset = 0.5) const;
  const Particles& particles() const { return particles_; }

 private:
  int wanted(int bins) const;
  void resample(const Particles& from, std::size_t count);

  MonteCarloConfig config_;
  Random random_;
  Particles particles_;
  Particles before_;  // scratch
  PoseBins bins_;     // scratch
};

}  // namespace robot
