// The simulated museum behind real serial lines: a world that runs in real time, and a Pioneer base and two SICK lasers
// on pseudo-terminals that sense and move in it. Everything happens on one executor, best one of its own: the robot
// only ever sees the terminals.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "robot/simulation/world.hpp"
#include "server/devices/latency_probe.hpp"
#include "server/devices/simulated_line.hpp"
#include "server/devices/simulated_p2os.hpp"
#include "server/devices/simulated_sick.hpp"

namespace devices {

class SimulatedHardware {
 public:
  // `world`: its own laser and base periods are not used, the devices ask when they are due. Throws std::system_error
  // when there is no terminal or no temporary folder. Destroy it on its executor's thread or when that has ended.
  SimulatedHardware(boost::asio::any_io_executor executor, const robot::Museum& museum, const robot::Body& body,
                    robot::simulation::WorldConfig world, std::uint64_t seed);
  ~SimulatedHardware();
  SimulatedHardware(const SimulatedHardware&) = delete;
  SimulatedHardware& operator=(const SimulatedHardware&) = delete;

  // Names that stay when a line is unplugged and plugged in again. From any thread.
  std::string path(robot::Device device) const;
  std::vector<std::string> paths() const;  // base, front laser, rear laser as far as the body has them

  // From any thread: carried out on the executor.
  void unplug(robot::Device device);
  void plug(robot::Device device);
  void damage(robot::Device device, SimulatedLine::Damage kind, double share);
  // With the world at the present moment: to speak to its visitors, take a snapshot, press a button, know the truth.
  void with_world(std::function<void(robot::simulation::World&)> act);
  // Asks for the milliseconds from scan bytes to wheel command bytes; answers on the executor.
  void with_latency(std::function<void(const LatencyProbe&)> act);

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace devices
