// The framing of RFC 6455 as bytes in, messages out, seen from the server. Pure: no socket, no clock. A frame is built
// once and can then be sent to any number of viewers.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace protocols::web {

enum class Opcode : std::uint8_t { continuation = 0, text = 1, binary = 2, close = 8, ping = 9, pong = 10 };

// Close codes that Docent uses (RFC 6455, 7.4.1).
namespace close_code {
inline constexpr std::uint16_t normal = 1000, going_away = 1001, protocol_error = 1002, unsupported = 1003,
                               bad_payload = 1007, policy = 1008, too_big = 1009, try_again_later = 1013;
}

// One unfragmented, unmasked frame, header and payload.
std::string encode_frame(Opcode opcode, std::string_view payload);
// The reason must be at most 123 bytes of UTF-8.
std::string encode_close(std::uint16_t code, std::string_view reason);

// The value of Sec-WebSocket-Accept for a client's Sec-WebSocket-Key (RFC 6455, 4.2.2).
std::string accept_key(std::string_view client_key);

// A whole message (fragments joined) or a control frame.
struct Message {
  Opcode opcode = Opcode::text;
  std::string payload;
  friend bool operator==(const Message&, const Message&) = default;
};

// Reads masked client frames. After the first error it takes nothing more.
class FrameReader {
 public:
  // max_message: bytes of one message, its fragments together.
  explicit FrameReader(std::size_t max_message) : max_message_(max_message) {}

  // Appends what has become complete to `out`. Returns the close code when the client broke the rules: 1002 framing,
  // 1007 text that is not UTF-8, 1009 too big. Takes any cut of the byte stream.
  std::optional<std::uint16_t> feed(std::span<const char> bytes, std::vector<Message>& out);

 private:
  std::optional<std::uint16_t> begin_frame();
  std::optional<std::uint16_t> end_frame(std::vector<Message>& out);
  std::size_t header_size() const;

  std::size_t max_message_;
  std::string header_;  // bytes of the header so far
  bool in_payload_ = false;
  bool final_ = false;
  Opcode opcode_ = Opcode::text;
  std::uint64_t left_ = 0;            // bytes of payload still to come
  std::size_t position_ = 0;          // in the payload, for the mask
  std::string control_;               // payload of a control frame
  std::string message_;               // payload of the data message so far
  std::optional<Opcode> fragmented_;  // opcode of an unfinished message
  std::optional<std::uint16_t> failed_;
};

}  // namespace protocols::web
