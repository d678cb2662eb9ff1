#include "protocols/serial/sick_scan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace serial::sick {
namespace {

constexpr unsigned count_mask = 0x03FF;  // bits 0-9 of the count word
constexpr unsigned partial_bit = 1u << 13;

// Codes are the mode's largest number less 0..8 (listing: 8191, 8190, 8189, 8187, 8186, 8183 and their widened forms).
constexpr unsigned codes_below_top = 8;
constexpr unsigned top(int bits) { return (1u << bits) - 1; }

}  // namespace

std::optional<Values> parse_values(ByteSpan payload) {
  if (payload.size() < 2) return std::nullopt;
  ByteReader in(payload.first(payload.size() - 1));
  Values out;
  out.status = payload.back();
  out.id = in.u8();
  const bool mean = out.id == response::mean || out.id == response::mean_sub_range;
  const bool sub_range = out.id == response::sub_range || out.id == response::mean_sub_range;
  if (!mean && !sub_range && out.id != response::scan) return std::nullopt;
  if (mean) out.mean_of = in.u8();
  if (sub_range) {
    out.first = in.u16();
    out.last = in.u16();
  }
  const unsigned word = in.u16();
  const unsigned count = word & count_mask;
  if (word >> 14 > 2 || in.remaining() < 2 * count || in.remaining() > 2 * count + 2) return std::nullopt;
  out.units = static_cast<Units>(word >> 14);
  if (word & partial_bit) out.partial = static_cast<int>(word >> 11 & 3);
  if (!sub_range) out.last = count;
  out.values.resize(count);
  for (auto& value : out.values) value = in.u16();
  return in.ok() ? std::optional(std::move(out)) : std::nullopt;
}

Bytes encode_values(const Values& values, std::optional<std::uint16_t> indices) {
  ByteWriter out;
  out.u8(values.id);
  if (values.id == response::mean || values.id == response::mean_sub_range) out.u8(values.mean_of);
  if (values.id == response::sub_range || values.id == response::mean_sub_range) out.u16(values.first).u16(values.last);
  const auto count = static_cast<unsigned>(values.values.size()) & count_mask;
  unsigned word = count | static_cast<unsigned>(values.units) << 14;
  if (values.partial) word |= partial_bit | static_cast<unsigned>(*values.partial & 3) << 11;
  out.u16(word);
  for (std::size_t i = 0; i < count; ++i) out.u16(values.values[i]);
  if (indices) out.u16(*indices);
  return encode_telegram(sensor_address, out.u8(values.status).take());
}

double metres(Units units) {
  switch (units) {
    case Units::mm:
      return 0.001;
    case Units::cm:
      return 0.01;
    case Units::dm:
      return 0.1;
  }
  return 0.0;
}

double max_range(std::uint8_t measuring_mode, Units units) {
  const auto bits = range_bits(measuring_mode);
  if (!bits) return 0.0;
  // 8, 16, 32 m in millimetres and ten times that in centimetres, where the optics end at 80 m.
  return std::min(80.0, 1000.0 * (1 << (*bits - 10)) * metres(units));
}

std::optional<robot::LaserScan> to_laser_scan(const Values& values, const Geometry& geometry, robot::LaserId laser) {
  const auto bits = range_bits(geometry.measuring_mode);
  const unsigned expected = geometry.variant.values();
  if (!bits || values.values.empty() || values.last > expected || values.first < 1 ||
      values.values.size() != values.last + 1 - values.first) {
    return std::nullopt;
  }
  if (!values.partial && values.id == response::scan && values.values.size() != expected) return std::nullopt;
  robot::LaserScan scan;
  scan.laser = laser;
  scan.angle_step = robot::radians(values.partial ? 1.0 : geometry.variant.resolution_cdeg / 100.0);
  scan.angle_min = robot::radians(-0.5 * geometry.variant.angle_deg + 0.25 * values.partial.value_or(0)) +
                   (values.first - 1) * scan.angle_step;
  scan.max_range = static_cast<float>(max_range(geometry.measuring_mode, values.units));
  const unsigned mask = top(*bits), first_code = mask - codes_below_top;
  const double unit = metres(values.units);
  scan.ranges.reserve(values.values.size());
  for (const std::uint16_t value : values.values) {
    const unsigned range = value & mask;
    const auto in_metres = static_cast<float>(range * unit);
    const bool measured = range < first_code && in_metres <= scan.max_range;
    scan.ranges.push_back(measured ? in_metres : std::numeric_limits<float>::quiet_NaN());
  }
  return scan;
}

Values from_laser_scan(const robot::LaserScan& scan, const Geometry& geometry) {
  Values out;
  out.units = geometry.units;
  const int bits = range_bits(geometry.measuring_mode).value_or(13);
  const unsigned beyond = top(bits) - codes_below_top, not_valid = top(bits);
  const double unit = metres(geometry.units);
  const unsigned count = geometry.variant.values();
  out.last = count;
  out.values.reserve(count);
  for (unsigned i = 0; i < count; ++i) {
    const double angle =
        robot::radians(i * geometry.variant.resolution_cdeg / 100.0 - 0.5 * geometry.variant.angle_deg);
    const double beam = scan.angle_step > 0.0 ? std::round((angle - scan.angle_min) / scan.angle_step) : -1.0;
    unsigned value = not_valid;
    if (beam >= 0.0 && beam < static_cast<double>(scan.ranges.size())) {
      const double counts = std::round(scan.ranges[static_cast<std::size_t>(beam)] / unit);
      value = counts >= 0.0 && counts < beyond ? static_cast<unsigned>(counts) : beyond;  // NaN fails both
    }
    out.values.push_back(static_cast<std::uint16_t>(value));
  }
  return out;
}

}  // namespace serial::sick
