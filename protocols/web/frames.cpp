#include "protocols/web/frames.hpp"

#include <algorithm>
#include <bit>

namespace protocols::web {
namespace {

template <typename Bits>
void put_little(std::string& out, Bits bits) {
  for (std::size_t i = 0; i < sizeof(Bits); ++i) out.push_back(static_cast<char>(bits >> (8 * i)));
}
void put(std::string& out, std::uint8_t value) { out.push_back(static_cast<char>(value)); }
void put(std::string& out, std::uint16_t value) { put_little(out, value); }
void put(std::string& out, float value) { put_little(out, std::bit_cast<std::uint32_t>(value)); }
void put(std::string& out, double value) { put_little(out, std::bit_cast<std::uint64_t>(value)); }

std::uint8_t wire_kind(robot::BeamKind kind) {
  switch (kind) {
    case robot::BeamKind::map:
      return 1;
    case robot::BeamKind::person:
      return 2;
    case robot::BeamKind::unexpected_far:
      return 3;
    default:
      return 0;
  }
}

}  // namespace

std::string encode_scan(const robot::ScanView& scan) {
  const auto beams = static_cast<std::uint16_t>(std::min<std::size_t>(scan.ranges.size(), 0xFFFF));
  std::string out;
  out.reserve(32 + 5 * std::size_t{beams});
  put(out, std::uint8_t{1});
  put(out, static_cast<std::uint8_t>(scan.laser));
  put(out, beams);
  put(out, robot::to_seconds(scan.time));
  put(out, static_cast<float>(scan.map_from_laser.x));
  put(out, static_cast<float>(scan.map_from_laser.y));
  put(out, static_cast<float>(scan.map_from_laser.theta));
  put(out, static_cast<float>(scan.angle_min));
  put(out, static_cast<float>(scan.angle_step));
  for (std::size_t i = 0; i < beams; ++i) put(out, scan.ranges[i]);
  for (std::size_t i = 0; i < beams; ++i) {
    put(out, i < scan.kinds.size() ? wire_kind(scan.kinds[i]) : std::uint8_t{0});
  }
  return out;
}

std::string encode_camera_head(std::uint8_t camera, robot::Time time) {
  std::string out;
  put(out, std::uint8_t{3});
  put(out, camera);
  put(out, std::uint16_t{0});
  put(out, robot::to_seconds(time));
  return out;
}

}  // namespace protocols::web
