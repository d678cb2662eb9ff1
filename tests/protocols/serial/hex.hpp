// Bytes as the references print them: "02 80 0A".
#pragma once

#include <cstdio>
#include <sstream>
#include <string>

#include "protocols/serial/bytes.hpp"

namespace serial {

inline Bytes from_hex(const std::string& text) {
  Bytes bytes;
  std::istringstream in(text);
  for (unsigned byte; in >> std::hex >> byte;) bytes.push_back(static_cast<std::uint8_t>(byte));
  return bytes;
}

inline std::string to_hex(ByteSpan bytes) {
  std::string text;
  char one[4];
  for (const std::uint8_t byte : bytes) {
    std::snprintf(one, sizeof one, "%02X ", byte);
    text += one;
  }
  if (!text.empty()) text.pop_back();
  return text;
}

}  // namespace serial
