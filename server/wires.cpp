#include "server/wires.hpp"

#include <utility>

namespace server {
namespace {

constexpr std::array<const char*, 3> device_names = {"base", "laser_front", "laser_rear"};

}  // namespace

Wires::Wires(net::io_context& io, const LinePaths& paths, const robot::Body& body, const devices::Clock& clock,
             devices::EventSink sink)
    : sink_(std::move(sink)),
      counted_since_(Clock::now()),
      base_(io.get_executor(), {.path = paths.base, .limits = body.drive}, clock,
            [this](robot::Event e) { listen(e), sink_(std::move(e)); }),
      front_(io.get_executor(), {.path = paths.laser_front, .laser = robot::LaserId::front, .variant = {}}, clock,
             [this](robot::Event e) { listen(e), sink_(std::move(e)); }),
      rear_(io.get_executor(), {.path = paths.laser_rear, .laser = robot::LaserId::rear, .variant = {}}, clock,
            [this](robot::Event e) { listen(e), sink_(std::move(e)); }) {}

void Wires::start() {
  base_.start();
  front_.start();
  rear_.start();
}

void Wires::stop() {
  base_.stop();
  front_.stop();
  rear_.stop();
}

void Wires::listen(const robot::Event& event) {
  const auto note = [&](robot::Device device) {
    Heard& heard = heard_[static_cast<std::size_t>(device)];
    heard.last = Clock::now();
    ++heard.reports;
  };
  if (const auto* scan = std::get_if<robot::LaserScan>(&event)) {
    note(scan->laser == robot::LaserId::front ? robot::Device::laser_front : robot::Device::laser_rear);
  } else if (std::holds_alternative<robot::Odometry>(event)) {
    note(robot::Device::base);
  } else if (const auto* state = std::get_if<robot::DeviceState>(&event)) {
    Heard& heard = heard_[static_cast<std::size_t>(state->device)];
    heard.connected = state->connected;
    heard.reason = state->reason;
  }
}

std::vector<DeviceHealth> Wires::health() {
  const auto now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - std::exchange(counted_since_, now)).count();
  const devices::LineStatistics lines[] = {base_.statistics(), front_.statistics(), rear_.statistics()};
  std::vector<DeviceHealth> all;
  for (std::size_t i = 0; i < heard_.size(); ++i) {
    Heard& heard = heard_[i];
    const double age =
        heard.last == Clock::time_point{} ? 0.0 : std::chrono::duration<double>(now - heard.last).count();
    const auto reports = static_cast<double>(std::exchange(heard.reports, 0));
    all.push_back({.device = device_names[i],
                   .connected = heard.connected,
                   .reason = heard.reason,
                   .age_seconds = age,
                   .rate_hz = seconds > 0.0 ? reports / seconds : 0.0,
                   .bad_packets = lines[i].bad_checksums});
  }
  return all;
}

}  // namespace server
