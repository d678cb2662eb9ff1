// How long the robot takes from what it sees to what its wheels do, measured outside of it: from a scan's bytes at the
// laser's terminal to wheel command bytes at the base's. Hang it between the two simulated lines.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "protocols/serial/p2os.hpp"
#include "server/devices/link.hpp"

namespace devices {

class LatencyProbe {
 public:
  // A scan has been written to the laser's terminal.
  void scan_sent(Instant now) { newest_scan_ = now; }

  // Bytes came to the base. Every velocity command is measured against the newest scan before it.
  void base_received(serial::ByteSpan bytes, Instant now) {
    decoder_.feed(bytes);
    bool velocity = false;
    while (const auto body = decoder_.next()) {
      velocity = velocity || (*body)[0] == static_cast<std::uint8_t>(serial::p2os::Command::vel);
    }
    if (!velocity || !newest_scan_) return;
    if (milliseconds_.size() == most) milliseconds_.erase(milliseconds_.begin(), milliseconds_.begin() + most / 2);
    milliseconds_.push_back(std::chrono::duration<double, std::milli>(now - *newest_scan_).count());
  }

  // The share `quantile` (0..1) of the newest commands took no longer than this; nothing before the first.
  std::optional<double> milliseconds(double quantile) const {
    if (milliseconds_.empty()) return std::nullopt;
    std::vector<double> sorted(milliseconds_);
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(quantile * static_cast<double>(sorted.size() - 1))];
  }
  std::size_t commands() const { return milliseconds_.size(); }

 private:
  static constexpr std::size_t most = 8192;
  std::optional<Instant> newest_scan_;
  serial::p2os::PacketDecoder decoder_;
  std::vector<double> milliseconds_;
};

}  // namespace devices
