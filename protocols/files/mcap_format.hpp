// Numbers of the MCAP format that writer and reader share (https://mcap.dev/spec).
#pragma once

#include <cstdint>
#include <string_view>

namespace files::mcap {

inline constexpr std::string_view magic{"\x89MCAP0\r\n", 8};

enum Opcode : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0b,
  metadata = 0x0c,
  metadata_index = 0x0d,
  summary_offset = 0x0e,
  data_end = 0x0f,
};

}  // namespace files::mcap
