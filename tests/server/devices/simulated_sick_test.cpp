// The scanner's side of the wire, told the time: no terminal, no sleeping.
#include "server/devices/simulated_sick.hpp"

#include <gmock/gmock.h>

#include "tests/protocols/serial/hex.hpp"

namespace devices {
namespace {

namespace sick = serial::sick;
using serial::Bytes;
using serial::from_hex;
using serial::to_hex;
using testing::StartsWith;

struct Scanner {
  explicit Scanner(SimulatedSickConfig config = {}) {
    config.scan = [this] {
      ++captures;
      robot::LaserScan scan;
      scan.angle_min = -robot::pi / 2;
      scan.angle_step = robot::radians(1.0);
      for (int i = 0; i < 181; ++i) scan.ranges.push_back(1.0f + 0.01f * static_cast<float>(i));
      return scan;
    };
    device = std::make_unique<SimulatedSick>(config, now);
  }
  // What it answers at once, as hex.
  std::string ask(const Bytes& telegram) {
    device->receive(telegram, now);
    return to_hex(device->take_output());
  }
  std::string ask(const std::string& hex) { return ask(from_hex(hex)); }
  // Lets time pass, calling the device whenever it is due; gives the telegrams it sent, with their moments.
  struct Sent {
    Duration after;
    sick::Values values;
  };
  std::vector<Sent> pass(Duration duration) {
    const Instant begin = now, end = now + duration;
    std::vector<Sent> sent;
    sick::TelegramDecoder decoder(sick::Sender::sensor);
    while (device->due() <= end) {
      now = device->due();
      device->advance(now);
      decoder.feed(device->take_output());
      while (const auto item = decoder.next()) {
        if (item->kind != sick::Item::telegram) continue;
        if (auto values = sick::parse_values(item->payload)) sent.push_back({now - begin, *values});
        if (item->payload[0] == sick::response::power_on) booted = true;
        if (item->payload[0] == sick::response::config_set)
          config_answer.assign(item->payload.begin(), item->payload.end());
      }
    }
    now = end;
    return sent;
  }

  Instant now{};
  int captures = 0;
  bool booted = false;
  Bytes config_answer;
  std::unique_ptr<SimulatedSick> device;
};

TEST(SimulatedSick, AnswersByteForByte) {
  Scanner scanner;
  EXPECT_EQ(scanner.ask("02 00 02 00 20 25 35 08"), "06 02 80 03 00 A0 00 10 16 0A");
  EXPECT_EQ(scanner.ask("02 00 01 00 32 16 12"), "06 02 80 02 00 B2 10 3F 13");
  EXPECT_EQ(scanner.ask("02 00 05 00 3B B4 00 32 00 3B 1F"), "06 02 80 07 00 BB 01 B4 00 32 00 10 03 9D");
  EXPECT_THAT(scanner.ask("02 00 01 00 3A 1E 12"), StartsWith("06 02 80 16 00 BA 4C 4D 53 32 30 30 3B 33 30 31 30 36"));
  EXPECT_THAT(scanner.ask("02 00 01 00 31 15 12"), StartsWith("06 02 80 99 00 B1 56 30 32 2E 31 30"));
  EXPECT_THAT(scanner.ask("02 00 01 00 74 50 12"), StartsWith("06 02 80 24 00 F4 46 00"));
}

TEST(SimulatedSick, WrongPasswordsAndUnknownThingsAreRefused) {
  Scanner scanner;
  EXPECT_EQ(scanner.ask("02 00 0A 00 20 00 53 49 43 4B 5F 50 4C 53 CC FC"), "06 02 80 03 00 A0 01 10 14 0B");
  const Bytes unknown = {0x66}, remission = {0x20, 0x2B, 1, 0, 1, 0, 5, 0}, pls_poll = {0x30, 0x05, 0xB4};
  EXPECT_EQ(scanner.ask(sick::encode_telegram(0, unknown)), "06 02 80 02 00 92 10 7F 33");
  EXPECT_EQ(scanner.ask(sick::encode_telegram(0, pls_poll)), "06 02 80 02 00 92 10 7F 33");
  EXPECT_EQ(scanner.ask(sick::encode_telegram(0, remission)), "06 02 80 03 00 A0 01 10 14 0B");
  EXPECT_EQ(scanner.ask(sick::sub_range_mode(0, 5)), "06 02 80 03 00 A0 01 10 14 0B");
  EXPECT_EQ(scanner.ask(sick::sub_range_mode(100, 182)), "06 02 80 03 00 A0 01 10 14 0B");
  EXPECT_EQ(scanner.ask(sick::mean_mode(0)), "06 02 80 03 00 A0 01 10 14 0B");
  // 180 degrees in quarters do not exist; what was set before stays.
  EXPECT_THAT(scanner.ask(sick::set_variant({180, 25})), StartsWith("06 02 80 07 00 BB 00 B4 00 64 00"));
}

TEST(SimulatedSick, ABadChecksumGetsANegativeAcknowledgementAlone) {
  Scanner scanner;
  EXPECT_EQ(scanner.ask("02 00 02 00 20 25 35 09"), "15");
}

TEST(SimulatedSick, ATelegramMayComeByteByByteButNotWithALongPause) {
  Scanner scanner;
  const Bytes stop = sick::set_mode(sick::mode::on_request);
  for (std::size_t i = 0; i + 1 < stop.size(); ++i) {
    EXPECT_EQ(scanner.ask(Bytes{stop[i]}), "");
    scanner.now += 50ms;
  }
  EXPECT_EQ(scanner.ask(Bytes{stop.back()}), "06 02 80 03 00 A0 00 10 16 0A");
  scanner.ask(Bytes(stop.begin(), stop.end() - 1));
  scanner.now += 500ms;
  EXPECT_EQ(scanner.ask(Bytes{stop.back()}), "");
}

TEST(SimulatedSick, TheBaudChangesAfterTheAnswer) {
  Scanner scanner;
  EXPECT_EQ(scanner.device->baud(), 9600);
  EXPECT_EQ(scanner.ask("02 00 02 00 20 48 58 08"), "06 02 80 03 00 A0 00 10 16 0A");
  EXPECT_EQ(scanner.device->baud(), 500000);
}

TEST(SimulatedSick, AFastLineGets75ScansASecondASlowOneWhatFits) {
  Scanner fast({.baud = 500000});
  fast.ask(sick::set_mode(sick::mode::stream));
  EXPECT_NEAR(static_cast<double>(fast.pass(10s).size()), 750, 2);
  Scanner half({.baud = 500000});
  half.ask(sick::set_variant({180, 50}));
  half.ask(sick::set_mode(sick::mode::stream));
  EXPECT_NEAR(static_cast<double>(half.pass(10s).size()), 375, 2);
  Scanner slow({.baud = 38400});
  slow.ask(sick::set_mode(sick::mode::stream));
  const auto sent = slow.pass(10s);
  EXPECT_NEAR(static_cast<double>(sent.size()), 94, 2);
  EXPECT_EQ(slow.captures, static_cast<int>(sent.size()) + 1);  // one is on its way
}

TEST(SimulatedSick, APollIsAnsweredOnce) {
  Scanner scanner;
  EXPECT_EQ(scanner.ask(sick::poll_all()), "06");
  const auto sent = scanner.pass(2s);
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent[0].values.values.size(), 181u);
}

TEST(SimulatedSick, StopsStreamingWhenToldAndOnAChangeOfAngles) {
  Scanner scanner({.baud = 500000});
  scanner.ask(sick::set_mode(sick::mode::stream));
  EXPECT_FALSE(scanner.pass(100ms).empty());
  scanner.ask(sick::set_mode(sick::mode::on_request));
  EXPECT_TRUE(scanner.pass(100ms).empty());
  scanner.ask(sick::set_mode(sick::mode::stream));
  scanner.ask(sick::set_variant({100, 100}));
  EXPECT_TRUE(scanner.pass(100ms).empty());
  scanner.ask(sick::set_mode(sick::mode::stream));
  scanner.ask(sick::install_mode());
  EXPECT_TRUE(scanner.pass(100ms).empty());
}

TEST(SimulatedSick, MeansSubRangesAndPartialScansHaveTheirOwnTelegrams) {
  Scanner scanner({.baud = 500000});
  scanner.ask(sick::mean_mode(5));
  auto sent = scanner.pass(1s);
  ASSERT_FALSE(sent.empty());
  EXPECT_EQ(sent[0].values.id, sick::response::mean);
  EXPECT_EQ(sent[0].values.mean_of, 5u);
  EXPECT_NEAR(static_cast<double>(sent.size()), 15, 1);

  scanner.ask(sick::sub_range_mode(91, 100));
  sent = scanner.pass(100ms);
  ASSERT_FALSE(sent.empty());
  EXPECT_EQ(sent[0].values.id, sick::response::sub_range);
  EXPECT_EQ(sent[0].values.values.size(), 10u);
  EXPECT_EQ(sent[0].values.values[0], 190);  // cm, straight ahead

  scanner.ask(sick::set_variant({100, 25}));
  scanner.ask(sick::set_mode(sick::mode::stream_partial));
  sent = scanner.pass(200ms);
  ASSERT_GE(sent.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(sent[i].values.partial, static_cast<int>(i % 4));
    EXPECT_EQ(sent[i].values.values.size(), i % 4 == 0 ? 101u : 100u);
  }
}

TEST(SimulatedSick, ConfigurationNeedsThePasswordAndTakesBlocksOfAnyLength) {
  Scanner scanner;
  sick::Config wanted;
  wanted.measuring_mode() = sick::measuring::range_32m;
  wanted.set_units(sick::Units::mm);
  EXPECT_THAT(scanner.ask(sick::set_config(wanted)), StartsWith("06 02 80 25 00 F7 00"));
  scanner.ask(sick::install_mode());
  // Eight bytes, as one well-known host sends it: id and the first seven.
  Bytes short_block = {sick::command::set_config};
  short_block.insert(short_block.end(), wanted.bytes.begin(), wanted.bytes.begin() + 7);
  EXPECT_EQ(scanner.ask(sick::encode_telegram(0, short_block)), "06");
  EXPECT_TRUE(scanner.config_answer.empty());
  scanner.pass(100ms);
  ASSERT_FALSE(scanner.config_answer.empty());
  EXPECT_EQ(scanner.config_answer[1], 1);
  EXPECT_EQ(scanner.device->config(), wanted);
}

TEST(SimulatedSick, ResetBootsAtThePowerOnRateWithItsBanner) {
  Scanner scanner;
  scanner.ask(*sick::set_baud(500000));
  EXPECT_EQ(scanner.ask(sick::ask(sick::command::reset)).substr(0, 17), "06 02 80 02 00 91");
  EXPECT_EQ(scanner.ask(sick::set_mode(sick::mode::on_request)), "");
  scanner.pass(2s);
  EXPECT_TRUE(scanner.booted);
  EXPECT_EQ(scanner.device->baud(), 9600);
  EXPECT_EQ(scanner.ask(sick::set_mode(sick::mode::on_request)), "06 02 80 03 00 A0 00 10 16 0A");
}

}  // namespace
}  // namespace devices
