#include "server/devices/sick_link.hpp"

#include <gmock/gmock.h>

#include "robot/geometry/random.hpp"
#include "tests/server/devices/line_bench.hpp"

namespace devices {
namespace {

using robot::Device;
using robot::LaserScan;

TEST(SickLink, FindsTheScannerAtItsPowerOnRateAndStreamsInMillimetres) {
  SickBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.count<LaserScan>() >= 10; })) << bench.state(Device::laser_front);
  EXPECT_EQ(bench.sick->baud(), 500000);
  EXPECT_EQ(bench.link->statistics().baud, 500000);
  EXPECT_THAT(bench.link->statistics().identity, testing::HasSubstr("LMS200;30106"));
  EXPECT_EQ(bench.sick->config().measuring_mode(), serial::sick::measuring::range_32m);
  const LaserScan scan = bench.all<LaserScan>().back();
  ASSERT_EQ(scan.ranges.size(), 181u);
  EXPECT_NEAR(scan.angle_min, -robot::pi / 2, 1e-12);
  EXPECT_NEAR(scan.angle_step, robot::radians(1.0), 1e-12);
  EXPECT_FLOAT_EQ(scan.max_range, 32.0f);
  EXPECT_TRUE(std::isnan(scan.ranges[5]));
  EXPECT_NEAR(scan.ranges[180], 1.0 + 3.6, 0.0016);
  EXPECT_NEAR(scan.ranges[0], 1.0, 0.0016);
}

TEST(SickLink, RunsAt38400Too) {
  SickBench bench({}, {.baud = 38400});
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.count<LaserScan>() >= 5; })) << bench.state(Device::laser_front);
  EXPECT_EQ(bench.sick->baud(), 38400);
}

TEST(SickLink, StampsTheMiddleOfTheSweepNotTheArrival) {
  SickBench bench({}, {.baud = 38400});
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.count<LaserScan>() >= 3; }));
  // 372 bytes at 38400 baud and half a sweep lie between.
  const robot::Seconds age = bench.clock()() - bench.all<LaserScan>().back().time;
  EXPECT_GT(age.count(), 0.0969 + 0.0033 - 1e-4);
}

TEST(SickLink, HalfDegreesAreTwiceAsMany) {
  SickBench bench({}, {.variant = {180, 50}});
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.streaming(); })) << bench.state(Device::laser_front);
  EXPECT_EQ(bench.all<LaserScan>().back().ranges.size(), 361u);
}

TEST(SickLink, SetsUpOverALineThatDamagesMuchOfWhatIsSaid) {
  using Damage = SimulatedLine::Damage;
  for (const Damage kind : {Damage::cut, Damage::flip, Damage::random}) {
    SickBench bench;
    bench.line->damage(kind, 0.05);  // of the pieces in which bytes go over the line: a third of the telegrams
    bench.link->start();
    EXPECT_TRUE(bench.run_until([&] { return bench.streaming(); })) << bench.state(Device::laser_front);
  }
}

TEST(SickLink, FirmwareWithAShortConfigurationBlockIsServedToo) {
  SickBench bench({.config_bytes = 32});
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.streaming(); })) << bench.state(Device::laser_front);
  EXPECT_EQ(bench.sick->config().units(), serial::sick::Units::mm);
}

TEST(SickLink, AScannerThatStillStreamsFromBeforeIsTakenOver) {
  SickBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.streaming(); }));
  // A second link finds it at 500 kbaud in the middle of its stream.
  bench.line->unplug();
  ASSERT_TRUE(bench.run_until([&] { return !bench.connected(Device::laser_front); }));
  EXPECT_EQ(bench.sick->mode(), serial::sick::mode::stream);
  bench.link->stop();
  bench.line->plug();
  std::vector<robot::Event> seen;
  SickLink second(bench.context.get_executor(), {.path = bench.line->name().string()}, bench.clock(),
                  [&](robot::Event event) { seen.push_back(std::move(event)); });
  second.start();
  EXPECT_TRUE(bench.run_until([&] { return seen.size() > 3; }));
  second.stop();
  bench.run_for(10ms);
}

TEST(SickLink, AnUnpluggedLaserIsLostAtOnceAndFoundAgain) {
  SickBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.streaming(); }));
  bench.line->unplug();
  ASSERT_TRUE(bench.run_until([&] { return !bench.connected(Device::laser_front); }));
  EXPECT_THAT(bench.state(Device::laser_front), testing::HasSubstr("broke"));
  bench.run_for(300ms);
  EXPECT_THAT(bench.state(Device::laser_front), testing::HasSubstr("cannot open"));
  const auto before = bench.count<LaserScan>();
  bench.line->plug();
  EXPECT_TRUE(
      bench.run_until([&] { return bench.connected(Device::laser_front) && bench.count<LaserScan>() > before; }));
  EXPECT_EQ(bench.link->statistics().connections, 2u);
}

TEST(SickLink, ASilentLaserIsLost) {
  SickBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.streaming(); }));
  bench.sick->set_silent(true);
  ASSERT_TRUE(bench.run_until([&] { return !bench.connected(Device::laser_front); }));
  EXPECT_THAT(bench.state(Device::laser_front), testing::HasSubstr("no scan for"));
  bench.sick->set_silent(false);
  EXPECT_TRUE(bench.run_until([&] { return bench.connected(Device::laser_front); }));
}

TEST(SickLink, ALaserThatRepeatsItselfIsLost) {
  SickBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.streaming(); }));
  bench.sick->set_frozen(true);
  ASSERT_TRUE(bench.run_until([&] { return !bench.connected(Device::laser_front); }));
  EXPECT_THAT(bench.state(Device::laser_front), testing::HasSubstr("repeats the same scan"));
  bench.sick->set_frozen(false);
  EXPECT_TRUE(bench.run_until([&] { return bench.connected(Device::laser_front); }));
}

TEST(SickLink, ScansOfALaserThatReportsAnErrorAreWorthless) {
  SickBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.streaming(); }));
  bench.sick->set_status(0x14);
  ASSERT_TRUE(bench.run_until([&] { return !bench.connected(Device::laser_front); }));
  EXPECT_THAT(bench.state(Device::laser_front), testing::HasSubstr("status 0x14"));
}

TEST(SickLink, GarbageBetweenScansCostsAtMostAFewOfThem) {
  SickBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.streaming(); }));
  robot::Random random(7);
  for (int i = 0; i < 20; ++i) {
    serial::Bytes noise(1 + random.index(60));
    for (auto& byte : noise) byte = static_cast<std::uint8_t>(random());
    bench.line->inject(noise);
    const auto before = bench.count<LaserScan>();
    ASSERT_TRUE(bench.run_until([&] { return bench.count<LaserScan>() > before; })) << "after noise " << i;
  }
  for (const LaserScan& scan : bench.all<LaserScan>()) EXPECT_NEAR(scan.ranges[90], 2.8, 0.0016);
  EXPECT_GT(bench.link->statistics().skipped_bytes, 0u);
}

TEST(SickLink, ALineFullOfDamageIsGivenUp) {
  SickBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.streaming(); }));
  serial::Bytes damaged = serial::sick::encode_reply(serial::sick::response::scan, serial::Bytes{1, 2, 3, 4});
  damaged[5] ^= 0x10;
  EXPECT_TRUE(bench.run_until([&] {
    for (int i = 0; i < 3; ++i) bench.line->inject(damaged);
    return !bench.connected(Device::laser_front);
  }));
  EXPECT_THAT(bench.state(Device::laser_front), testing::HasSubstr("too noisy"));
}

TEST(SickLink, NothingThereIsSaidOnceInWords) {
  LineBench bench;
  SickLink link(bench.context.get_executor(), {.path = "/nowhere/laser"}, bench.clock(), bench.sink());
  link.start();
  bench.run_for(400ms);
  link.stop();
  bench.run_for(10ms);
  const auto states = bench.all<robot::DeviceState>();
  ASSERT_EQ(states.size(), 1u);
  EXPECT_FALSE(states[0].connected);
  EXPECT_THAT(states[0].reason, testing::HasSubstr("cannot open /nowhere/laser"));
}

TEST(SickLink, AFileIsNoSerialLine) {
  LineBench bench;
  SickLink link(bench.context.get_executor(), {.path = "/dev/null"}, bench.clock(), bench.sink());
  link.start();
  ASSERT_TRUE(bench.run_until([&] { return !bench.events.empty(); }));
  link.stop();
  bench.run_for(10ms);
  EXPECT_THAT(bench.state(Device::laser_front), testing::Not("connected"));
}

TEST(SickLink, ALineHasOneOwner) {
  SickBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.streaming(); }));
  std::string said;
  SickLink second(bench.context.get_executor(), {.path = bench.line->name().string()}, bench.clock(),
                  [&](robot::Event event) {
                    if (const auto* state = std::get_if<robot::DeviceState>(&event)) said = state->reason;
                  });
  second.start();
  ASSERT_TRUE(bench.run_until([&] { return !said.empty(); }));
  second.stop();
  bench.run_for(10ms);
  EXPECT_THAT(said, testing::HasSubstr("in use by another program"));
}

TEST(SickLink, AStoppedLinkSaysNoMore) {
  SickBench bench;
  bench.link->start();
  ASSERT_TRUE(bench.run_until([&] { return bench.streaming(); }));
  bench.link->stop();
  const auto before = bench.events.size();
  bench.run_for(100ms);
  EXPECT_EQ(bench.events.size(), before);
}

}  // namespace
}  // namespace devices
