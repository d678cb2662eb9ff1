// A SICK LMS 2xx on a serial line: finds its rate, sets it up for 32 m in millimetres, streams its scans, and starts
// over when the line dies, falls silent or freezes.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <memory>
#include <string>

#include "protocols/serial/sick_lms.hpp"
#include "server/devices/link.hpp"

namespace devices {

struct SickLinkConfig {
  std::string path{};  // tty or pty
  robot::LaserId laser = robot::LaserId::front;
  int baud = 500'000;  // wanted; lines that do not run at it fall back to 38400
  serial::sick::Variant variant{};
  // An error or fatal error in a scan's status byte makes the scan worthless. The meaning of that byte stands in one
  // listing only: set false for a scanner that uses it otherwise.
  bool heed_status = true;
};

class SickLink {
 public:
  // Emits LaserScan and DeviceState. A scan's time is that of its middle: arrival, less the telegram's time on the
  // line, less half a sweep.
  SickLink(boost::asio::any_io_executor executor, SickLinkConfig config, Clock clock, EventSink sink);
  ~SickLink();  // stops
  SickLink(SickLink&&) noexcept = default;

  void start();
  // Asks the scanner to be quiet and lets the line go; no event comes after this.
  void stop();
  LineStatistics statistics() const;

 private:
  class Session;
  std::shared_ptr<Session> session_;
};

}  // namespace devices
