#include "robot/localization/motion_model.hpp"

#include <algorithm>
#include <cmath>

namespace robot {
namespace {

constexpr double wheel_way_of_turn = 0.3;  // m a rad: half of a usual base's track

}  // namespace

MotionSpread spread_of(const MotionStep& step, const MotionNoise& noise) {
  const double path = std::max(step.path, norm(step.moved.position()));
  const double turned = std::max(step.turned, std::abs(step.moved.theta));
  const auto square = [](double v) { return v * v; };
  MotionSpread spread;
  spread.rotation = std::sqrt(square(noise.rotation_from_rotation * turned) +
                              square(noise.rotation_from_translation) * path + square(noise.rotation_floor));
  spread.stretch = noise.translation_from_translation;
  spread.translation = std::hypot(noise.translation_from_rotation * turned, noise.translation_floor);
  spread.slip_share = noise.slip_share;
  spread.slip_factor = noise.slip_factor;
  if (noise.slip_share > 0.0 && noise.slip_share < 1.0) {
    const double way = path + wheel_way_of_turn * turned;
    const double slips = std::min(noise.slip_share, 1.0 - std::exp(-noise.slip_rate * way));
    spread.slip_weight = slips / noise.slip_share;
    spread.grip_weight = (1.0 - slips) / (1.0 - noise.slip_share);
  }
  return spread;
}

MotionSample sample_motion(const Pose& from, const MotionStep& step, const MotionSpread& spread, Random& random) {
  const bool slips = spread.slip_share > 0.0 && random.chance(spread.slip_share);
  const double wider = slips ? spread.slip_factor : 1.0, part = slips ? random.uniform(-1.0, 1.0) : 1.0;
  const double turn = wider * spread.rotation * std::numbers::sqrt2 / 2;
  const double before = random.normal(turn), after = random.normal(turn);
  const double stretch = part + random.normal(wider * spread.stretch), shift = wider * spread.translation;
  const Point moved{stretch * step.moved.x + random.normal(shift), stretch * step.moved.y + random.normal(shift)};
  const Point to = Pose{from.x, from.y, from.theta + before} * moved;
  return {{to.x, to.y, wrap_angle(from.theta + before + part * step.moved.theta + after)},
          slips ? spread.slip_weight : spread.grip_weight};
}

}  // namespace robot
