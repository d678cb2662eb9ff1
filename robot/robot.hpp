// The robot: one function from a timed input to outputs. No clock, thread, file, socket or log lives below here; the
// same inputs in the same order give the same outputs, bit for bit.
#pragma once

#include <memory>
#include <vector>

#include "robot/config.hpp"
#include "robot/inputs.hpp"
#include "robot/museum.hpp"
#include "robot/outputs.hpp"

namespace robot {

class Robot {
 public:
  Robot(Museum museum, Config config);
  ~Robot();
  Robot(Robot&&) noexcept;
  Robot& operator=(Robot&&) noexcept;

  // Call with non-decreasing input.now. Sensors may come at any rate; Tick comes at 20 Hz and drives planning and
  // motion. Stop and lost devices answer inside the same call, without waiting for a tick.
  std::vector<Output> handle(const Input& input);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace robot
