#include "protocols/serial/p2os.hpp"

#include <algorithm>
#include <cstdlib>

namespace serial::p2os {
namespace {

// Types of an argument.
constexpr std::uint8_t positive = 0x3B, negative = 0x1B, string = 0x2B;
constexpr std::size_t longest_string = 199;

unsigned bumper_byte(bool stall, std::uint8_t bumpers) {
  return (stall ? 1u : 0u) | static_cast<unsigned>(bumpers) << 1;
}

}  // namespace

Bytes encode(Command command) {
  const std::uint8_t body[] = {static_cast<std::uint8_t>(command)};
  return encode_packet(body);
}

Bytes encode(Command command, int argument) {
  const unsigned size = std::min(static_cast<unsigned>(std::abs(static_cast<long>(argument))), 0xFFFFu);
  return encode_packet(
      ByteWriter().u8(static_cast<unsigned>(command)).u8(argument < 0 ? negative : positive).u16(size).take());
}

Bytes encode(Command command, std::string_view text) {
  text = text.substr(0, longest_string);
  ByteWriter body;
  body.u8(static_cast<unsigned>(command)).u8(string).u8(static_cast<unsigned>(text.size())).text(text);
  return encode_packet(body.take());
}

Bytes encode_vel2(int left, int right) {
  const auto bytes = static_cast<std::uint16_t>((left & 0xFF) << 8 | (right & 0xFF));
  return encode(Command::vel2, static_cast<std::int16_t>(bytes));
}

std::optional<ParsedCommand> parse_command(ByteSpan body) {
  ByteReader in(body);
  ParsedCommand out;
  out.number = in.u8();
  if (in.ok() && in.remaining() == 0) return out;
  const std::uint8_t type = in.u8();
  if (type == string) {
    const ByteSpan text = in.take(in.u8());
    out.text.assign(text.begin(), text.end());
  } else if (type == positive || type == negative) {
    const int size = in.u16();
    out.argument = type == negative ? -size : size;
  } else {
    return std::nullopt;
  }
  return in.ok() ? std::optional(std::move(out)) : std::nullopt;
}

Wheels parse_vel2(int argument) {
  const auto bytes = static_cast<std::uint16_t>(argument);
  return {static_cast<std::int8_t>(bytes >> 8), static_cast<std::int8_t>(bytes & 0xFF)};
}

std::optional<Identity> parse_identity(ByteSpan body) {
  ByteReader in(body);
  if (in.u8() != static_cast<std::uint8_t>(Command::sync2)) return std::nullopt;
  Identity out{in.c_string(), in.c_string(), in.c_string()};
  return in.ok() ? std::optional(std::move(out)) : std::nullopt;
}

Bytes encode_identity(const Identity& identity) {
  return encode_packet(ByteWriter()
                           .u8(static_cast<unsigned>(Command::sync2))
                           .c_string(identity.name)
                           .c_string(identity.class_name)
                           .c_string(identity.subclass)
                           .take());
}

std::optional<Sip> parse_sip(ByteSpan body) {
  ByteReader in(body);
  const std::uint8_t type = in.u8();
  if (type < 0x31 || type > packet::sip_moving) return std::nullopt;
  Sip out;
  out.moving = type == packet::sip_moving;
  out.x = in.u16() & 0x7FFF;
  out.y = in.u16() & 0x7FFF;
  out.theta = in.s16();
  out.left = in.s16();
  out.right = in.s16();
  out.battery_dv = in.u8();
  const std::uint8_t rear = in.u8(), front = in.u8();
  out.left_stall = rear & 1;
  out.right_stall = front & 1;
  out.rear_bumpers = rear >> 1;
  out.front_bumpers = front >> 1;
  out.control = in.s16();
  out.flags = in.u16();
  out.compass = in.u8();
  const unsigned count = in.u8();
  if (!in.ok() || in.remaining() < 3 * count) return std::nullopt;
  out.sonars.resize(count);
  for (auto& sonar : out.sonars) sonar = {in.u8(), in.u16()};
  if (in.remaining() >= 5) {
    out.gripper = in.u8();
    out.analog_port = in.u8();
    out.analog = in.u8();
    out.digital_in = in.u8();
    out.digital_out = in.u8();
  }
  if (in.remaining() >= 2) out.battery_dv10 = in.u16();
  if (in.remaining() >= 1) out.charge_state = in.u8();
  if (in.remaining() >= 2) out.rotation_ddeg = in.s16();
  if (in.remaining() >= 6) {
    in.take(2 + 2 + 1);  // fault flags, lateral velocity, temperature
    out.state_of_charge_pct = in.u8();
  }
  return out;
}

Bytes encode_sip(const Sip& sip) {
  ByteWriter out;
  out.u8(sip.moving ? packet::sip_moving : packet::sip_stopped).u16(sip.x & 0x7FFF).u16(sip.y & 0x7FFF);
  out.s16(sip.theta).s16(sip.left).s16(sip.right).u8(sip.battery_dv);
  out.u8(bumper_byte(sip.left_stall, sip.rear_bumpers)).u8(bumper_byte(sip.right_stall, sip.front_bumpers));
  out.s16(sip.control).u16(sip.flags).u8(sip.compass).u8(static_cast<unsigned>(sip.sonars.size()));
  for (const SonarCount& sonar : sip.sonars) out.u8(sonar.sonar).u16(sonar.range);
  out.u8(sip.gripper).u8(sip.analog_port).u8(sip.analog).u8(sip.digital_in).u8(sip.digital_out);
  if (sip.battery_dv10) {
    out.u16(*sip.battery_dv10);
    if (sip.charge_state) {
      out.u8(*sip.charge_state);
      if (sip.rotation_ddeg) {
        out.s16(*sip.rotation_ddeg);
        if (sip.state_of_charge_pct) out.u16(0).u16(0).u8(25).u8(*sip.state_of_charge_pct).u32(0);
      }
    }
  }
  return encode_packet(out.take());
}

std::optional<ConfigPacket> parse_config(ByteSpan body) {
  ByteReader in(body);
  if (in.u8() != packet::config) return std::nullopt;
  ConfigPacket out;
  out.type = in.c_string();
  out.subtype = in.c_string();
  out.serial_number = in.c_string();
  in.u8();
  out.rotation_top_deg = in.u16();
  out.translation_top_mm = in.u16();
  out.rotation_acceleration_top_deg = in.u16();
  out.translation_acceleration_top_mm = in.u16();
  in.u16();  // largest pulse width
  out.name = in.c_string();
  out.sip_cycle_ms = in.u8();
  out.host_baud = in.u8();
  in.take(1 + 2);  // aux baud, gripper
  out.front_sonar = in.u16() != 0;
  out.rear_sonar = in.u8() != 0;
  out.low_battery_dv = in.u16();
  in.u16();  // counts a turn
  out.watchdog_ms = in.u16();
  in.take(1 + 4 * 2);  // extended packets, stall value and count, joystick speeds
  out.rotation_max_deg = in.u16();
  out.translation_max_mm = in.u16();
  out.rotation_acceleration_deg = in.u16();
  out.rotation_deceleration_deg = in.u16();
  in.take(3 * 2);
  out.translation_acceleration_mm = in.u16();
  out.translation_deceleration_mm = in.u16();
  in.take(3 * 2);
  out.front_bumpers = in.u8();
  out.rear_bumpers = in.u8();
  in.take(1 + 1);  // charger, sonar cycle
  out.reset_baud = in.u8();
  in.take(1 + 2 + 1 + 1);  // gyro, drift factor, aux bauds
  out.ticks_mm = in.u16();
  in.u16();  // shutdown volts
  out.firmware = in.c_string();
  return out;
}

Bytes encode_config(const ConfigPacket& config) {
  ByteWriter out;
  out.u8(packet::config).c_string(config.type).c_string(config.subtype).c_string(config.serial_number).u8(0);
  out.u16(config.rotation_top_deg).u16(config.translation_top_mm);
  out.u16(config.rotation_acceleration_top_deg).u16(config.translation_acceleration_top_mm).u16(500);
  out.c_string(config.name).u8(config.sip_cycle_ms).u8(config.host_baud).u8(0).u16(0);
  out.u16(config.front_sonar).u8(config.rear_sonar).u16(config.low_battery_dv).u16(16570).u16(config.watchdog_ms);
  out.u8(0).u16(200).u16(20).u16(200).u16(30);
  out.u16(config.rotation_max_deg).u16(config.translation_max_mm);
  out.u16(config.rotation_acceleration_deg).u16(config.rotation_deceleration_deg).u16(40).u16(20).u16(0);
  out.u16(config.translation_acceleration_mm).u16(config.translation_deceleration_mm).u16(40).u16(30).u16(0);
  out.u8(config.front_bumpers).u8(config.rear_bumpers).u8(0).u8(40).u8(config.reset_baud);
  out.u8(0).s16(0).u8(0).u8(0).u16(config.ticks_mm).u16(0).c_string(config.firmware);
  return encode_packet(out.take());
}

std::optional<Encoders> parse_encoders(ByteSpan body) {
  ByteReader in(body);
  if (in.u8() != packet::encoder) return std::nullopt;
  Encoders out{in.s32(), in.s32()};
  return in.ok() ? std::optional(out) : std::nullopt;
}

Bytes encode_encoders(const Encoders& encoders) {
  return encode_packet(ByteWriter()
                           .u8(packet::encoder)
                           .u32(static_cast<std::uint32_t>(encoders.left))
                           .u32(static_cast<std::uint32_t>(encoders.right))
                           .take());
}

}  // namespace serial::p2os
