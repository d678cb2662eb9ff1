// RFC 6455 framing, case by case and under any cut of the byte stream.
#include "protocols/web/websocket.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "tests/support/hostile_bytes.hpp"

using namespace protocols::web;

namespace {

// A client's frame: masked; `first` is the whole first byte.
std::string client_frame(int first, std::string_view payload, std::uint32_t mask = 0x12345678) {
  std::string frame = encode_frame(Opcode::text, payload);
  frame[0] = static_cast<char>(first);
  frame[1] = static_cast<char>(frame[1] | 0x80);
  const std::size_t head = frame.size() - payload.size();
  std::string key;
  for (int i = 3; i >= 0; --i) key.push_back(static_cast<char>(mask >> (8 * i)));
  frame.insert(head, key);
  for (std::size_t i = 0; i < payload.size(); ++i)
    frame[head + 4 + i] = static_cast<char>(frame[head + 4 + i] ^ key[i % 4]);
  return frame;
}

struct Read {
  std::vector<Message> messages;
  std::optional<std::uint16_t> failure;
};
Read read(std::string_view bytes, std::size_t limit = 1000) {
  Read result;
  FrameReader reader(limit);
  result.failure = reader.feed(bytes, result.messages);
  return result;
}

TEST(WebSocketFrames, KnowTheHandshakeOfTheStandard) {
  EXPECT_EQ(accept_key("dGhlIHNhbXBsZSBub25jZQ=="), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");  // RFC 6455, 1.3
}

TEST(WebSocketFrames, HaveTheStandardsBytes) {
  EXPECT_EQ(encode_frame(Opcode::text, "Hello"), "\x81\x05Hello");  // RFC 6455, 5.7
  EXPECT_EQ(encode_frame(Opcode::binary, std::string(256, 'x')).substr(0, 4), std::string("\x82\x7E\x01\x00", 4));
  EXPECT_EQ(encode_frame(Opcode::binary, std::string(65536, 'x')).substr(0, 10),
            std::string("\x82\x7F\0\0\0\0\0\x01\0\0", 10));
  EXPECT_EQ(encode_close(1000, "bye"), std::string("\x88\x05\x03\xE8"
                                                   "bye"));
  EXPECT_EQ(read(std::string("\x81\x85\x37\xfa\x21\x3d\x7f\x9f\x4d\x51\x58")).messages,
            (std::vector<Message>{{Opcode::text, "Hello"}}));
}

TEST(WebSocketFrames, JoinFragmentsWithControlFramesBetween) {
  const std::string bytes =
      client_frame(0x01, "Hel") + client_frame(0x89, "ping") + client_frame(0x00, "l") + client_frame(0x80, "o");
  EXPECT_EQ(read(bytes).messages, (std::vector<Message>{{Opcode::ping, "ping"}, {Opcode::text, "Hello"}}));
}

struct Abuse {
  const char* what;
  std::string bytes;
  std::uint16_t code;
};
class WebSocketAbuse : public testing::TestWithParam<Abuse> {};

TEST_P(WebSocketAbuse, EndsWithItsCode) {
  const Read result = read(GetParam().bytes);
  EXPECT_EQ(result.failure, GetParam().code) << GetParam().what;
}

INSTANTIATE_TEST_SUITE_P(
    All, WebSocketAbuse,
    testing::Values(Abuse{"unmasked", encode_frame(Opcode::text, "x"), 1002},
                    Abuse{"unmasked empty", std::string("\x81\x00", 2), 1002},
                    Abuse{"RSV1", client_frame(0xC1, "x"), 1002}, Abuse{"RSV2", client_frame(0xA1, "x"), 1002},
                    Abuse{"RSV3", client_frame(0x91, "x"), 1002}, Abuse{"opcode 3", client_frame(0x83, "x"), 1002},
                    Abuse{"opcode 7", client_frame(0x87, "x"), 1002}, Abuse{"opcode 11", client_frame(0x8B, "x"), 1002},
                    Abuse{"opcode 15", client_frame(0x8F, "x"), 1002},
                    Abuse{"fragmented ping", client_frame(0x09, "x"), 1002},
                    Abuse{"fragmented close", client_frame(0x08, ""), 1002},
                    Abuse{"long ping", client_frame(0x89, std::string(126, 'x')), 1002},
                    Abuse{"continuation of nothing", client_frame(0x80, "x"), 1002},
                    Abuse{"text inside a text", client_frame(0x01, "a") + client_frame(0x81, "b"), 1002},
                    Abuse{"length in two bytes for one", std::string("\x81\xFE\0\x05\0\0\0\0Hello", 13), 1002},
                    Abuse{"length in eight bytes for one", std::string("\x81\xFF\0\0\0\0\0\0\0\x05\0\0\0\0", 14), 1002},
                    Abuse{"length with its highest bit", std::string("\x81\xFF\x80\0\0\0\0\0\0\x05\0\0\0\0", 14), 1002},
                    Abuse{"huge length", std::string("\x82\xFF\0\xFF\xFF\xFF\xFF\xFF\xFF\xFF\0\0\0\0", 14), 1009},
                    Abuse{"too big", client_frame(0x81, std::string(1001, 'x')), 1009},
                    Abuse{"too big in fragments",
                          client_frame(0x01, std::string(600, 'x')) + client_frame(0x80, std::string(600, 'x')), 1009},
                    Abuse{"bad UTF-8", client_frame(0x81, "\xC3\x28"), 1007},
                    Abuse{"overlong UTF-8", client_frame(0x81, "\xC0\xAF"), 1007},
                    Abuse{"surrogate", client_frame(0x81, "\xED\xA0\x80"), 1007},
                    Abuse{"beyond Unicode", client_frame(0x81, "\xF4\x90\x80\x80"), 1007},
                    Abuse{"cut UTF-8", client_frame(0x81, "\xE2\x82"), 1007},
                    Abuse{"bad UTF-8 over fragments", client_frame(0x01, "\xE2\x82") + client_frame(0x80, "x"), 1007},
                    Abuse{"close with one byte", client_frame(0x88, "x"), 1002},
                    Abuse{"close 999", client_frame(0x88, "\x03\xE7"), 1002},
                    Abuse{"close 1005", client_frame(0x88, "\x03\xED"), 1002},
                    Abuse{"close 1006", client_frame(0x88, "\x03\xEE"), 1002},
                    Abuse{"close 1016", client_frame(0x88, "\x03\xF8"), 1002},
                    Abuse{"close 2999", client_frame(0x88, "\x0B\xB7"), 1002},
                    Abuse{"close 5000", client_frame(0x88, "\x13\x88"), 1002},
                    Abuse{"close with bad UTF-8", client_frame(0x88, "\x03\xE8\xFF"), 1007}));

class WebSocketManners : public testing::TestWithParam<Abuse> {};

TEST_P(WebSocketManners, AreTaken) {
  const Read result = read(GetParam().bytes);
  EXPECT_EQ(result.failure, std::nullopt) << GetParam().what;
  EXPECT_EQ(result.messages.size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(All, WebSocketManners,
                         testing::Values(Abuse{"empty text", client_frame(0x81, ""), 0},
                                         Abuse{"125 bytes", client_frame(0x81, std::string(125, 'x')), 0},
                                         Abuse{"126 bytes", client_frame(0x82, std::string(126, 'x')), 0},
                                         Abuse{"as big as allowed", client_frame(0x82, std::string(1000, 'x')), 0},
                                         Abuse{"ping of 125", client_frame(0x89, std::string(125, 'x')), 0},
                                         Abuse{"unasked pong", client_frame(0x8A, "x"), 0},
                                         Abuse{"close without code", client_frame(0x88, ""), 0},
                                         Abuse{"close 1001", client_frame(0x88, "\x03\xE9"), 0},
                                         Abuse{"close 3000", client_frame(0x88, "\x0B\xB8"), 0},
                                         Abuse{"close 4999", client_frame(0x88, "\x13\x87"), 0},
                                         Abuse{"UTF-8 cut between fragments",
                                               client_frame(0x01, "\xE2\x82") + client_frame(0x80, "\xAC"), 0},
                                         Abuse{"no mask worth the name", client_frame(0x81, "x", 0), 0}));

RC_GTEST_PROP(WebSocketFrames, ComeThroughWholeHoweverTheyAreCut, (const std::vector<std::string>& texts)) {
  std::string bytes;
  std::vector<Message> expected;
  for (const auto& text : texts) {
    const std::string payload = text.substr(0, 500);
    bytes += client_frame(0x82, payload, *rc::gen::arbitrary<std::uint32_t>());
    expected.push_back({Opcode::binary, payload});
  }
  FrameReader reader(1000);
  std::vector<Message> messages;
  for (std::string_view rest = bytes; !rest.empty();) {
    const auto size = *rc::gen::inRange<std::size_t>(1, rest.size() + 1);
    RC_ASSERT(!reader.feed(rest.substr(0, size), messages));
    rest.remove_prefix(size);
  }
  RC_ASSERT(messages == expected);
}

RC_GTEST_PROP(WebSocketFrames, NeverExceedTheLimitWhateverComes, ()) {
  const std::string good = client_frame(0x01, "Hello") + client_frame(0x89, "p") + client_frame(0x80, "world") +
                           client_frame(0x82, std::string(300, 'b'));
  const std::string bytes = *testing_support::damaged(good);
  FrameReader reader(64);
  std::vector<Message> messages;
  const auto failure = reader.feed(bytes, messages);
  for (const Message& message : messages) RC_ASSERT(message.payload.size() <= 125u);
  if (failure) {
    RC_ASSERT(*failure == 1002 || *failure == 1007 || *failure == 1009);
    const std::size_t before = messages.size();
    RC_ASSERT(reader.feed(good, messages) == failure);
    RC_ASSERT(messages.size() == before);
  }
}

}  // namespace
