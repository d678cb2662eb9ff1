// Cut, flipped and random bytes on both protocols: nothing crashes, nothing false is believed, and what is whole behind
// the damage is found.
#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "protocols/serial/p2os.hpp"
#include "protocols/serial/sick_scan.hpp"
#include "tests/protocols/serial/hex.hpp"
#include "tests/support/hostile_bytes.hpp"

namespace serial {
namespace {

std::string text(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }
Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

Bytes scan_telegram(std::uint16_t value) {
  sick::Values values;
  values.units = sick::Units::mm;
  values.values.assign(181, value);
  return sick::encode_values(values);
}

Bytes sip_packet(std::uint16_t x) {
  p2os::Sip sip;
  sip.x = x;
  sip.sonars = {{1, 1000}, {2, 2000}};
  return p2os::encode_sip(sip);
}

// Feeds in pieces, falls silent, and gives the marks of what was understood.
std::vector<int> scans_in(const Bytes& stream, std::size_t piece_size) {
  sick::TelegramDecoder decoder(sick::Sender::sensor);
  std::vector<int> found;
  for (ByteSpan rest(stream); !rest.empty();) {
    const std::size_t piece = std::min(rest.size(), piece_size);
    decoder.feed(rest.first(piece));
    rest = rest.subspan(piece);
    while (const auto item = decoder.next()) {
      const auto values = item->kind == sick::Item::telegram ? sick::parse_values(item->payload) : std::nullopt;
      if (values && values->values.size() == 181) found.push_back(values->values[0]);
    }
  }
  return found;
}

std::vector<int> sips_in(const Bytes& stream, std::size_t piece_size = 1) {
  p2os::PacketDecoder decoder;
  std::vector<int> found;
  const auto take = [&] {
    while (const auto body = decoder.next()) {
      if (const auto sip = p2os::parse_sip(*body)) found.push_back(sip->x);
      p2os::parse_command(*body);
      p2os::parse_config(*body);
      p2os::parse_identity(*body);
      p2os::parse_encoders(*body);
    }
  };
  for (ByteSpan rest(stream); !rest.empty();) {
    const std::size_t piece = std::min(rest.size(), piece_size);
    decoder.feed(rest.first(piece));
    rest = rest.subspan(piece);
    take();
  }
  decoder.line_fell_silent();
  take();
  return found;
}

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

RC_GTEST_PROP(HostileStream, WholeScansBehindADamagedOneAreAllFound, ()) {
  const Bytes wounded = bytes_of(*testing_support::damaged(text(scan_telegram(1111))));
  Bytes stream = wounded;
  // A false start may claim up to 818 bytes; what lies within them is looked at again as soon as they are there.
  for (int i = 0; i < 4; ++i) stream = stream + scan_telegram(static_cast<std::uint16_t>(2000 + i));
  stream = stream + Bytes(820, 0);
  auto found = scans_in(stream, *rc::gen::inRange<std::size_t>(1, 400));
  std::erase(found, 1111);  // unless the damage left it whole
  RC_ASSERT(found == (std::vector<int>{2000, 2001, 2002, 2003}));
}

RC_GTEST_PROP(HostileStream, WholeSipsBehindADamagedOneAreAllFound, ()) {
  const Bytes wounded = bytes_of(*testing_support::damaged(text(sip_packet(1111))));
  Bytes stream = wounded;
  for (int i = 0; i < 4; ++i) stream = stream + sip_packet(static_cast<std::uint16_t>(2000 + i));
  auto found = sips_in(stream, *rc::gen::inRange<std::size_t>(1, 100));
  std::erase(found, 1111);
  RC_ASSERT(found == (std::vector<int>{2000, 2001, 2002, 2003}));
}

RC_GTEST_PROP(HostileStream, NoiseIsNeverAScanOrASip, (const std::vector<std::uint8_t>& noise)) {
  RC_ASSERT(scans_in(noise, 7).empty());
  RC_ASSERT(sips_in(noise).empty());
}

TEST(HostileStream, ATelegramInsideTheDataOfAnotherIsNotTakenForOne) {
  // Scan data that spell 02 80 .. again and again.
  sick::Values values;
  values.values.assign(181, 0x8002);
  const Bytes telegram = sick::encode_values(values);
  sick::TelegramDecoder decoder(sick::Sender::sensor);
  decoder.feed(ByteSpan(telegram).subspan(4));  // its own head is lost
  decoder.feed(telegram);
  int found = 0;
  while (decoder.next()) ++found;
  decoder.feed(Bytes(820, 0));
  while (decoder.next()) ++found;
  EXPECT_EQ(found, 1);
  EXPECT_GT(decoder.counts().skipped_bytes, 300u);
}

TEST(HostileStream, HeadersInARowAreOneHeader) {
  const Bytes packet = sip_packet(7);
  EXPECT_THAT(sips_in(Bytes{0xFA} + packet), testing::ElementsAre(7));
  EXPECT_THAT(sips_in(Bytes{0xFA, 0xFA, 0xFA} + packet), testing::ElementsAre(7));
  EXPECT_THAT(sips_in(bytes_of("WMS2\r") + packet), testing::ElementsAre(7));
}

TEST(HostileStream, SilenceEndsATelegramThatWillNeverBeWhole) {
  sick::TelegramDecoder decoder(sick::Sender::sensor);
  decoder.feed(from_hex("02 80 00 03 B0"));  // promises 768 bytes
  decoder.feed(sick::encode_reply(sick::response::mode, Bytes{0}));
  EXPECT_FALSE(decoder.next());
  decoder.line_fell_silent();
  const auto item = decoder.next();
  ASSERT_TRUE(item);
  EXPECT_EQ(item->payload[0], sick::response::mode);
  // Afterwards it waits for the rest of telegrams again.
  const Bytes scan = scan_telegram(5);
  decoder.feed(ByteSpan(scan).first(100));
  EXPECT_FALSE(decoder.next());
  decoder.feed(ByteSpan(scan).subspan(100));
  EXPECT_TRUE(decoder.next());
}

TEST(HostileStream, CountsTellWhatWasLost) {
  Bytes bad = sip_packet(1);
  bad[10] ^= 0x40;
  p2os::PacketDecoder decoder;
  decoder.feed(bad + sip_packet(2));
  while (decoder.next()) {
  }
  EXPECT_EQ(decoder.counts().frames, 1u);
  EXPECT_EQ(decoder.counts().bad_checksums, 1u);
  EXPECT_EQ(decoder.counts().skipped_bytes, bad.size());
}

RC_GTEST_PROP(HostileStream, AnyCommandArgumentSurvivesTheWire, ()) {
  const int argument = *rc::gen::inRange(-65535, 65536);
  const auto number = *rc::gen::arbitrary<std::uint8_t>();
  p2os::PacketDecoder decoder;
  decoder.feed(p2os::encode(static_cast<p2os::Command>(number), argument));
  const auto parsed = p2os::parse_command(*decoder.next());
  RC_ASSERT(parsed.has_value());
  RC_ASSERT(parsed->number == number);
  RC_ASSERT(parsed->argument == argument);
  const auto wheels = p2os::parse_vel2(*rc::gen::just(argument));
  RC_ASSERT(wheels.left >= -128 && wheels.right <= 127);
}

RC_GTEST_PROP(HostileStream, BothWheelsSurviveTheWire, ()) {
  const int left = *rc::gen::inRange(-128, 128), right = *rc::gen::inRange(-128, 128);
  p2os::PacketDecoder decoder;
  decoder.feed(p2os::encode_vel2(left, right));
  const auto wheels = p2os::parse_vel2(*p2os::parse_command(*decoder.next())->argument);
  RC_ASSERT(wheels.left == left);
  RC_ASSERT(wheels.right == right);
}

TEST(HostileStream, LongTextIsCutAndReadBack) {
  p2os::PacketDecoder decoder;
  decoder.feed(p2os::encode(p2os::Command::say, std::string(500, 'x')));
  const auto parsed = p2os::parse_command(*decoder.next());
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->text, std::string(199, 'x'));
}

TEST(HostileStream, ConfigurationSurvivesTheWireAndMayBeShort) {
  p2os::ConfigPacket config;
  config.type = "Pioneer";
  config.subtype = "p3dx-sh";
  config.name = "Docent";
  config.sip_cycle_ms = 50;
  config.watchdog_ms = 2000;
  config.reset_baud = 2;
  config.ticks_mm = 128;
  config.firmware = "2.9";
  const Bytes packet = p2os::encode_config(config);
  p2os::PacketDecoder decoder;
  decoder.feed(packet);
  const Bytes body(packet.begin() + 3, packet.end() - 2);
  const auto parsed = p2os::parse_config(body);
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->subtype, "p3dx-sh");
  EXPECT_EQ(parsed->sip_cycle_ms, 50u);
  EXPECT_EQ(parsed->watchdog_ms, 2000u);
  EXPECT_EQ(parsed->reset_baud, 2u);
  EXPECT_EQ(parsed->ticks_mm, 128u);
  EXPECT_EQ(parsed->firmware, "2.9");
  const auto cut = p2os::parse_config(ByteSpan(body).first(30));
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->ticks_mm, 0u);
}

}  // namespace
}  // namespace serial
