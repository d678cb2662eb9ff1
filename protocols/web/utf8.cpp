#include "protocols/web/utf8.hpp"

namespace protocols::web {

std::optional<char32_t> next_code_point(std::string_view& text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  std::size_t length = 1;
  char32_t point = first, least = 0;
  if (first >= 0x80) {
    if (first >= 0xC2 && first <= 0xDF) {
      length = 2, point = first & 0x1F, least = 0x80;
    } else if ((first & 0xF0) == 0xE0) {
      length = 3, point = first & 0x0F, least = 0x800;
    } else if (first >= 0xF0 && first <= 0xF4) {
      length = 4, point = first & 0x07, least = 0x10000;
    } else {
      return std::nullopt;
    }
  }
  if (text.size() < length) return std::nullopt;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return std::nullopt;
    point = (point << 6) | (byte(i) & 0x3F);
  }
  if (point < least || point > 0x10FFFF || (point >= 0xD800 && point <= 0xDFFF)) return std::nullopt;
  text.remove_prefix(length);
  return point;
}

bool is_printable(char32_t point) {
  const auto within = [&](char32_t low, char32_t high) { return point >= low && point <= high; };
  if (point < 0x20 || within(0x7F, 0x9F) || point == 0xAD || point == 0x061C) return false;
  if (within(0x200B, 0x200F) || within(0x2028, 0x202E) || within(0x2060, 0x206F) || point == 0xFEFF) return false;
  if (within(0xFFF9, 0xFFFD) || within(0xFDD0, 0xFDEF) || (point & 0xFFFE) == 0xFFFE) return false;
  return !within(0xE000, 0xF8FF) && point < 0xE0000;
}

}  // namespace protocols::web
