// Reading and writing numbers in byte streams: little-endian unless the name says otherwise. The reader fails softly:
// past the end it gives zeros and ok() turns false, so that a codec checks once, at its end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace serial {

using Bytes = std::vector<std::uint8_t>;
using ByteSpan = std::span<const std::uint8_t>;

class ByteReader {
 public:
  explicit ByteReader(ByteSpan bytes) : bytes_(bytes) {}

  bool ok() const { return ok_; }
  std::size_t remaining() const { return bytes_.size() - at_; }

  std::uint8_t u8() {
    if (remaining() < 1) return fail();
    return bytes_[at_++];
  }
  std::int8_t s8() { return static_cast<std::int8_t>(u8()); }
  std::uint16_t u16() {
    if (remaining() < 2) return fail();
    const auto value = static_cast<std::uint16_t>(bytes_[at_] | bytes_[at_ + 1] << 8);
    at_ += 2;
    return value;
  }
  std::int16_t s16() { return static_cast<std::int16_t>(u16()); }
  std::uint32_t u32() {
    const std::uint32_t low = u16();
    return low | static_cast<std::uint32_t>(u16()) << 16;
  }
  std::int32_t s32() { return static_cast<std::int32_t>(u32()); }

  // The next `count` bytes; an empty span when there are not as many.
  ByteSpan take(std::size_t count) {
    if (remaining() < count) return fail(), ByteSpan();
    const ByteSpan taken = bytes_.subspan(at_, count);
    at_ += count;
    return taken;
  }
  // Characters up to a NUL, which is eaten too.
  std::string c_string() {
    std::string text;
    while (remaining() > 0) {
      const std::uint8_t c = bytes_[at_++];
      if (c == 0) return text;
      text.push_back(static_cast<char>(c));
    }
    fail();
    return text;
  }

 private:
  std::uint8_t fail() {
    at_ = bytes_.size();
    ok_ = false;
    return 0;
  }

  ByteSpan bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

class ByteWriter {
 public:
  ByteWriter& u8(unsigned value) {
    bytes_.push_back(static_cast<std::uint8_t>(value));
    return *this;
  }
  ByteWriter& u16(unsigned value) { return u8(value).u8(value >> 8); }
  ByteWriter& s16(int value) { return u16(static_cast<unsigned>(value)); }
  ByteWriter& u32(std::uint32_t value) { return u16(value).u16(value >> 16); }
  ByteWriter& append(ByteSpan bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  ByteWriter& text(std::string_view text) {
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    return *this;
  }
  ByteWriter& c_string(std::string_view value) { return text(value).u8(0); }
  std::size_t size() const { return bytes_.size(); }
  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

// What a decoder threw away and why: the health of a line.
struct FrameCounts {
  std::uint64_t frames = 0;         // good ones
  std::uint64_t bad_checksums = 0;  // a whole frame whose checksum was wrong
  std::uint64_t skipped_bytes = 0;  // bytes that belonged to no good frame
};

}  // namespace serial
