#include "protocols/serial/sick_lms.hpp"

#include <algorithm>
#include <utility>

namespace serial::sick {
namespace {

Bytes telegram(ByteWriter& payload) { return encode_telegram(host_address, payload.take()); }

struct BaudWord {
  unsigned baud;
  unsigned divisor_word;  // as the status block tells it
};
constexpr BaudWord baud_words[] = {{9600, 0x8067}, {19200, 0x8033}, {38400, 0x8019}, {500000, 0x8001}};

// Indices of the status block as the reference counts them: 0 is the id, which `data` no longer has.
constexpr std::size_t at(std::size_t index) { return index - 1; }

unsigned word(ByteSpan data, std::size_t index) {
  return data[at(index)] | static_cast<unsigned>(data[at(index + 1)]) << 8;
}

}  // namespace

Bytes set_mode(std::uint8_t mode) { return telegram(ByteWriter().u8(command::mode).u8(mode)); }

Bytes install_mode(std::string_view password) {
  return telegram(ByteWriter().u8(command::mode).u8(mode::install).text(password));
}

std::optional<Bytes> set_baud(int baud) {
  switch (baud) {
    case 9600:
      return set_mode(mode::baud_9600);
    case 19200:
      return set_mode(mode::baud_19200);
    case 38400:
      return set_mode(mode::baud_38400);
    case 500000:
      return set_mode(mode::baud_500000);
    default:
      return std::nullopt;
  }
}

Bytes sub_range_mode(unsigned first, unsigned last) {
  return telegram(ByteWriter().u8(command::mode).u8(mode::stream_sub_range).u16(first).u16(last));
}

Bytes mean_mode(unsigned samples) { return telegram(ByteWriter().u8(command::mode).u8(mode::stream_mean).u8(samples)); }

Bytes ask(std::uint8_t command) { return telegram(ByteWriter().u8(command)); }

Bytes poll_all() { return telegram(ByteWriter().u8(command::poll).u8(0x01)); }

bool Variant::possible() const {
  if (angle_deg == 180) return resolution_cdeg == 100 || resolution_cdeg == 50;
  return angle_deg == 100 && (resolution_cdeg == 100 || resolution_cdeg == 50 || resolution_cdeg == 25);
}

Bytes set_variant(Variant variant) {
  return telegram(ByteWriter().u8(command::variant).u16(variant.angle_deg).u16(variant.resolution_cdeg));
}

std::optional<int> range_bits(std::uint8_t measuring_mode) {
  switch (measuring_mode) {
    case 0x00:
    case 0x01:
    case 0x02:
      return 13;
    case 0x03:
    case 0x04:
      return 14;
    case 0x05:
    case 0x06:
      return 15;
    case 0x0F:
      return 16;
    default:
      return std::nullopt;
  }
}

Bytes set_config(const Config& config) { return telegram(ByteWriter().u8(command::set_config).append(config.block())); }

std::optional<Config> parse_config(ByteSpan block) {
  if (block.size() < 32) return std::nullopt;
  Config config;
  config.size = block.size() < 34 ? 32 : 34;
  std::copy_n(block.begin(), config.size, config.bytes.begin());
  return config;
}

std::optional<Reply> parse_reply(ByteSpan payload) {
  if (payload.size() < 2) return std::nullopt;
  return Reply{payload.front(), payload.subspan(1, payload.size() - 2), payload.back()};
}

Bytes encode_reply(std::uint8_t id, ByteSpan data, std::uint8_t status) {
  return encode_telegram(sensor_address, ByteWriter().u8(id).append(data).u8(status).take());
}

Severity severity(std::uint8_t status) { return static_cast<Severity>(std::min(status & 0x07, 4)); }

std::optional<VariantReply> parse_variant_reply(ByteSpan data) {
  ByteReader in(data);
  VariantReply reply;
  reply.accepted = in.u8() == 1;
  reply.variant.angle_deg = in.u16();
  reply.variant.resolution_cdeg = in.u16();
  return in.ok() ? std::optional(reply) : std::nullopt;
}

std::optional<StatusBlock> parse_status(ByteSpan data) {
  if (data.size() < status_block_size - 1) return std::nullopt;
  StatusBlock status;
  const ByteSpan version = data.first(7);
  status.version.assign(version.begin(), version.end());
  status.operating_mode = data[at(8)];
  status.error = data[at(9)] != 0;
  status.motor_revolutions = word(data, 67);
  status.measuring_mode = data[at(102)];
  status.variant = {word(data, 107), word(data, 109)};
  const auto* rate = std::find_if(std::begin(baud_words), std::end(baud_words),
                                  [&](const BaudWord& b) { return b.divisor_word == word(data, 116); });
  status.baud = rate == std::end(baud_words) ? 0 : rate->baud;
  status.address = data[at(120)];
  status.units = static_cast<Units>(data[at(122)]);
  return status;
}

Bytes encode_status(const StatusBlock& status) {
  Bytes data(status_block_size - 1, 0);
  const auto put_word = [&](std::size_t index, unsigned value) {
    data[at(index)] = static_cast<std::uint8_t>(value);
    data[at(index + 1)] = static_cast<std::uint8_t>(value >> 8);
  };
  for (std::size_t i = 0; i < 7; ++i) data[i] = i < status.version.size() ? status.version[i] : ' ';
  data[at(8)] = status.operating_mode;
  data[at(9)] = status.error;
  put_word(67, status.motor_revolutions);
  data[at(102)] = status.measuring_mode;
  put_word(107, status.variant.angle_deg);
  put_word(109, status.variant.resolution_cdeg);
  for (const BaudWord& rate : baud_words) {
    if (rate.baud == status.baud) put_word(116, rate.divisor_word);
  }
  data[at(120)] = status.address;
  data[at(122)] = static_cast<std::uint8_t>(status.units);
  return encode_reply(response::status, data, status.error ? 0x13 : healthy_status);
}

}  // namespace serial::sick
