#include "server/runner.hpp"

#include <utility>
#include <variant>

namespace server {
namespace {

// At least 20 Hz, as the gate counts on. The first front scan between the two calls for the tick; without one the later
// time does. At 75 scans a second there always is one.
constexpr auto earliest_tick = std::chrono::milliseconds(36);
constexpr auto latest_tick = std::chrono::milliseconds(50);

bool is_front_scan(const robot::Event& event) {
  const auto* scan = std::get_if<robot::LaserScan>(&event);
  return scan && scan->laser == robot::LaserId::front;
}

}  // namespace

Runner::Runner(net::io_context& io, robot::Robot robot, Sinks sinks, Clock::time_point zero)
    : io_(io), robot_(std::move(robot)), sinks_(std::move(sinks)), zero_(zero), timer_(io) {}

robot::Time Runner::now() const {
  return robot::Time(std::chrono::duration_cast<robot::RobotClock::duration>(Clock::now() - zero_));
}

void Runner::start() {
  running_ = true;
  ticked_ = Clock::now();
  wait_for_tick();
}

void Runner::stop() {
  running_ = false;
  timer_.cancel();
  if (sinks_.wheels) sinks_.wheels({});
}

void Runner::tick() {
  ticked_ = Clock::now();
  handle(robot::Tick{});
  wait_for_tick();
}

void Runner::wait_for_tick() {
  timer_.expires_at(ticked_ + latest_tick);
  timer_.async_wait([this](error_code error) {
    // A wait that was over but had not been run yet when a scan called for the tick is not one.
    if (error || !running_ || Clock::now() < timer_.expiry()) return;
    tick();
  });
}

void Runner::submit(robot::Event event) {
  net::post(io_, [this, event = std::move(event)]() mutable { handle(std::move(event)); });
}

void Runner::handle(robot::Event event) {
  const bool front_scan = is_front_scan(event);
  const robot::Input input{now(), std::move(event)};
  if (sinks_.input) sinks_.input(input);
  std::vector<robot::Output> outputs = robot_.handle(input);
  for (const robot::Output& output : outputs) {
    if (const auto* wheels = std::get_if<robot::WheelCommand>(&output); wheels && sinks_.wheels) sinks_.wheels(*wheels);
    if (const auto* motors = std::get_if<robot::EnableMotors>(&output); motors && sinks_.motors) sinks_.motors(*motors);
    if (sinks_.output) sinks_.output(output, input.now);
  }
  if (sinks_.viewers && !outputs.empty()) sinks_.viewers(std::move(outputs), input.now);
  if (running_ && front_scan && Clock::now() - ticked_ >= earliest_tick) tick();
}

}  // namespace server
