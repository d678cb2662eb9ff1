// What Pioneer bases and their hosts say to each other, as values on the wire: commands, the server information packet
// (SIP), and the configuration packet. What they mean in metres is in p2os_base.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocols/serial/p2os_packet.hpp"

namespace serial::p2os {

enum class Command : std::uint8_t {
  pulse = 0,
  open = 1,
  close = 2,  // once the connection is open
  sync0 = 0,
  sync1 = 1,
  sync2 = 2,  // before
  polling = 3,
  enable = 4,
  seta = 5,
  setv = 6,
  seto = 7,
  move = 8,
  rotate = 9,
  setrv = 10,
  vel = 11,
  head = 12,
  dhead = 13,
  say = 15,
  joyrequest = 17,
  config = 18,
  encoder = 19,
  rvel = 21,
  dchead = 22,
  setra = 23,
  sonar = 28,
  stop = 29,
  digout = 30,
  vel2 = 32,
  gripper = 33,
  adsel = 35,
  gripperval = 36,
  iorequest = 40,
  tty2 = 42,
  getaux = 43,
  bumpstall = 44,
  tcm2 = 45,
  joydrive = 47,
  hostbaud = 50,
  e_stop = 55,
  e_stall = 56,
  gyro = 58,
  batteryinfo = 62,
  battest = 250,
  reset = 253,
};

// Types of the robot's packets.
namespace packet {
inline constexpr std::uint8_t config = 0x20, sip_stopped = 0x32, sip_moving = 0x33, encoder = 0x90, sync_error = 0xFF;
}

// ---- Commands -------------------------------------------------------------------------------------------------

Bytes encode(Command command);
// Argument from -65535 to 65535: its sign is the argument's type, its absolute value goes over the wire.
Bytes encode(Command command, int argument);
// At most 199 characters; longer text is cut.
Bytes encode(Command command, std::string_view text);
// Both wheels in units of the model's vel2_divisor, -128..127.
Bytes encode_vel2(int left, int right);

struct ParsedCommand {
  std::uint8_t number = 0;
  std::optional<int> argument;  // signed
  std::string text;
  bool is(Command command) const { return number == static_cast<std::uint8_t>(command); }
};
// From a packet's body. Nothing when its argument is malformed.
std::optional<ParsedCommand> parse_command(ByteSpan body);
struct Wheels {
  int left = 0;
  int right = 0;
};
Wheels parse_vel2(int argument);

// ---- Handshake ------------------------------------------------------------------------------------------------

// What the robot says to SYNC2.
struct Identity {
  std::string name;
  std::string class_name;  // "Pioneer"
  std::string subclass;    // "p3dx-sh": selects the conversion constants
};
std::optional<Identity> parse_identity(ByteSpan body);
Bytes encode_identity(const Identity& identity);

// ---- Server information packet --------------------------------------------------------------------------------

inline constexpr unsigned flag_motors = 1 << 0, flag_sonar = 1 << 1, flag_stop_button = 1 << 5, flag_e_stall = 1 << 6;
inline constexpr unsigned no_echo = 5000;  // sonar counts

struct SonarCount {
  std::uint8_t sonar = 0;
  std::uint16_t range = 0;
  friend bool operator==(const SonarCount&, const SonarCount&) = default;
};

// All in the robot's own counts.
struct Sip {
  bool moving = false;
  std::uint16_t x = 0, y = 0;  // 15 bits, wrap
  std::int16_t theta = 0;
  std::int16_t left = 0, right = 0;
  std::uint8_t battery_dv = 0;  // 0.1 V
  bool left_stall = false, right_stall = false;
  std::uint8_t rear_bumpers = 0, front_bumpers = 0;  // bits 0-6
  std::int16_t control = 0;
  std::uint16_t flags = 0;
  std::uint8_t compass = 0;
  std::vector<SonarCount> sonars;
  std::uint8_t gripper = 0, analog_port = 0, analog = 0, digital_in = 0, digital_out = 0;
  // Newer firmware only.
  std::optional<std::uint16_t> battery_dv10;        // 0.1 V
  std::optional<std::uint8_t> charge_state;         // 0 none .. 4 balance
  std::optional<std::int16_t> rotation_ddeg;        // 0.1 deg/s
  std::optional<std::uint8_t> state_of_charge_pct;  // with the newest firmware
  friend bool operator==(const Sip&, const Sip&) = default;
};
// From a packet's body of type 0x31 (PSOS), 0x32 or 0x33. Everything behind the sonars may be missing.
std::optional<Sip> parse_sip(ByteSpan body);
Bytes encode_sip(const Sip& sip);

// ---- Configuration packet -------------------------------------------------------------------------------------

// The fields that we use, in the order of the packet; the ones between are skipped, a short packet leaves defaults.
struct ConfigPacket {
  std::string type, subtype, serial_number;
  unsigned rotation_top_deg = 0, translation_top_mm = 0;  // deg/s, mm/s
  unsigned rotation_acceleration_top_deg = 0, translation_acceleration_top_mm = 0;
  std::string name;
  unsigned sip_cycle_ms = 0;
  unsigned host_baud = 0;  // 0 9600 .. 4 115200
  bool front_sonar = false, rear_sonar = false;
  unsigned low_battery_dv = 0;
  unsigned watchdog_ms = 0;
  unsigned rotation_max_deg = 0, translation_max_mm = 0;
  unsigned rotation_acceleration_deg = 0, rotation_deceleration_deg = 0;
  unsigned translation_acceleration_mm = 0, translation_deceleration_mm = 0;
  unsigned front_bumpers = 0, rear_bumpers = 0;
  unsigned reset_baud = 0;  // 2: HOSTBAUD may be used
  unsigned ticks_mm = 0;
  std::string firmware;
};
std::optional<ConfigPacket> parse_config(ByteSpan body);
Bytes encode_config(const ConfigPacket& config);

// Cumulative wheel counts, packet 0x90.
struct Encoders {
  std::int32_t left = 0;
  std::int32_t right = 0;
};
std::optional<Encoders> parse_encoders(ByteSpan body);
Bytes encode_encoders(const Encoders& encoders);

}  // namespace serial::p2os
