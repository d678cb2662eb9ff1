#include "robot/localization/monte_carlo.hpp"

#include <gmock/gmock.h>
#include <rapidcheck.h>

#include <numeric>

#include "tests/support/matchers.hpp"

namespace robot {
namespace {

using testing::PoseNear;

MotionNoise no_noise() {
  MotionNoise noise{0, 0, 0, 0, 0, 0};
  noise.slip_share = 0.0;
  return noise;
}

double total(const MonteCarlo& filter) {
  const auto& w = filter.particles().weight;
  return std::accumulate(w.begin(), w.end(), 0.0);
}

MonteCarlo started(const std::vector<Seed>& seeds, MonteCarloConfig config = {}) {
  MonteCarlo filter(config, Random(7));
  filter.start(seeds);
  return filter;
}

TEST(Kld, GivesThePublishedNumbers) {
  EXPECT_NEAR(kld_samples(10, 0.05, 2.326), 217, 1);
  EXPECT_NEAR(kld_samples(100, 0.05, 2.326), 1347, 1);
  EXPECT_NEAR(kld_samples(1000, 0.05, 2.326), 11060, 2);
  EXPECT_NEAR(kld_samples(50, 0.02, 2.326), 1874, 1);
  EXPECT_EQ(kld_samples(1, 0.05, 2.326), 1);
  EXPECT_EQ(kld_samples(0, 0.05, 2.326), 1);
}

TEST(MonteCarlo, StartsAsAGaussian) {
  const auto filter = started({{{3.0, -2.0, 3.1}, 0.1, 0.05, 1.0}}, {.min_particles = 5000});
  const auto clusters = filter.clusters();
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_THAT(clusters[0].mean, PoseNear(Pose{3.0, -2.0, 3.1}, 0.01));
  EXPECT_NEAR(std::sqrt(clusters[0].covariance(0, 0)), 0.1, 0.005);
  EXPECT_NEAR(std::sqrt(clusters[0].covariance(2, 2)), 0.05, 0.003);
  EXPECT_NEAR(clusters[0].mass, 1.0, 1e-9);
}

TEST(MonteCarlo, KeepsModesApartWithTheirMasses) {
  const auto filter = started({{{0.0, 0.0, 0.0}, 0.1, 0.02, 3.0}, {{10.0, 0.0, 1.0}, 0.1, 0.02, 1.0}});
  const auto clusters = filter.clusters();
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_NEAR(clusters[0].mass, 0.75, 1e-6);
  EXPECT_THAT(clusters[0].mean, PoseNear(Pose{0.0, 0.0, 0.0}, 0.02));
  EXPECT_THAT(clusters[1].mean, PoseNear(Pose{10.0, 0.0, 1.0}, 0.02));
}

TEST(MonteCarlo, WithoutNoiseEverySampleMovesExactly) {
  auto filter = started({{{1.0, 2.0, 0.5}, 0.0, 0.0, 1.0}});
  const Pose step{0.7, 0.1, 0.3};
  filter.predict({step, 0.0, 0.0}, no_noise());
  for (std::size_t i = 0; i < filter.particles().size(); ++i) {
    EXPECT_THAT(filter.particles().pose(i), PoseNear(Pose{1.0, 2.0, 0.5} * step, 1e-12));
  }
}

TEST(MonteCarlo, DrawsMoreSamplesWhenTheySpread) {
  auto filter = started({{{}, 0.05, 0.02, 1.0}});
  EXPECT_EQ(filter.particles().size(), 500u);
  MotionNoise noise;
  noise.rotation_from_translation = 0.3;
  filter.predict({{8.0, 0.0, 0.0}, 8.0, 0.0}, noise);
  EXPECT_GT(filter.particles().size(), 1500u);
  EXPECT_NEAR(total(filter), 1.0, 1e-9);
}

TEST(MonteCarlo, NeedsFewerSamplesWhenTheyAgree) {
  auto filter = started({{{}, 3.0, 1.0, 1.0}}, {.min_particles = 500, .max_particles = 5000});
  filter.predict({}, no_noise());
  ASSERT_GT(filter.particles().size(), 2000u);
  std::vector<float> fit;
  for (std::size_t i = 0; i < filter.particles().size(); ++i) {
    const Pose p = filter.particles().pose(i);
    fit.push_back(static_cast<float>(-(p.x * p.x + p.y * p.y) / 0.02 - p.theta * p.theta / 0.01));
  }
  filter.weigh(fit);
  filter.resample_when_uneven();
  EXPECT_LT(filter.particles().size(), 1000u);
}

TEST(MonteCarlo, EvenWeightsAreNotResampled) {
  auto filter = started({{{}, 0.1, 0.02, 1.0}});
  const auto before = filter.particles().x;
  filter.weigh(std::vector<float>(before.size(), -3.0f));
  filter.resample_when_uneven();
  EXPECT_EQ(filter.particles().x, before);
}

TEST(MonteCarlo, DrawsInProportionToTheWeights) {
  auto filter = started({{{0.0, 0.0, 0.0}, 0.0, 0.0, 7.0}, {{5.0, 0.0, 0.0}, 0.0, 0.0, 3.0}});
  int left = 0;
  for (const Pose& pose : filter.draw(100)) left += pose.x < 1.0 ? 1 : 0;
  EXPECT_EQ(left, 70);
}

TEST(MonteCarlo, InfusedSamplesAreAShareOfTheBelief) {
  auto filter = started({{{0.0, 0.0, 0.0}, 0.1, 0.02, 1.0}});
  filter.infuse({{8.0, 0.0, 0.0}, 0.1, 0.02, 1.0}, 0.2);
  const auto clusters = filter.clusters();
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_NEAR(clusters[1].mass, 0.2, 0.04);
  EXPECT_NEAR(total(filter), 1.0, 1e-9);
}

// Whatever scans say, the belief stays a probability.
TEST(MonteCarlo, WeightsAlwaysSumToOne) {
  EXPECT_TRUE(rc::check([] {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    MonteCarlo filter({.min_particles = 100, .max_particles = 400}, random.split());
    const Seed seed{{}, random.uniform(0.0, 2.0), random.uniform(0.0, 1.0), 1.0};
    filter.start({&seed, 1});
    for (int k = 0; k < 10; ++k) {
      filter.predict({{random.uniform(-1, 1), 0.0, random.uniform(-1, 1)}, 1.0, 1.0}, {});
      std::vector<float> fit(filter.particles().size());
      for (auto& f : fit) f = static_cast<float>(-random.uniform(0.0, *rc::gen::element(0.0, 1.0, 100.0, 1e6)));
      filter.weigh(fit);
      RC_ASSERT(std::abs(total(filter) - 1.0) < 1e-9);
      filter.resample_when_uneven();
      RC_ASSERT(std::abs(total(filter) - 1.0) < 1e-9);
      RC_ASSERT(filter.particles().size() >= 100u && filter.particles().size() <= 400u);
    }
  }));
}

}  // namespace
}  // namespace robot
