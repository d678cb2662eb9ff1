// What a simulated device does with its line. It owns no clock and no port: it is told the time and the bytes, and says
// when it wants to be called next, so that tests need neither sleeps nor terminals.
#pragma once

#include "protocols/serial/bytes.hpp"
#include "server/devices/link.hpp"

namespace devices {

class SimulatedDevice {
 public:
  virtual ~SimulatedDevice() = default;
  // Bytes that came at the device's own rate.
  virtual void receive(serial::ByteSpan bytes, Instant now) = 0;
  // What is due by now: scans, packets, ramps.
  virtual void advance(Instant now) = 0;
  // When advance() should be called next.
  virtual Instant due() const = 0;
  // What it sends now.
  virtual serial::Bytes take_output() = 0;
  // The rate it listens and speaks at.
  virtual int baud() const = 0;
};

}  // namespace devices
