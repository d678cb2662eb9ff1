// The value telegrams of SICK LMS scanners (0xB0, 0xB6, 0xB7, 0xBF) and what they mean as a robot::LaserScan.
// Beam 0 points to the right; the beams go round counter-clockwise, seen from above with the unit upright.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "protocols/serial/sick_lms.hpp"
#include "robot/inputs.hpp"

namespace serial::sick {

// A value telegram as it stands on the wire: values still carry their flag bits.
struct Values {
  std::uint8_t id = response::scan;
  unsigned mean_of = 0;  // 0xB6, 0xBF: scans averaged
  unsigned first = 1;    // 0xB7, 0xBF: sub-range, 1-based, inclusive
  unsigned last = 0;
  Units units = Units::cm;
  std::optional<int> partial;  // 0..3: this scan began at that many quarter degrees
  std::vector<std::uint16_t> values;
  std::uint8_t status = healthy_status;
  friend bool operator==(const Values&, const Values&) = default;
};
// From a sensor's payload, id and status included. Real-time indices behind the values are let be. Nothing when the
// id is another, the count does not fit the length, or the units are invalid.
std::optional<Values> parse_values(ByteSpan payload);
// The whole telegram. `indices`: the two real-time index bytes that go behind the values if the scanner is set so.
Bytes encode_values(const Values& values, std::optional<std::uint16_t> indices = std::nullopt);

// How a scanner is set: what turns numbers on the wire into metres and angles.
struct Geometry {
  Variant variant;
  std::uint8_t measuring_mode = measuring::range_32m;
  Units units = Units::mm;
};
double metres(Units units);                                  // of one count; 0 for invalid units
double max_range(std::uint8_t measuring_mode, Units units);  // m; nominal, never above the scanner's 80 m; 0: none

// Special codes (not valid, dazzled, overflow, noise, beyond maximum) become NaN, flag bits are dropped. Time is left
// at zero for the caller, who knows when the bytes came. Nothing when the number of values does not fit the variant or
// the measuring mode has no ranges.
std::optional<robot::LaserScan> to_laser_scan(const Values& values, const Geometry& geometry, robot::LaserId laser);

// What a scanner set like this says of a scan whose beams lie as the variant wants them. NaN, infinite and too long
// ranges become the code for "beyond maximum"; beams that the scan has not, "not valid".
Values from_laser_scan(const robot::LaserScan& scan, const Geometry& geometry);

}  // namespace serial::sick
