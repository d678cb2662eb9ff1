#include "robot/localization/motion_model.hpp"

#include <algorithm>

namespace robot {

MotionSpread spread_of(const MotionStep& step, const MotionNoise& noise) {
  const double path = std::max(step.path, norm(step.moved.position()));
  const double turned = std::max(step.turned, std::abs(step.moved.theta));
  const auto square = [](double v) { return v * v; };
  MotionSpread spread;
  spread.rotation = std::sqrt(square(noise.rotation_from_rotation * turned) +
                              square(noise.rotation_from_translation) * path + square(noise.rotation_floor));
  spread.stretch = noise.translation_from_translation;
  spread.translation = std::hypot(noise.translation_from_rotation * turned, noise.translation_floor);
  return spread;
}

Pose sample_motion(const Pose& from, const MotionStep& step, const MotionSpread& spread, Random& random) {
  const double before = random.normal(spread.rotation * std::numbers::sqrt2 / 2);
  const double after = random.normal(spread.rotation * std::numbers::sqrt2 / 2);
  const double stretch = 1.0 + random.normal(spread.stretch);
  const Pose noisy_start{from.x, from.y, from.theta + before};
  const Point to = noisy_start * Point{stretch * step.moved.x + random.normal(spread.translation),
                                       stretch * step.moved.y + random.normal(spread.translation)};
  return {to.x, to.y, wrap_angle(from.theta + before + step.moved.theta + after)};
}

}  // namespace robot
