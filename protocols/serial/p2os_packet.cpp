#include "protocols/serial/p2os_packet.hpp"

namespace serial::p2os {
namespace {

constexpr std::uint8_t header[] = {0xFA, 0xFB};

FrameBuffer::Verdict judge(ByteSpan waiting) {
  using Verdict = FrameBuffer::Verdict;
  if (waiting[0] != header[0]) return {Verdict::not_a_frame};
  if (waiting.size() < 2) return {Verdict::incomplete};
  if (waiting[1] != header[1]) return {Verdict::not_a_frame};
  if (waiting.size() < 3) return {Verdict::incomplete};
  if (waiting[2] < 3) return {Verdict::not_a_frame};
  const std::size_t size = waiting[2] + 3u;
  if (waiting.size() < size) return {Verdict::incomplete};
  const std::uint16_t sum = checksum(waiting.subspan(3, size - 5));
  const bool good = waiting[size - 2] == sum >> 8 && waiting[size - 1] == (sum & 0xFF);
  return {good ? Verdict::frame : Verdict::bad_checksum, size};
}

}  // namespace

std::uint16_t checksum(ByteSpan bytes) {
  std::uint16_t sum = 0;
  std::size_t i = 0;
  for (; i + 1 < bytes.size(); i += 2) sum = static_cast<std::uint16_t>(sum + (bytes[i] << 8 | bytes[i + 1]));
  if (i < bytes.size()) sum ^= bytes[i];
  return sum;
}

Bytes encode_packet(ByteSpan body) {
  const std::uint16_t sum = checksum(body);
  return ByteWriter()
      .append(header)
      .u8(static_cast<unsigned>(body.size() + 2))
      .append(body)
      .u8(sum >> 8)
      .u8(sum)
      .take();
}

std::optional<ByteSpan> PacketDecoder::next() {
  const ByteSpan frame = buffer_.next(judge);
  if (frame.empty()) return std::nullopt;
  return frame.subspan(3, frame.size() - 5);
}

}  // namespace serial::p2os
