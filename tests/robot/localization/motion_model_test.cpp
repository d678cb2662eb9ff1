#include "robot/localization/motion_model.hpp"

#include <gmock/gmock.h>
#include <rapidcheck.h>

#include "tests/support/matchers.hpp"

namespace robot {
namespace {

using testing::PoseNear;

MotionNoise no_noise() {
  MotionNoise noise{0, 0, 0, 0, 0, 0};
  noise.slip_share = 0.0;
  return noise;
}

MotionNoise noise_of(double rotation_from_rotation, double rotation_from_translation, double translation) {
  MotionNoise noise = no_noise();
  noise.rotation_from_rotation = rotation_from_rotation;
  noise.rotation_from_translation = rotation_from_translation;
  noise.translation_from_translation = translation;
  return noise;
}

struct Spread {
  double mean_x = 0, sigma_x = 0, sigma_y = 0, sigma_theta = 0;
};

Spread spread_after(const std::vector<MotionStep>& steps, const MotionNoise& noise) {
  Random random(3);
  constexpr int count = 20000;
  double x = 0, xx = 0, yy = 0, tt = 0;
  for (int i = 0; i < count; ++i) {
    Pose pose;
    for (const auto& step : steps) pose = sample_motion(pose, step, spread_of(step, noise), random).pose;
    x += pose.x / count;
    xx += pose.x * pose.x / count;
    yy += pose.y * pose.y / count;
    tt += pose.theta * pose.theta / count;
  }
  return {x, std::sqrt(xx - x * x), std::sqrt(yy), std::sqrt(tt)};
}

TEST(MotionModel, WithoutNoiseIsExact) {
  EXPECT_TRUE(rc::check([] {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const auto pose = [&] { return Pose{random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-pi, pi)}; };
    const Pose from = pose();
    const MotionStep step{pose(), 0.0, 0.0};
    const Pose sample = sample_motion(from, step, spread_of(step, no_noise()), random).pose, exact = from * step.moved;
    RC_ASSERT(distance(sample.position(), exact.position()) < 1e-12);
    RC_ASSERT(std::abs(wrap_angle(sample.theta - exact.theta)) < 1e-12);
  }));
}

TEST(MotionModel, AtRestOnlyTheFloorIsLeft) {
  MotionNoise noise;
  noise.slip_share = 0.0;
  const Spread spread = spread_after({MotionStep{}}, noise);
  EXPECT_NEAR(spread.sigma_x, noise.translation_floor, 0.05 * noise.translation_floor);
  EXPECT_NEAR(spread.sigma_theta, noise.rotation_floor, 0.05 * noise.rotation_floor);
}

TEST(MotionModel, SpreadsAsConfigured) {
  const MotionNoise noise = noise_of(0.0, 0.04, 0.1);
  const Spread spread = spread_after({MotionStep{{1.0, 0.0, 0.0}, 1.0, 0.0}}, noise);
  EXPECT_NEAR(spread.mean_x, 1.0, 0.01);
  EXPECT_NEAR(spread.sigma_x, 0.1, 0.005);                             // alpha3
  EXPECT_NEAR(spread.sigma_theta, 0.04, 0.002);                        // alpha2
  EXPECT_NEAR(spread.sigma_y, 0.04 * std::numbers::sqrt2 / 2, 0.002);  // the half that acts before the translation
}

TEST(MotionModel, TurningSpreadsTheHeading) {
  const MotionNoise noise = noise_of(0.1, 0.0, 0.0);
  Random random(5);
  double square = 0.0;
  const MotionStep step{{0.0, 0.0, 1.0}, 0.0, 1.0};
  for (int i = 0; i < 20000; ++i) {
    const double off = wrap_angle(sample_motion({}, step, spread_of(step, noise), random).pose.theta - 1.0);
    square += off * off / 20000;
  }
  EXPECT_NEAR(std::sqrt(square), 0.1, 0.005);
}

TEST(MotionModel, HeadingNoiseDoesNotDependOnHowOftenOdometryIsRead) {
  const MotionNoise noise = noise_of(0.0, 0.04, 0.0);
  const std::vector<MotionStep> once{{{2.0, 0.0, 0.0}, 2.0, 0.0}}, often(20, {{0.1, 0.0, 0.0}, 0.1, 0.0});
  EXPECT_NEAR(spread_after(often, noise).sigma_theta, spread_after(once, noise).sigma_theta, 0.002);
}

TEST(MotionModel, AWayThereAndBackIsNotCertain) {
  MotionNoise noise;
  noise.slip_share = 0.0;
  const MotionStep there_and_back{{}, 4.0, 2 * pi};
  const auto spread = spread_of(there_and_back, noise);
  EXPECT_GT(spread.rotation, noise.rotation_from_rotation * 2 * pi);
}

TEST(MotionModel, SlippingSamplesReachEveryPartOfTheStep) {
  MotionNoise noise = no_noise();
  noise.slip_share = 0.5;
  Random random(1);
  const MotionStep step{{1.0, 0.0, 0.0}, 1.0, 0.0};
  int whole = 0, backwards = 0;
  for (int i = 0; i < 10000; ++i) {
    const double x = sample_motion({}, step, spread_of(step, noise), random).pose.x;
    EXPECT_LE(std::abs(x), 1.0);
    whole += x == 1.0 ? 1 : 0;
    backwards += x < 0.0 ? 1 : 0;
  }
  EXPECT_NEAR(whole, 5000, 200);
  EXPECT_NEAR(backwards, 2500, 200);
}

TEST(MotionModel, SlippingSamplesWeighAsMuchAsSlippingIsProbable) {
  MotionNoise noise = no_noise();
  noise.slip_share = 0.5;
  noise.slip_rate = 0.05;
  Random random(1);
  const MotionStep step{{2.0, 0.0, 0.0}, 2.0, 0.0};
  double all = 0.0, slipped = 0.0, mean = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const MotionSample sample = sample_motion({}, step, spread_of(step, noise), random);
    all += sample.weight / 20000;
    slipped += sample.pose.x < 2.0 ? sample.weight / 20000 : 0.0;
    mean += sample.weight * sample.pose.x / 20000;
  }
  const double probable = 1.0 - std::exp(-0.05 * 2.0);
  EXPECT_NEAR(all, 1.0, 0.02);
  EXPECT_NEAR(slipped, probable, 0.005);
  EXPECT_NEAR(mean, 2.0 * (1.0 - probable), 0.03);
}

}  // namespace
}  // namespace robot
