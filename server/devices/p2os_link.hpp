// A Pioneer base on a serial line: opens the connection, keeps it alive, turns wheel commands into set-points and
// packets into events, and starts over when the line dies or falls silent.
//
// The wheels turn only on fresh words of the robot: without a command for `command_lifetime` the link stops them
// itself; without the link the base's watchdog does. Nothing that was commanded before a break is repeated after it,
// and the motors are off after every connect until EnableMotors asks for them.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <memory>
#include <string>

#include "robot/body.hpp"
#include "robot/outputs.hpp"
#include "server/devices/link.hpp"

namespace devices {

struct P2osLinkConfig {
  std::string path{};           // tty or pty
  int baud = 115'200;           // wanted after the handshake, if the base can: odometry is younger at higher rates
  robot::DriveLimits limits{};  // handed to the base as its own: it never goes faster or brakes more softly
  Duration command_lifetime = 300ms;
};

class P2osLink {
 public:
  // Emits Odometry, SonarScan, BaseState and DeviceState. Times are arrival less the packet's time on the line.
  P2osLink(boost::asio::any_io_executor executor, P2osLinkConfig config, Clock clock, EventSink sink);
  ~P2osLink();  // stops
  P2osLink(P2osLink&&) noexcept = default;

  void start();
  // Stops the wheels, closes the connection and lets the line go; no event comes after this.
  void stop();
  // Goes out at once. Without a connection it is dropped: it must not be carried out later.
  void drive(const robot::WheelCommand& command);
  void enable(const robot::EnableMotors& motors);
  LineStatistics statistics() const;

 private:
  class Session;
  std::shared_ptr<Session> session_;
};

}  // namespace devices
