#include "protocols/serial/sick_telegram.hpp"

namespace serial::sick {

std::uint16_t crc16(ByteSpan bytes) {
  std::uint16_t crc = 0;
  std::uint8_t previous = 0;
  for (const std::uint8_t byte : bytes) {
    const bool top = crc & 0x8000;
    crc = static_cast<std::uint16_t>(crc << 1);
    if (top) crc ^= 0x8005;
    crc ^= static_cast<std::uint16_t>(byte | previous << 8);
    previous = byte;
  }
  return crc;
}

Bytes encode_telegram(std::uint8_t address, ByteSpan payload) {
  ByteWriter out;
  out.u8(stx).u8(address).u16(static_cast<unsigned>(payload.size())).append(payload);
  Bytes bytes = out.take();
  const std::uint16_t crc = crc16(bytes);
  bytes.push_back(static_cast<std::uint8_t>(crc));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8));
  return bytes;
}

FrameBuffer::Verdict TelegramDecoder::judge(ByteSpan waiting) const {
  using Verdict = FrameBuffer::Verdict;
  if (sender_ == Sender::sensor && (waiting[0] == ack || waiting[0] == nak)) return {Verdict::frame, 1};
  if (waiting[0] != stx) return {Verdict::not_a_frame};
  if (waiting.size() < 2) return {Verdict::incomplete};
  if ((waiting[1] >= sensor_address) != (sender_ == Sender::sensor)) return {Verdict::not_a_frame};
  if (waiting.size() < 4) return {Verdict::incomplete};
  const std::size_t length = waiting[2] | static_cast<std::size_t>(waiting[3]) << 8;
  // A sensor sends at least an id and its status.
  if (length < (sender_ == Sender::sensor ? 2u : 1u) || length > max_payload) return {Verdict::not_a_frame};
  const std::size_t size = length + 6;
  if (waiting.size() < size) return {Verdict::incomplete};
  const std::uint16_t crc = crc16(waiting.first(size - 2));
  const bool good = waiting[size - 2] == (crc & 0xFF) && waiting[size - 1] == crc >> 8;
  return {good ? Verdict::frame : Verdict::bad_checksum, size};
}

std::optional<Item> TelegramDecoder::next() {
  const ByteSpan frame = buffer_.next([this](ByteSpan waiting) { return judge(waiting); });
  if (frame.empty()) return std::nullopt;
  if (frame.size() == 1) {
    --buffer_.counts().frames;  // a handshake byte is not a telegram
    return Item{frame[0] == ack ? Item::acknowledged : Item::refused, 0, {}};
  }
  return Item{Item::telegram, frame[1], frame.subspan(4, frame.size() - 6)};
}

}  // namespace serial::sick
