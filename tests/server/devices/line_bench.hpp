// One io_context with devices and links on real pseudo-terminals, and what the links said.
#pragma once

#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "server/devices/p2os_link.hpp"
#include "server/devices/sick_link.hpp"
#include "server/devices/simulated_line.hpp"
#include "server/devices/simulated_p2os.hpp"
#include "server/devices/simulated_sick.hpp"

namespace devices {

class LineBench {
 public:
  LineBench() {
    std::string name = (std::filesystem::temp_directory_path() / "docent-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder = name;
  }
  ~LineBench() {
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
  }

  Clock clock() {
    return [this] { return robot::Time(std::chrono::steady_clock::now() - started); };
  }
  EventSink sink() {
    return [this](robot::Event event) { events.push_back(std::move(event)); };
  }

  // Runs until `done`; false when it took longer than `patience`.
  template <typename Done>
  bool run_until(const Done& done, Duration patience = 20s) {
    const Instant end = std::chrono::steady_clock::now() + patience;
    while (!done()) {
      if (std::chrono::steady_clock::now() > end) return false;
      context.run_one_for(10ms);
      context.restart();
    }
    return true;
  }
  void run_for(Duration duration) {
    const Instant end = std::chrono::steady_clock::now() + duration;
    run_until([&] { return std::chrono::steady_clock::now() >= end; });
  }

  template <typename T>
  std::vector<T> all() const {
    std::vector<T> found;
    for (const auto& event : events) {
      if (const auto* value = std::get_if<T>(&event)) found.push_back(*value);
    }
    return found;
  }
  template <typename T>
  std::size_t count() const {
    std::size_t n = 0;
    for (const auto& event : events) n += std::holds_alternative<T>(event);
    return n;
  }
  // The newest word on the device; none yet: "unknown".
  std::string state(robot::Device device) const {
    std::string word = "unknown";
    for (const auto& s : all<robot::DeviceState>()) {
      if (s.device == device) word = s.connected ? "connected" : s.reason;
    }
    return word;
  }
  bool connected(robot::Device device) const { return state(device) == "connected"; }

  boost::asio::io_context context;
  std::filesystem::path folder;
  Instant started = std::chrono::steady_clock::now();
  std::vector<robot::Event> events;
};

// A laser in a room that trembles: beam i sees 1 m + i cm, and a millimetre more from scan to scan.
struct SickBench : LineBench {
  explicit SickBench(SimulatedSickConfig config = {}, SickLinkConfig wanted = {}) {
    config.scan = [this] { return room(); };
    sick = std::make_shared<SimulatedSick>(std::move(config), std::chrono::steady_clock::now());
    line = std::make_unique<SimulatedLine>(context.get_executor(), sick, folder / "laser");
    wanted.path = line->name().string();
    link = std::make_unique<SickLink>(context.get_executor(), wanted, clock(), sink());
  }
  ~SickBench() {
    link->stop();
    context.run_for(20ms);
  }

  robot::LaserScan room() {
    robot::LaserScan scan;
    scan.angle_min = -robot::pi / 2;
    scan.angle_step = robot::radians(0.5);
    scan.max_range = 32.0f;
    ++scans;
    for (int i = 0; i < 361; ++i)
      scan.ranges.push_back(1.0f + 0.01f * static_cast<float>(i) + (scans % 2 ? 0.001f : 0.0f));
    scan.ranges[10] = NAN;
    return scan;
  }
  bool streaming() const { return connected(robot::Device::laser_front) && count<robot::LaserScan>() > 0; }

  int scans = 0;
  std::shared_ptr<SimulatedSick> sick;
  std::unique_ptr<SimulatedLine> line;
  std::unique_ptr<SickLink> link;
};

// A base on frictionless ground: it does at once what its motors are asked.
struct BaseBench : LineBench {
  explicit BaseBench(SimulatedP2osConfig config = {}, P2osLinkConfig wanted = {}) {
    config.drive = [this](robot::Twist wanted_twist) { roll(wanted_twist); };
    config.enable_motors = [this](bool on) { state_now.motors_enabled = on; };
    config.odometry = [this] {
      roll(twist);
      return robot::Odometry{{}, pose, twist};
    };
    config.state = [this] { return state_now; };
    config.sonars = [] { return robot::SonarScan{{}, {{3, 1.5f}, {11, NAN}}}; };
    state_now.battery_volts = 12.6;
    state_now.battery_fraction = 0.8;
    base = std::make_shared<SimulatedP2os>(std::move(config), std::chrono::steady_clock::now());
    line = std::make_unique<SimulatedLine>(context.get_executor(), base, folder / "base");
    wanted.path = line->name().string();
    link = std::make_unique<P2osLink>(context.get_executor(), wanted, clock(), sink());
  }
  ~BaseBench() {
    link->stop();
    context.run_for(20ms);
  }

  void roll(robot::Twist next) {
    const Instant now = std::chrono::steady_clock::now();
    pose = pose * robot::arc(twist, std::chrono::duration<double>(now - rolled).count());
    rolled = now;
    twist = next;
  }
  // Says the same command 20 times a second, as the robot does.
  void drive(robot::Twist wanted, Duration duration) {
    const Instant end = std::chrono::steady_clock::now() + duration;
    while (std::chrono::steady_clock::now() < end) {
      link->drive({wanted});
      run_for(50ms);
    }
  }
  bool listening() const { return connected(robot::Device::base) && count<robot::Odometry>() > 0; }

  robot::Pose pose;
  robot::Twist twist;
  robot::BaseState state_now;
  Instant rolled = std::chrono::steady_clock::now();
  std::shared_ptr<SimulatedP2os> base;
  std::unique_ptr<SimulatedLine> line;
  std::unique_ptr<P2osLink> link;
};

}  // namespace devices
