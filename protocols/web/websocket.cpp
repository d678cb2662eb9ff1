#include "protocols/web/websocket.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "protocols/web/decode.hpp"

namespace protocols::web {
namespace {

// SHA-1 (FIPS 180-4): the handshake asks for it, nothing is protected by it.
std::array<unsigned char, 20> sha1(std::string text) {
  std::uint32_t h[5] = {0x67452301, 0xEFCDAB89, 0x98BADCFE, 0x10325476, 0xC3D2E1F0};
  const std::uint64_t bits = text.size() * 8;
  text.push_back(static_cast<char>(0x80));
  while (text.size() % 64 != 56) text.push_back('\0');
  for (int shift = 56; shift >= 0; shift -= 8) text.push_back(static_cast<char>(bits >> shift));
  for (std::size_t block = 0; block < text.size(); block += 64) {
    std::uint32_t w[80];
    for (std::size_t i = 0; i < 16; ++i) {
      w[i] = 0;
      for (std::size_t j = 0; j < 4; ++j) w[i] = (w[i] << 8) | static_cast<unsigned char>(text[block + 4 * i + j]);
    }
    for (std::size_t i = 16; i < 80; ++i) w[i] = std::rotl(w[i - 3] ^ w[i - 8] ^ w[i - 14] ^ w[i - 16], 1);
    std::uint32_t a = h[0], b = h[1], c = h[2], d = h[3], e = h[4];
    for (std::size_t i = 0; i < 80; ++i) {
      const std::uint32_t f = i < 20 ? (b & c) | (~b & d) : i < 40 || i >= 60 ? b ^ c ^ d : (b & c) | (b & d) | (c & d);
      constexpr std::uint32_t k[4] = {0x5A827999, 0x6ED9EBA1, 0x8F1BBCDC, 0xCA62C1D6};
      const std::uint32_t next = std::rotl(a, 5) + f + e + k[i / 20] + w[i];
      e = d, d = c, c = std::rotl(b, 30), b = a, a = next;
    }
    h[0] += a, h[1] += b, h[2] += c, h[3] += d, h[4] += e;
  }
  std::array<unsigned char, 20> digest;
  for (std::size_t i = 0; i < 20; ++i) digest[i] = static_cast<unsigned char>(h[i / 4] >> (24 - 8 * (i % 4)));
  return digest;
}

std::string base64(std::span<const unsigned char> bytes) {
  constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = bytes[i] << 16;
    if (i + 1 < bytes.size()) word |= bytes[i + 1] << 8;
    if (i + 2 < bytes.size()) word |= bytes[i + 2];
    out.push_back(alphabet[word >> 18 & 63]);
    out.push_back(alphabet[word >> 12 & 63]);
    out.push_back(i + 1 < bytes.size() ? alphabet[word >> 6 & 63] : '=');
    out.push_back(i + 2 < bytes.size() ? alphabet[word & 63] : '=');
  }
  return out;
}

bool is_control(Opcode opcode) { return static_cast<std::uint8_t>(opcode) >= 8; }

bool is_known(std::uint8_t opcode) { return opcode <= 2 || (opcode >= 8 && opcode <= 10); }

// The first two bytes of a client's frame: masked, no reserved bits, an opcode that exists.
bool is_well_begun(std::string_view header) {
  return (header[1] & 0x80) && !(header[0] & 0x70) && is_known(static_cast<std::uint8_t>(header[0] & 0x0F));
}

// Codes that a peer may send (RFC 6455, 7.4.2, and the registry's later ones).
bool is_valid_close(std::string_view payload) {
  if (payload.empty()) return true;
  if (payload.size() == 1) return false;
  const int code = static_cast<unsigned char>(payload[0]) << 8 | static_cast<unsigned char>(payload[1]);
  return (code >= 1000 && code <= 1014 && code != 1004 && code != 1005 && code != 1006) ||
         (code >= 3000 && code <= 4999);
}

}  // namespace

std::string encode_frame(Opcode opcode, std::string_view payload) {
  std::string frame;
  frame.reserve(payload.size() + 10);
  frame.push_back(static_cast<char>(0x80 | static_cast<int>(opcode)));
  const std::uint64_t size = payload.size();
  const int extra = size < 126 ? 0 : size < 65536 ? 2 : 8;
  frame.push_back(static_cast<char>(extra == 0 ? size : extra == 2 ? 126 : 127));
  for (int i = extra - 1; i >= 0; --i) frame.push_back(static_cast<char>(size >> (8 * i)));
  return frame.append(payload);
}

std::string encode_close(std::uint16_t code, std::string_view reason) {
  std::string payload{static_cast<char>(code >> 8), static_cast<char>(code & 0xFF)};
  return encode_frame(Opcode::close, payload.append(reason.substr(0, 123)));
}

std::string accept_key(std::string_view client_key) {
  const auto digest = sha1(std::string(client_key) + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11");
  return base64(digest);
}

std::size_t FrameReader::header_size() const {
  if (header_.size() < 2) return 2;
  const int length = header_[1] & 0x7F;
  return std::size_t{2} + (length == 126 ? 2 : length == 127 ? 8 : 0) + 4;  // the mask is required
}

std::optional<std::uint16_t> FrameReader::feed(std::span<const char> bytes, std::vector<Message>& out) {
  if (failed_) return failed_;
  while (true) {
    if (!in_payload_) {
      const std::size_t take = std::min(header_size() - header_.size(), bytes.size());
      header_.append(bytes.data(), take);
      bytes = bytes.subspan(take);
      if (header_.size() == 2 && !is_well_begun(header_)) return failed_ = close_code::protocol_error;
      if (header_.size() < header_size()) {
        if (bytes.empty()) return std::nullopt;
        continue;
      }
      if ((failed_ = begin_frame())) return failed_;
    }
    std::string& payload = is_control(opcode_) ? control_ : message_;
    const std::size_t take = static_cast<std::size_t>(std::min<std::uint64_t>(left_, bytes.size()));
    const std::string_view mask = std::string_view(header_).substr(header_.size() - 4);
    for (std::size_t i = 0; i < take; ++i) payload.push_back(static_cast<char>(bytes[i] ^ mask[position_++ & 3]));
    bytes = bytes.subspan(take);
    left_ -= take;
    if (left_ > 0) return std::nullopt;
    if ((failed_ = end_frame(out))) return failed_;
    if (bytes.empty()) return std::nullopt;
  }
}

std::optional<std::uint16_t> FrameReader::begin_frame() {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(header_[i]); };
  final_ = byte(0) & 0x80;
  opcode_ = static_cast<Opcode>(byte(0) & 0x0F);
  left_ = byte(1) & 0x7F;
  if (left_ >= 126) {
    const std::size_t width = left_ == 126 ? 2 : 8;
    left_ = 0;
    for (std::size_t i = 0; i < width; ++i) left_ = left_ << 8 | byte(2 + i);
    if (left_ < (width == 2 ? 126u : 65536u) || left_ >> 63) return close_code::protocol_error;
  }
  if (is_control(opcode_)) {
    if (!final_ || left_ > 125) return close_code::protocol_error;
  } else {
    if ((opcode_ == Opcode::continuation) != fragmented_.has_value()) return close_code::protocol_error;
    if (left_ > max_message_ - std::min(max_message_, message_.size())) return close_code::too_big;
    if (opcode_ != Opcode::continuation) fragmented_ = opcode_;
  }
  in_payload_ = true;
  position_ = 0;
  return std::nullopt;
}

std::optional<std::uint16_t> FrameReader::end_frame(std::vector<Message>& out) {
  in_payload_ = false;
  header_.clear();
  if (is_control(opcode_)) {
    if (opcode_ == Opcode::close) {
      if (!is_valid_close(control_)) return close_code::protocol_error;
      if (control_.size() > 2 && !is_utf8(std::string_view(control_).substr(2))) return close_code::bad_payload;
    }
    out.push_back({opcode_, std::exchange(control_, {})});
    return std::nullopt;
  }
  if (!final_) return std::nullopt;
  if (*fragmented_ == Opcode::text && !is_utf8(message_)) return close_code::bad_payload;
  out.push_back({*fragmented_, std::exchange(message_, {})});
  fragmented_.reset();
  return std::nullopt;
}

}  // namespace protocols::web
