// A simulated device on a pseudo-terminal: carries bytes between the two and calls the device when it is due. Clients
// find it under a name of its own that stays while the terminal behind it changes, as udev names do.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <filesystem>
#include <functional>
#include <memory>

#include "server/devices/simulated_device.hpp"

namespace devices {

class SimulatedLine {
 public:
  // `name`: a symbolic link that is made, and replaced if there is one. Throws std::system_error without terminals.
  SimulatedLine(boost::asio::any_io_executor executor, std::shared_ptr<SimulatedDevice> device,
                std::filesystem::path name);
  ~SimulatedLine();
  SimulatedLine(const SimulatedLine&) = delete;
  SimulatedLine& operator=(const SimulatedLine&) = delete;

  const std::filesystem::path& name() const { return name_; }
  // The cable: its client sees the line break; the device goes on and does not notice.
  void unplug();
  void plug();
  // Noise on the line: bytes that no device sent.
  void inject(serial::ByteSpan bytes);
  // A bad cable, both ways: this share (0..1) of what is sent loses its end, has a bit turned over, or is followed by
  // bytes that nobody sent. The same every time, in the order of what is sent.
  enum class Damage { none, cut, flip, random };
  void damage(Damage kind, double share);
  // From now on called with everything that is sent to the client, and with all that comes from it, at once.
  struct Tap {
    std::function<void(serial::ByteSpan, Instant)> sent{}, received{};
  };
  void tap(Tap tap);

 private:
  struct State;
  std::filesystem::path name_;
  std::shared_ptr<State> state_;
};

}  // namespace devices
