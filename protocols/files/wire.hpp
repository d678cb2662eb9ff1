// Little-endian integers and strings, appended to and taken from byte strings. Taking fails softly at the end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace files {

template <typename T>
void put_int(std::string& out, T value) {
  static_assert(std::is_unsigned_v<T>);
  for (std::size_t i = 0; i < sizeof(T); ++i) out += static_cast<char>(value >> (8 * i) & 0xff);
}

// A 32-bit length before the bytes.
inline void put_string(std::string& out, std::string_view text) {
  put_int(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}

class WireReader {
 public:
  explicit WireReader(std::string_view bytes) : bytes_(bytes) {}
  std::size_t left() const { return bytes_.size(); }
  std::string_view rest() const { return bytes_; }

  std::optional<std::string_view> take(std::uint64_t count) {
    if (count > bytes_.size()) return std::nullopt;
    const auto front = bytes_.substr(0, static_cast<std::size_t>(count));
    bytes_.remove_prefix(static_cast<std::size_t>(count));
    return front;
  }
  template <typename T>
  bool take_int(T& value) {
    static_assert(std::is_unsigned_v<T>);
    const auto bytes = take(sizeof(T));
    if (!bytes) return false;
    value = 0;
    for (std::size_t i = sizeof(T); i-- > 0;) {
      value = static_cast<T>(static_cast<std::uint64_t>(value) << 8 | static_cast<unsigned char>((*bytes)[i]));
    }
    return true;
  }
  bool take_string(std::string_view& text) {
    std::uint32_t size = 0;
    const auto bytes = take_int(size) ? take(size) : std::nullopt;
    if (bytes) text = *bytes;
    return bytes.has_value();
  }

 private:
  std::string_view bytes_;
};

}  // namespace files
