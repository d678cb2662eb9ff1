// Docent's web server: REST, /ws, pictures and pages, and what must survive a crash. Lives on one io_context with one
// thread; the robot's side hands it values by post, it hands events to the robot by `submit`.
//
//   net::io_context context;
//   server::Web web(context, museum, options, [&](robot::Event event) { net::post(robot_context, ...); });
//   robot.handle({now, web.remember()});            // before the first tick: what was accepted and is still open
//   web.start();                                    // listens
//   net::post(context, [&] { web.take(outputs, now); });   // every batch, from the robot's side
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "robot/body.hpp"
#include "robot/museum.hpp"
#include "robot/outputs.hpp"
#include "server/http/server.hpp"
#include "server/stream/cameras.hpp"
#include "server/stream/token_bucket.hpp"
#include "server/stream/web_socket.hpp"

namespace server {

struct WebLimits {
  HttpLimits http;
  WebSocketLimits web_socket;
  Rate per_session{20.0, 2.0};                     // POSTs and other changes
  Rate per_address{200.0, 40.0};                   // the same, over all sessions of an address
  Rate passwords{5.0, 0.1};                        // tries of an address
  std::chrono::milliseconds answer{3'000};         // for the robot to answer a request, then 503
  std::chrono::milliseconds robot_silence{1'000};  // without a batch from the robot: not healthy
  std::size_t sessions = 100'000;                  // remembered at once; the oldest are forgotten
};

struct WebOptions {
  std::string address = "0.0.0.0";
  unsigned short port = 8080;         // 0: any free one
  std::string pages;                  // folder of the built pages (web/dist); empty: none
  std::string site;                   // the museum's folder: pictures and sounds below /site/; empty: none
  std::string database = ":memory:";  // SQLite file
  std::string staff_password;         // empty: clients on this machine are staff, others never
  robot::Footprint footprint;
  std::vector<CameraInfo> cameras;  // in the order of their index on the wire
  WebLimits limits;
};

// How a device is doing, for staff.
struct DeviceHealth {
  std::string device;  // "base", "laser_front"...
  bool connected = false;
  std::string reason;             // why not
  double age_seconds = 0.0;       // since it was last heard
  double rate_hz = 0.0;           // of its reports
  std::uint64_t bad_packets = 0;  // came damaged, since the start
};

class Web {
 public:
  using Submit = std::function<void(robot::Event)>;

  // Opens the database. `submit` is called on the web's thread and must return at once. Throws std::runtime_error when
  // the database or the pages cannot be used.
  Web(net::io_context& context, robot::Museum museum, WebOptions options, Submit submit);
  // Writes what is left to write and waits for it. The io_context must outlive the Web and be stopped or idle by then.
  ~Web();
  Web(const Web&) = delete;
  Web& operator=(const Web&) = delete;

  // What was accepted before the last stop and is still open: the robot's first input. Call before start().
  robot::Remember remember() const;

  // Begins to listen. Throws boost::system::system_error when the port is taken.
  void start();
  unsigned short port() const;

  // Web thread. A batch of what the robot said, also an empty one: it shows that the robot lives.
  void take(const std::vector<robot::Output>& outputs, robot::Time now);
  // Web thread. A camera's newest picture; unknown cameras are ignored.
  void frame(const std::string& camera, std::shared_ptr<const std::string> jpeg, robot::Time time);
  // Web thread, about once a second.
  void devices(std::vector<DeviceHealth> devices);
  // Any thread: does anybody look at this camera now?
  bool camera_wanted(const std::string& camera) const;

  // Web thread. Says farewell to viewers (1001) and closes the port; run the io_context for a moment afterwards.
  void stop();

  class Parts;

 private:
  std::shared_ptr<Parts> parts_;
};

}  // namespace server
