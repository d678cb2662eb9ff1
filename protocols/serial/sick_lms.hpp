// What SICK LMS 200/211/220/221/291 scanners and their hosts say to each other, as values: commands, replies, the
// configuration block, the variant and the status block. Scans are in sick_scan.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "protocols/serial/sick_telegram.hpp"

namespace serial::sick {

// Command ids; the answer's id is 0x80 higher.
namespace command {
inline constexpr std::uint8_t reset = 0x10, mode = 0x20, poll = 0x30, status = 0x31, errors = 0x32, type = 0x3A,
                              variant = 0x3B, get_config = 0x74, set_config = 0x77;
}
namespace response {
inline constexpr std::uint8_t power_on = 0x90, reset = 0x91, rejected = 0x92, mode = 0xA0, scan = 0xB0, status = 0xB1,
                              errors = 0xB2, mean = 0xB6, sub_range = 0xB7, type = 0xBA, variant = 0xBB,
                              mean_sub_range = 0xBF, config = 0xF4, config_set = 0xF7;
}
// First byte after command::mode.
namespace mode {
inline constexpr std::uint8_t install = 0x00, diagnostic = 0x10, stream = 0x24, on_request = 0x25, stream_mean = 0x26,
                              stream_sub_range = 0x27, stream_mean_sub_range = 0x28, stream_partial = 0x2A,
                              stream_remission = 0x2B, baud_38400 = 0x40, baud_19200 = 0x41, baud_9600 = 0x42,
                              baud_500000 = 0x48, stream_reflectivity = 0x50;
}

inline constexpr std::string_view lms_password = "SICK_LMS";
inline constexpr std::uint8_t healthy_status = 0x10;

// ---- Telegrams of the host ------------------------------------------------------------------------------------

Bytes set_mode(std::uint8_t mode);
Bytes install_mode(std::string_view password = lms_password);
// 9600, 19200, 38400 or 500000; nothing for any other rate.
std::optional<Bytes> set_baud(int baud);
Bytes sub_range_mode(unsigned first, unsigned last);  // 1-based, inclusive
Bytes mean_mode(unsigned samples);
Bytes ask(std::uint8_t command);  // reset, status, errors, type, get_config
Bytes poll_all();

// The field of view: whole degrees, and hundredths of a degree between beams.
struct Variant {
  unsigned angle_deg = 180;
  unsigned resolution_cdeg = 100;
  unsigned values() const { return resolution_cdeg ? angle_deg * 100 / resolution_cdeg + 1 : 0; }
  // What the scanner offers: 180 at 1 or 0.5 degrees, 100 at 1, 0.5 or 0.25.
  bool possible() const;
  friend bool operator==(const Variant&, const Variant&) = default;
};
Bytes set_variant(Variant variant);

// ---- Configuration --------------------------------------------------------------------------------------------

enum class Units : std::uint8_t { cm = 0, mm = 1, dm = 2 };

// How the 16 bits of a value divide into range and flags.
namespace measuring {
inline constexpr std::uint8_t range_8m = 0x00, range_16m = 0x03, range_32m = 0x06, immediate = 0x0F;
}
// Bits that carry the range: 13, 14, 15 or 16; nothing for modes that do not measure ranges.
std::optional<int> range_bits(std::uint8_t measuring_mode);

// The block of 0x74 and 0x77. Firmware sends 32 or 34 bytes; only what we use has a name, the rest is kept as it came.
struct Config {
  std::array<std::uint8_t, 34> bytes = {70, 0, 0, 0, 0, 0, 0, 0, 0, 2, 2, 0, 0};
  std::size_t size = 34;  // 32 or 34

  std::uint8_t& measuring_mode() { return bytes[5]; }
  std::uint8_t measuring_mode() const { return bytes[5]; }
  Units units() const { return static_cast<Units>(bytes[6]); }
  void set_units(Units units) { bytes[6] = static_cast<std::uint8_t>(units); }
  bool sends_indices() const { return bytes[4] & 0x02; }  // real-time indices follow a scan's values
  ByteSpan block() const { return ByteSpan(bytes).first(size); }
  friend bool operator==(const Config&, const Config&) = default;
};
Bytes set_config(const Config& config);
// From the block alone, behind the id (0xF4) or the verdict (0xF7). Nothing when it is too short.
std::optional<Config> parse_config(ByteSpan block);

// ---- Replies --------------------------------------------------------------------------------------------------

// A telegram of the sensor without its framing: data is what stands between the id and the status byte.
struct Reply {
  std::uint8_t id = 0;
  ByteSpan data;
  std::uint8_t status = 0;
};
std::optional<Reply> parse_reply(ByteSpan payload);
Bytes encode_reply(std::uint8_t id, ByteSpan data, std::uint8_t status = healthy_status);

// Bits 0-2 of the status byte.
enum class Severity { ok = 0, info = 1, warning = 2, error = 3, fatal = 4 };
Severity severity(std::uint8_t status);
inline constexpr bool polluted(std::uint8_t status) { return status & 0x80; }

struct VariantReply {
  bool accepted = false;
  Variant variant;  // in force
};
std::optional<VariantReply> parse_variant_reply(ByteSpan data);

// What we read of the 152-byte status block.
struct StatusBlock {
  std::string version;              // 7 characters
  std::uint8_t operating_mode = 0;  // as in namespace mode
  bool error = false;
  unsigned motor_revolutions = 0;  // as sent
  std::uint8_t measuring_mode = 0;
  Variant variant;
  unsigned baud = 9600;
  std::uint8_t address = 0;
  Units units = Units::cm;
};
inline constexpr std::size_t status_block_size = 152;  // from the id to the last byte before the status byte
// `data` begins behind the id. Nothing when it is too short.
std::optional<StatusBlock> parse_status(ByteSpan data);
Bytes encode_status(const StatusBlock& status);

}  // namespace serial::sick
