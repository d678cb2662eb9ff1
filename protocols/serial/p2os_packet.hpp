// The packet layer of Pioneer bases (PSOS, P2OS, AROS, ARCOS), the same in both directions:
// | FA FB | count u8 | command or type | arguments ... | checksum u16, high byte first |.
#pragma once

#include <cstdint>
#include <optional>

#include "protocols/serial/bytes.hpp"
#include "protocols/serial/frame_buffer.hpp"

namespace serial::p2os {

// Over command .. last argument: the sum of big-endian words; an odd byte at the end is XORed in.
std::uint16_t checksum(ByteSpan bytes);

// `body`: command or type, then arguments; 1 to 253 bytes.
Bytes encode_packet(ByteSpan body);

class PacketDecoder {
 public:
  void feed(ByteSpan bytes) { buffer_.feed(bytes); }
  // The next packet's body, without header and checksum; nothing when more bytes are needed. Call until it gives
  // nothing. The span stays valid until the next feed().
  std::optional<ByteSpan> next();
  // The line paused: give up the packet that never became whole; next() then looks behind its false start.
  void line_fell_silent() { buffer_.line_fell_silent(); }
  const FrameCounts& counts() const { return buffer_.counts(); }

 private:
  FrameBuffer buffer_;
};

}  // namespace serial::p2os
