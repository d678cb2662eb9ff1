// The telegram layer of SICK LMS 2xx laser scanners: framing, CRC and the one-byte handshake.
// | STX 02 | address | length u16 | payload ... | CRC u16 |, little-endian; the payload begins with the command or
// response id, and a sensor's payload ends with its status byte.
#pragma once

#include <cstdint>
#include <optional>

#include "protocols/serial/bytes.hpp"
#include "protocols/serial/frame_buffer.hpp"

namespace serial::sick {

inline constexpr std::uint8_t stx = 0x02;
inline constexpr std::uint8_t ack = 0x06;  // telegram received intact; comes before the response
inline constexpr std::uint8_t nak = 0x15;  // bad CRC or not understood; no response follows
inline constexpr std::uint8_t host_address = 0x00;
inline constexpr std::uint8_t sensor_address = 0x80;
inline constexpr std::size_t max_payload = 812;  // 401 values with all extras stay below

// One shift a byte, not a bit: no library CRC-16 gives this. See the reference's "CRC16".
std::uint16_t crc16(ByteSpan bytes);

// `payload`: from the id to the last byte before the CRC.
Bytes encode_telegram(std::uint8_t address, ByteSpan payload);

// What a line carries: telegrams, and single bytes between them.
struct Item {
  enum Kind { telegram, acknowledged, refused } kind = telegram;
  std::uint8_t address = 0;
  ByteSpan payload;  // of a telegram; valid until the next feed()
};

// Who sends: the two directions differ in their addresses, which makes false starts rarer.
enum class Sender { host, sensor };

class TelegramDecoder {
 public:
  explicit TelegramDecoder(Sender sender) : sender_(sender) {}

  void feed(ByteSpan bytes) { buffer_.feed(bytes); }
  // Call until it gives nothing.
  std::optional<Item> next();
  // The line paused: give up the telegram that never became whole; next() then looks behind its false start.
  void line_fell_silent() { buffer_.line_fell_silent(); }
  const FrameCounts& counts() const { return buffer_.counts(); }

 private:
  FrameBuffer::Verdict judge(ByteSpan waiting) const;

  Sender sender_;
  FrameBuffer buffer_;
};

}  // namespace serial::sick
