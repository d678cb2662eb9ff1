// Every byte-exact example of the SICK LMS reference, both ways where there are two.
#include <gmock/gmock.h>

#include "protocols/serial/sick_lms.hpp"
#include "protocols/serial/sick_scan.hpp"
#include "tests/protocols/serial/hex.hpp"

namespace serial::sick {
namespace {

// The one telegram in these bytes.
Bytes only_payload(const std::string& hex, Sender sender) {
  TelegramDecoder decoder(sender);
  decoder.feed(from_hex(hex));
  Bytes payload;
  int telegrams = 0;
  while (const auto item = decoder.next()) {
    if (item->kind != Item::telegram) continue;
    ++telegrams;
    payload.assign(item->payload.begin(), item->payload.end());
  }
  EXPECT_EQ(telegrams, 1) << hex;
  EXPECT_EQ(decoder.counts().skipped_bytes, 0u) << hex;
  return payload;
}

struct Command {
  const char* what;
  Bytes bytes;
  const char* hex;
};

TEST(SickGolden, Commands) {
  const Command commands[] = {
      {"38400", *set_baud(38400), "02 00 02 00 20 40 50 08"},
      {"19200", *set_baud(19200), "02 00 02 00 20 41 51 08"},
      {"9600", *set_baud(9600), "02 00 02 00 20 42 52 08"},
      {"500k", *set_baud(500000), "02 00 02 00 20 48 58 08"},
      {"stream", set_mode(mode::stream), "02 00 02 00 20 24 34 08"},
      {"on request", set_mode(mode::on_request), "02 00 02 00 20 25 35 08"},
      {"partial", set_mode(mode::stream_partial), "02 00 02 00 20 2A 3A 08"},
      {"install LMS", install_mode(), "02 00 0A 00 20 00 53 49 43 4B 5F 4C 4D 53 BE C5"},
      {"install PLS", install_mode("SICK_PLS"), "02 00 0A 00 20 00 53 49 43 4B 5F 50 4C 53 CC FC"},
      {"type", ask(command::type), "02 00 01 00 3A 1E 12"},
      {"status", ask(command::status), "02 00 01 00 31 15 12"},
      {"errors", ask(command::errors), "02 00 01 00 32 16 12"},
      {"get config", ask(command::get_config), "02 00 01 00 74 50 12"},
      {"reset", ask(command::reset), "02 00 01 00 10 34 12"},
      {"poll", poll_all(), "02 00 02 00 30 01 31 18"},
      {"180/1", set_variant({180, 100}), "02 00 05 00 3B B4 00 64 00 97 49"},
      {"180/0.5", set_variant({180, 50}), "02 00 05 00 3B B4 00 32 00 3B 1F"},
      {"100/1", set_variant({100, 100}), "02 00 05 00 3B 64 00 64 00 1D 0F"},
      {"100/0.5", set_variant({100, 50}), "02 00 05 00 3B 64 00 32 00 B1 59"},
      {"100/0.25", set_variant({100, 25}), "02 00 05 00 3B 64 00 19 00 E7 72"},
      {"sub-range", sub_range_mode(1, 181), "02 00 06 00 20 27 01 00 B5 00 12 09"},
      {"mean of 5", mean_mode(5), "02 00 03 00 20 26 05 79 3E"},
  };
  for (const Command& command : commands) {
    EXPECT_EQ(to_hex(command.bytes), command.hex) << command.what;
    EXPECT_FALSE(only_payload(command.hex, Sender::host).empty());
  }
  const Bytes pls_poll = {0x30, 0x05, 0xB4};
  EXPECT_EQ(to_hex(encode_telegram(host_address, pls_poll)), "02 00 03 00 30 05 B4 CE 3D");
  EXPECT_FALSE(set_baud(115200));
}

TEST(SickGolden, Replies) {
  struct Example {
    std::uint8_t id;
    Bytes data;
    const char* hex;
  };
  const std::string banner = "LMS200;30106;V02.10";
  const Example examples[] = {
      {response::mode, {0x00}, "02 80 03 00 A0 00 10 16 0A"},
      {response::mode, {0x01}, "02 80 03 00 A0 01 10 14 0B"},
      {response::variant, {0x01, 0xB4, 0x00, 0x32, 0x00}, "02 80 07 00 BB 01 B4 00 32 00 10 03 9D"},
      {response::errors, {}, "02 80 02 00 B2 10 3F 13"},
      {response::rejected, {}, "02 80 02 00 92 10 7F 33"},
      {response::power_on, Bytes(banner.begin(), banner.end()),
       "02 80 15 00 90 4C 4D 53 32 30 30 3B 33 30 31 30 36 3B 56 30 32 2E 31 30 10 A2 28"},
  };
  for (const Example& example : examples) {
    EXPECT_EQ(to_hex(encode_reply(example.id, example.data)), example.hex);
    const Bytes payload = only_payload(example.hex, Sender::sensor);
    const auto reply = parse_reply(payload);
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->id, example.id);
    EXPECT_EQ(to_hex(reply->data), to_hex(example.data));
    EXPECT_EQ(reply->status, healthy_status);
  }
}

TEST(SickGolden, AcknowledgementComesBeforeTheTelegram) {
  TelegramDecoder decoder(Sender::sensor);
  decoder.feed(from_hex("06 02 80 03 00 A0 00 10 16 0A"));
  const auto first = decoder.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->kind, Item::acknowledged);
  const auto second = decoder.next();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->kind, Item::telegram);
  EXPECT_FALSE(decoder.next());
  EXPECT_EQ(decoder.counts().frames, 1u);
}

TEST(SickGolden, ThreeValueScan) {
  const char* hex = "02 80 0A 00 B0 03 40 00 04 01 04 F7 1F 10 84 62";
  const auto values = parse_values(only_payload(hex, Sender::sensor));
  ASSERT_TRUE(values);
  EXPECT_EQ(values->units, Units::mm);
  EXPECT_THAT(values->values, testing::ElementsAre(1024, 1025, 8183));
  EXPECT_EQ(values->status, healthy_status);
  EXPECT_EQ(to_hex(encode_values(*values)), hex);
}

TEST(SickGolden, HeadsOfScans) {
  const auto head = [](std::size_t count, Units units) {
    Values values;
    values.units = units;
    values.values.assign(count, 1000);
    const Bytes bytes = encode_values(values);
    return to_hex(ByteSpan(bytes).first(7));
  };
  EXPECT_EQ(head(181, Units::cm), "02 80 6E 01 B0 B5 00");
  EXPECT_EQ(head(181, Units::mm), "02 80 6E 01 B0 B5 40");
  EXPECT_EQ(head(361, Units::mm), "02 80 D6 02 B0 69 41");
}

TEST(SickGolden, SizesOfScanTelegrams) {
  for (const auto& [count, size] : {std::pair{101, 212}, {181, 372}, {201, 412}, {361, 732}, {401, 812}}) {
    Values values;
    values.values.assign(static_cast<std::size_t>(count), 1);
    EXPECT_EQ(encode_values(values).size(), static_cast<std::size_t>(size));
  }
}

TEST(SickGolden, StatusBlockHasItsFieldsWhereTheReferenceCountsThem) {
  StatusBlock status;
  status.version = "V02.10 ";
  status.operating_mode = mode::on_request;
  status.variant = {180, 50};
  status.baud = 38400;
  status.measuring_mode = 6;
  status.units = Units::mm;
  const Bytes telegram = encode_status(status);
  const ByteSpan block = ByteSpan(telegram).subspan(4);  // index 0: the id
  ASSERT_EQ(telegram.size(), status_block_size + 1 + 6);
  EXPECT_EQ(block[0], 0xB1);
  EXPECT_EQ(block[1], 'V');
  EXPECT_EQ(block[8], mode::on_request);
  EXPECT_EQ(block[102], 6);
  EXPECT_EQ(block[107], 180);
  EXPECT_EQ(block[109], 50);
  EXPECT_EQ(block[116], 0x19);
  EXPECT_EQ(block[117], 0x80);
  EXPECT_EQ(block[122], 1);
  const auto parsed = parse_status(block.subspan(1, status_block_size - 1));
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->variant, status.variant);
  EXPECT_EQ(parsed->baud, 38400u);
  EXPECT_EQ(parsed->units, Units::mm);
}

}  // namespace
}  // namespace serial::sick
