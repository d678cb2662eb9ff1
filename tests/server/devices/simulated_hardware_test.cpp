// The whole simulated robot over real pseudo-terminals: world, devices, links.
#include "server/devices/simulated_hardware.hpp"

#include <gmock/gmock.h>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/post.hpp>

#include <set>
#include <thread>

#include "tests/server/devices/line_bench.hpp"

namespace devices {
namespace {

using robot::Device;
using robot::LaserScan;
using robot::Odometry;

robot::Museum hall() {
  robot::Museum museum;
  museum.map = robot::OccupancyGrid(400, 400, 0.05, {-10.0, -10.0}, robot::free_cell);
  for (int i = 0; i < 400; ++i) {
    for (const robot::Cell cell : {robot::Cell{i, 0}, {i, 399}, {0, i}, {399, i}})
      museum.map[cell] = robot::occupied_cell;
  }
  return museum;
}

// World and devices on a thread of their own, as in the server; links on the test's.
struct HardwareBench : LineBench {
  HardwareBench() : hardware(museum_side.get_executor(), hall(), robot::standard_body(), {.visitors = 0}, 1) {
    thread = std::thread([this] {
      const auto work = boost::asio::make_work_guard(museum_side);
      museum_side.run();
    });
    const auto executor = context.get_executor();
    base = std::make_unique<P2osLink>(executor, P2osLinkConfig{.path = hardware.path(Device::base)}, clock(), sink());
    front = std::make_unique<SickLink>(executor, SickLinkConfig{.path = hardware.path(Device::laser_front)}, clock(),
                                       sink());
    rear = std::make_unique<SickLink>(
        executor, SickLinkConfig{.path = hardware.path(Device::laser_rear), .laser = robot::LaserId::rear}, clock(),
        sink());
    base->start();
    front->start();
    rear->start();
  }
  ~HardwareBench() {
    base->stop();
    front->stop();
    rear->stop();
    context.run_for(20ms);
    museum_side.stop();
    thread.join();
  }
  bool all_connected() const {
    return connected(Device::base) && connected(Device::laser_front) && connected(Device::laser_rear);
  }
  void drive(robot::Twist wanted, Duration duration) {
    const Instant end = std::chrono::steady_clock::now() + duration;
    while (std::chrono::steady_clock::now() < end) {
      base->drive({wanted});
      run_for(50ms);
    }
  }
  robot::Pose truth() {
    robot::Pose pose;
    bool told = false;
    hardware.with_world([&](robot::simulation::World& world) {
      const robot::Pose seen = world.truth();
      boost::asio::post(context, [&, seen] {
        pose = seen;
        told = true;
      });
    });
    EXPECT_TRUE(run_until([&] { return told; }));
    return pose;
  }

  boost::asio::io_context museum_side;
  SimulatedHardware hardware;
  std::thread thread;
  std::unique_ptr<P2osLink> base;
  std::unique_ptr<SickLink> front, rear;
};

TEST(SimulatedHardware, OffersThreeLines) {
  boost::asio::io_context context;
  std::vector<std::string> paths;
  {
    const SimulatedHardware hardware(context.get_executor(), hall(), robot::standard_body(), {.visitors = 0}, 1);
    paths = hardware.paths();
    ASSERT_EQ(paths.size(), 3u);
    for (const auto& path : paths) EXPECT_TRUE(std::filesystem::is_character_file(path)) << path;
  }
  context.run_for(1ms);
  for (const auto& path : paths) EXPECT_FALSE(std::filesystem::exists(path)) << path;
}

TEST(SimulatedHardware, DrivesThroughItsWorldOverTheWire) {
  HardwareBench bench;
  ASSERT_TRUE(bench.run_until([&] { return bench.all_connected(); }));
  EXPECT_EQ(bench.front->statistics().baud, 500000);
  const auto scan = bench.all<LaserScan>().back();
  EXPECT_NEAR(scan.ranges[90], 10.0 - 0.22 - 0.05, 0.2);
  const robot::Pose before = bench.truth();
  bench.base->enable({true});
  bench.drive({0.5, 0.0}, 2s);
  const robot::Pose after = bench.truth();
  EXPECT_GT(after.x - before.x, 0.4);
  EXPECT_NEAR(bench.all<Odometry>().back().odom_from_base.x, after.x, 0.3);
  std::set<int> sonars;
  for (const auto& sonar : bench.all<robot::SonarScan>()) {
    for (const auto& reading : sonar.readings) sonars.insert(reading.sonar);
  }
  EXPECT_EQ(sonars.size(), 24u);
}

TEST(SimulatedHardware, UnpluggedInMotionEveryLineComesBack) {
  HardwareBench bench;
  ASSERT_TRUE(bench.run_until([&] { return bench.all_connected(); }));
  bench.base->enable({true});
  bench.drive({0.5, 0.0}, 1s);
  for (const Device device : {Device::laser_rear, Device::laser_front, Device::base}) {
    bench.hardware.unplug(device);
    ASSERT_TRUE(bench.run_until([&] { return !bench.connected(device); }));
  }
  bench.run_for(200ms);
  for (const Device device : {Device::base, Device::laser_front, Device::laser_rear}) bench.hardware.plug(device);
  ASSERT_TRUE(bench.run_until([&] { return bench.all_connected(); }));
  const auto scans = bench.count<LaserScan>();
  EXPECT_TRUE(bench.run_until([&] { return bench.count<LaserScan>() > scans + 10; }));
}

TEST(SimulatedHardware, MeasuresFromScanBytesToWheelBytes) {
  HardwareBench bench;
  ASSERT_TRUE(bench.run_until([&] { return bench.all_connected(); }));
  bench.drive({0.0, 0.0}, 500ms);
  std::size_t commands = 0;
  std::optional<double> median;
  bool told = false;
  bench.hardware.with_latency([&](const LatencyProbe& probe) {
    boost::asio::post(bench.context, [&, n = probe.commands(), m = probe.milliseconds(0.5)] {
      commands = n;
      median = m;
      told = true;
    });
  });
  ASSERT_TRUE(bench.run_until([&] { return told; }));
  EXPECT_GE(commands, 5u);
  ASSERT_TRUE(median);
  EXPECT_GE(*median, 0.0);
}

}  // namespace
}  // namespace devices
