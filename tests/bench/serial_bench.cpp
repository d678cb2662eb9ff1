// The serial lines' costs: decoding a second's scans, what noise costs, and the way from a scan's bytes at the terminal
// to the event that the robot gets. Byte by byte is the textbook: what a line at 38400 baud brings.
#include <benchmark/benchmark.h>

#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <chrono>
#include <filesystem>
#include <thread>

#include "protocols/serial/p2os_base.hpp"
#include "protocols/serial/sick_scan.hpp"
#include "robot/geometry/random.hpp"
#include "server/devices/sick_link.hpp"
#include "server/devices/simulated_line.hpp"
#include "server/devices/simulated_sick.hpp"

namespace {

using serial::Bytes;
using serial::ByteSpan;

Bytes scans(int count) {
  Bytes stream;
  robot::Random random(1);
  for (int i = 0; i < count; ++i) {
    serial::sick::Values values;
    values.units = serial::sick::Units::mm;
    values.last = 181;
    for (int beam = 0; beam < 181; ++beam) values.values.push_back(static_cast<std::uint16_t>(random.index(32000)));
    const Bytes telegram = serial::sick::encode_values(values);
    stream.insert(stream.end(), telegram.begin(), telegram.end());
  }
  return stream;
}

int decode(ByteSpan stream, std::size_t piece) {
  serial::sick::TelegramDecoder decoder(serial::sick::Sender::sensor);
  int found = 0;
  for (; !stream.empty(); stream = stream.subspan(std::min(piece, stream.size()))) {
    decoder.feed(stream.first(std::min(piece, stream.size())));
    while (const auto item = decoder.next()) {
      const auto values = serial::sick::parse_values(item->payload);
      if (values && serial::sick::to_laser_scan(*values, {}, robot::LaserId::front)) ++found;
    }
  }
  return found;
}

void sick_decode_second(benchmark::State& state) {
  const Bytes stream = scans(75);
  for (auto _ : state) benchmark::DoNotOptimize(decode(stream, static_cast<std::size_t>(state.range(0))));
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * stream.size()));
}
BENCHMARK(sick_decode_second)->Arg(1)->Arg(372)->Unit(benchmark::kMicrosecond);

void sick_decode_noise(benchmark::State& state) {
  Bytes noise(75 * 372);
  robot::Random random(2);
  for (auto& byte : noise) byte = static_cast<std::uint8_t>(random());
  for (auto _ : state) benchmark::DoNotOptimize(decode(noise, 372));
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * noise.size()));
}
BENCHMARK(sick_decode_noise)->Unit(benchmark::kMicrosecond);

void p2os_decode_second(benchmark::State& state) {
  serial::p2os::Sip sip;
  for (int i = 0; i < 24; ++i) sip.sonars.push_back({static_cast<std::uint8_t>(i), 1234});
  Bytes stream;
  for (int i = 0; i < 20; ++i) {
    const Bytes packet = serial::p2os::encode_sip(sip);
    stream.insert(stream.end(), packet.begin(), packet.end());
  }
  serial::p2os::OdometryTracker tracker(serial::p2os::model_of("p3dx-sh"));
  for (auto _ : state) {
    serial::p2os::PacketDecoder decoder;
    decoder.feed(stream);
    while (const auto body = decoder.next()) {
      benchmark::DoNotOptimize(tracker.update(*serial::p2os::parse_sip(*body)));
    }
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * stream.size()));
}
BENCHMARK(p2os_decode_second)->Unit(benchmark::kMicrosecond);

void wheel_command_encode(benchmark::State& state) {
  serial::p2os::VelocityEncoder encoder;
  for (auto _ : state) benchmark::DoNotOptimize(encoder.encode({0.4321, 0.1234}));
}
BENCHMARK(wheel_command_encode);

// Real pseudo-terminal, two threads as in the server; the time is from write() at the device to the link's event.
void scan_bytes_to_event(benchmark::State& state) {
  using namespace devices;  // NOLINT: a benchmark
  boost::asio::io_context museum, robots;
  std::atomic<Instant::rep> sent{0};
  robot::Random random(3);
  SimulatedSickConfig config;
  config.scan = [&random] {
    robot::LaserScan scan;
    scan.angle_min = -robot::pi / 2;
    scan.angle_step = robot::radians(1.0);
    for (int i = 0; i < 181; ++i) scan.ranges.push_back(static_cast<float>(random.uniform(0.5, 30.0)));
    return scan;
  };
  const auto device = std::make_shared<SimulatedSick>(config, std::chrono::steady_clock::now());
  const auto name = std::filesystem::temp_directory_path() / ("docent-bench-" + std::to_string(random()));
  auto line = std::make_unique<SimulatedLine>(museum.get_executor(), device, name);
  line->tap({.sent = [&sent](ByteSpan, Instant now) { sent = now.time_since_epoch().count(); }, .received = {}});
  auto work = boost::asio::make_work_guard(museum);
  std::thread thread([&] { museum.run(); });

  bool arrived = false;
  Instant at;
  SickLink link(
      robots.get_executor(), {.path = name.string()}, [] { return robot::Time{}; },
      [&](const robot::Event& event) {
        arrived = std::holds_alternative<robot::LaserScan>(event);
        at = std::chrono::steady_clock::now();
      });
  link.start();
  for (auto _ : state) {
    for (arrived = false; !arrived;) robots.run_one();
    state.SetIterationTime(std::chrono::duration<double>(at.time_since_epoch() - Duration(sent.load())).count());
  }
  link.stop();
  robots.run_for(std::chrono::milliseconds(20));
  museum.stop();
  thread.join();
}
BENCHMARK(scan_bytes_to_event)->UseManualTime()->Iterations(150)->Unit(benchmark::kMicrosecond);

}  // namespace
