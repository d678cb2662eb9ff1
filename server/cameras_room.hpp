// The cameras of the simulated museum: pictures are painted and encoded on the pool, only for cameras that somebody
// looks at, once for all viewers. Belongs to the web thread.
#pragma once

#include <boost/asio/thread_pool.hpp>
#include <memory>
#include <string>
#include <vector>

#include "robot/simulation/painter.hpp"
#include "server/api/web.hpp"
#include "server/devices/simulated_hardware.hpp"
#include "server/stream/asio.hpp"

namespace server {

class CamerasRoom {
 public:
  // The robot's eyes and the museum's wall cameras, in the order of their index on the wire.
  static std::vector<CameraInfo> infos(const robot::Museum& museum);

  CamerasRoom(devices::SimulatedHardware& hardware, Web& web, const robot::Museum& museum, net::io_context& web_io,
              net::thread_pool& pool);

  void start() { tick(); }
  void stop() { timer_.cancel(); }

 private:
  void tick();
  void picture(std::size_t camera);

  devices::SimulatedHardware& hardware_;
  Web& web_;
  std::vector<CameraInfo> infos_;
  std::vector<robot::WallCamera> walls_;
  std::shared_ptr<const robot::simulation::Painter> painter_;
  net::io_context& web_io_;
  net::thread_pool& pool_;
  net::steady_timer timer_;
  std::vector<bool> busy_;  // a picture of this camera is under way
};

}  // namespace server
