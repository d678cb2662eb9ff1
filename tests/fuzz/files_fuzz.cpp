// Any bytes as any file: every reader either refuses them with a complaint that says something, or gives values that
// are finite and sized as they claim.
#include <cstdlib>
#include <sstream>

#include "protocols/files/bytes.hpp"
#include "protocols/files/carmen_map.hpp"
#include "protocols/files/map_server_file.hpp"
#include "protocols/files/pose_file.hpp"
#include "protocols/files/problem.hpp"
#include "protocols/files/recording.hpp"
#include "protocols/files/sensor_log.hpp"
#include "protocols/files/value_codec.hpp"

namespace {

void require(bool held) {
  if (!held) std::abort();
}

// Runs a reader; its complaint must name the file and say what is wrong.
template <typename Read>
void read_or_refuse(Read read) {
  try {
    read();
  } catch (const files::FileError& error) {
    require(!error.problem().text.empty() && error.problem().file == "fuzz");
  } catch (const files::DecodeError& error) {
    require(*error.what() != '\0');
  }
}

void check_log(const files::SensorLog& log) {
  std::size_t scans = 0;
  for (const auto& entry : log.entries) {
    if (const auto* odometry = std::get_if<robot::Odometry>(&entry)) {
      require(robot::is_finite(odometry->odom_from_base));
    } else {
      ++scans;
      require(std::get<files::LoggedScan>(entry).scan.ranges.size() <= 4096);
    }
  }
  require(scans == log.scans && log.first_bad.size() <= log.bad_lines);
}

void check_recording(const std::string& bytes) {
  std::istringstream in(bytes);
  files::RecordingReader reader(in, "fuzz");
  while (const auto entry = reader.next()) {
    // What was understood means the same after another round.
    if (const auto* input = std::get_if<robot::Input>(&*entry)) {
      require(files::from_cbor<robot::Input>(files::to_cbor(*input)).event.index() == input->event.index());
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  read_or_refuse([&] { check_log(files::parse_log(bytes, "fuzz")); });
  read_or_refuse([&] {
    for (const auto& timed : files::parse_poses(bytes, "fuzz")) require(robot::is_finite(timed.pose));
  });
  read_or_refuse([&] { require(!files::parse_relations(bytes, "fuzz").empty()); });
  read_or_refuse([&] {
    const auto image = files::parse_pgm(bytes, "fuzz");
    require(image.pixels.size() == static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  });
  read_or_refuse([&] { require(!files::parse_carmen_map(bytes, "fuzz").grid.empty()); });
  read_or_refuse([&] { require(!files::parse_wean_map(bytes, "fuzz").empty()); });
  read_or_refuse([&] { require(files::gunzip(bytes, 1 << 20, "fuzz").size() <= 1 << 20); });
  read_or_refuse([&] { check_recording(bytes); });
  read_or_refuse([&] { files::from_cbor<robot::Input>(bytes); });
  read_or_refuse([&] { files::from_cbor<robot::Output>(bytes); });
  return 0;
}

std::vector<std::vector<std::uint8_t>> fuzz_seeds() {
  std::vector<std::string> seeds = {
      "ODOM 1.0 2.0 0.5 0.3 0.1 0 1000.25 host 0.25\n",
      "FLASER 4 1.5 81.83 2.5 0 1.1 2.0 0.5 1.0 2.0 0.5 1000.5 host 0.5\n",
      "ROBOTLASER1 0 -1.5 3.0 0.5 40.0 0.01 0 3 1.0 50.0 3.0 2 7 8 2.2 3.0 0 2 3 0 0.4 0.2 0 0 0 1001 host 0.9\n",
      "0 1.5 1 2 0.5 0\n1 2.5 2 2 0.5 1\n",
      "10.5 11.5 0.4 -0.01 0 0 0 -0.07\n",
      files::to_pgm({3, 2, {254, 205, 0, 0, 0, 254}}),
      "P2\n3 2 255\n254 205 0\n0 0 254\n",
      "robot_specifications->resolution 10\n\nglobal_map[0]: 2 3\n-1 0.9 0.1\n1 0 0.5\n",
      std::string("CARMENMAPFILEv020\x01\x1e\0\0\0GRIDMAP   \x02\0\0\0\x01\0\0\0\xcd\xcc\xcc\x3d\0\0\0\0\0\0\x80\x3f",
                  52),
      files::to_cbor(robot::Input{robot::from_seconds(1.0), robot::RequestVisit{}}),
      files::to_cbor(robot::Output{robot::Status{}}),
  };
  std::ostringstream recording;
  {
    files::Recorder recorder(recording, {"hall", "docent", {}});
    recorder.input({robot::from_seconds(1.0), robot::Tick{}});
    recorder.output(robot::from_seconds(1.0), robot::WheelCommand{});
  }
  seeds.push_back(recording.str());
  std::vector<std::vector<std::uint8_t>> bytes;
  for (const auto& seed : seeds) bytes.emplace_back(seed.begin(), seed.end());
  return bytes;
}
