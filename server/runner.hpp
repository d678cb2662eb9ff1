// The robot's thread: stamps events with the time, calls the core, hands its outputs on. Runs on one io_context
// together with the serial links; everything else talks to it through submit().
#pragma once

#include <functional>
#include <memory>
#include <ostream>
#include <vector>

#include "robot/robot.hpp"
#include "server/stream/asio.hpp"

namespace server {

class Runner {
 public:
  // All are called on the runner's thread and must return at once.
  struct Sinks {
    std::function<void(const robot::WheelCommand&)> wheels;
    std::function<void(const robot::EnableMotors&)> motors;
    std::function<void(std::vector<robot::Output>, robot::Time)> viewers;  // everything, once an input
    std::function<void(const robot::Input&)> input;                        // before the core sees it: for recordings
    std::function<void(const robot::Output&, robot::Time)> output;         // for recordings
  };

  Runner(net::io_context& io, robot::Robot robot, Sinks sinks, Clock::time_point zero);

  // Starts the control tick, 20 Hz or a little more on the wall: right after a front scan, so that steering never waits
  // for a clock with what the laser saw, or on its own when no scan comes. A tick that comes late is not made up for.
  void start();
  void stop();

  // From any thread: posts the event to the robot.
  void submit(robot::Event event);
  // On the runner's thread only: the robot sees the event before this returns.
  void handle(robot::Event event);

  robot::Time now() const;

 private:
  void tick();
  void wait_for_tick();

  net::io_context& io_;
  robot::Robot robot_;
  Sinks sinks_;
  Clock::time_point zero_;
  net::steady_timer timer_;
  Clock::time_point ticked_;
  bool running_ = false;
};

}  // namespace server
