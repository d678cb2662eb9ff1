// The robot's hardware as the server sees it: a base and two lasers on serial lines, real ones or those of the
// simulated museum. Lives on the robot's thread.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "robot/body.hpp"
#include "robot/inputs.hpp"
#include "robot/outputs.hpp"
#include "server/api/web.hpp"
#include "server/devices/p2os_link.hpp"
#include "server/devices/sick_link.hpp"
#include "server/stream/asio.hpp"

namespace server {

struct LinePaths {
  std::string base;
  std::string laser_front;
  std::string laser_rear;
};

class Wires {
 public:
  Wires(net::io_context& io, const LinePaths& paths, const robot::Body& body, const devices::Clock& clock,
        devices::EventSink sink);

  void start();
  // Stops the wheels and lets the lines go.
  void stop();
  void drive(const robot::WheelCommand& command) { base_.drive(command); }
  void enable(const robot::EnableMotors& motors) { base_.enable(motors); }

  // How each device is doing; call about once a second, the rates are since the last call.
  std::vector<DeviceHealth> health();

 private:
  struct Heard {
    bool connected = false;
    std::string reason = "not answered yet";
    Clock::time_point last{};
    std::uint64_t reports = 0;
  };
  void listen(const robot::Event& event);

  devices::EventSink sink_;
  std::array<Heard, 3> heard_;
  Clock::time_point counted_since_;
  devices::P2osLink base_;
  devices::SickLink front_;
  devices::SickLink rear_;
};

}  // namespace server
