#include "robot/robot.hpp"

namespace robot {

struct Robot::Parts {
  Museum museum;
  Config config;
};

Robot::Robot(Museum museum, Config config)
    : parts_(std::make_unique<Parts>(Parts{std::move(museum), std::move(config)})) {}
Robot::~Robot() = default;
Robot::Robot(Robot&&) noexcept = default;
Robot& Robot::operator=(Robot&&) noexcept = default;

std::vector<Output> Robot::handle(const Input&) { return {}; }

}  // namespace robot
