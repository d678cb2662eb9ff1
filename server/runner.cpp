#include "server/runner.hpp"

#include <algorithm>
#include <utility>

namespace server {
namespace {

constexpr auto tick_period = std::chrono::milliseconds(50);

}  // namespace

Runner::Runner(net::io_context& io, robot::Robot robot, Sinks sinks, Clock::time_point zero)
    : io_(io), robot_(std::move(robot)), sinks_(std::move(sinks)), zero_(zero), timer_(io) {}

robot::Time Runner::now() const {
  return robot::Time(std::chrono::duration_cast<robot::RobotClock::duration>(Clock::now() - zero_));
}

void Runner::start() {
  due_ = Clock::now() + tick_period;
  tick();
}

void Runner::stop() {
  timer_.cancel();
  if (sinks_.wheels) sinks_.wheels({});
}

void Runner::tick() {
  timer_.expires_at(due_);
  timer_.async_wait([this](error_code error) {
    if (error) return;
    handle(robot::Tick{});
    due_ = std::max(due_ + tick_period, Clock::now());
    tick();
  });
}

void Runner::submit(robot::Event event) {
  net::post(io_, [this, event = std::move(event)]() mutable { handle(std::move(event)); });
}

void Runner::handle(robot::Event event) {
  const robot::Input input{now(), std::move(event)};
  if (sinks_.input) sinks_.input(input);
  std::vector<robot::Output> outputs = robot_.handle(input);
  for (const robot::Output& output : outputs) {
    if (const auto* wheels = std::get_if<robot::WheelCommand>(&output); wheels && sinks_.wheels) sinks_.wheels(*wheels);
    if (const auto* motors = std::get_if<robot::EnableMotors>(&output); motors && sinks_.motors) sinks_.motors(*motors);
    if (sinks_.output) sinks_.output(output, input.now);
  }
  if (sinks_.viewers && !outputs.empty()) sinks_.viewers(std::move(outputs), input.now);
}

}  // namespace server
