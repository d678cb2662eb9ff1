// All of the robot's settings: each module's own struct, by value, with its defaults.
#pragma once

#include <cstdint>
#include <optional>

#include "robot/body.hpp"
#include "robot/geometry/pose.hpp"
#include "robot/localization/localizer.hpp"

namespace robot {

struct Config {
  Body body = standard_body();
  LocalizerConfig localizer;
  std::optional<Pose> start;  // known start pose in the map; none: localize globally
  std::uint64_t seed = 1;
};

}  // namespace robot
