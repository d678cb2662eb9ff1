// The newest picture of each camera, encoded once, for frame.jpg, MJPEG streams and the topic camera:<id>. Knows which
// cameras somebody looks at, so that the others need not be rendered. Belongs to the web thread, wanted() to any.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "robot/museum.hpp"
#include "server/stream/asio.hpp"
#include "server/stream/hub.hpp"

namespace server {

enum class CameraKind : std::uint8_t { onboard, wall };

struct CameraInfo {
  std::string id;
  robot::Text title;
  CameraKind kind = CameraKind::wall;
  int width = 320;  // pixels
  int height = 240;
};

struct Picture {
  std::shared_ptr<const std::string> jpeg;
  std::shared_ptr<const std::string> part;  // of a multipart stream: boundary, header, picture
  std::uint64_t number = 0;                 // counts up
  Clock::time_point came;
};

inline constexpr const char* multipart_boundary = "docent-frame";

class Cameras {
 public:
  Cameras(net::any_io_executor executor, std::vector<CameraInfo> infos, Hub& hub);

  const std::vector<CameraInfo>& infos() const { return infos_; }
  // Position of a camera in infos(), or infos().size().
  std::size_t find(const std::string& id) const;

  void put(std::size_t camera, std::shared_ptr<const std::string> jpeg, robot::Time time);
  const Picture& newest(std::size_t camera) const { return states_.at(camera).picture; }

  // Somebody looks, until forget(); or only now, which counts for some seconds.
  void look(std::size_t camera);
  void look_away(std::size_t camera);
  void glance(std::size_t camera);

  // Waits for a picture after number `seen`, at most so long; gives the newest there is.
  net::awaitable<Picture> next(std::size_t camera, std::uint64_t seen, Clock::duration patience);

  // Call about once a second, and when subscriptions change.
  void update_wanted();
  // From any thread.
  bool wanted(std::size_t camera) const { return wanted_.load(std::memory_order_relaxed) >> camera & 1; }

 private:
  struct State {
    Picture picture;
    int watchers = 0;
    Clock::time_point glanced{};
    std::unique_ptr<net::steady_timer> arrival;  // cancelled by each new picture
  };

  std::vector<CameraInfo> infos_;
  std::vector<State> states_;
  Hub& hub_;
  std::atomic<std::uint64_t> wanted_{0};
};

}  // namespace server
