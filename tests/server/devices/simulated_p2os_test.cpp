// The base's side of the wire, told the time: no terminal, no sleeping.
#include "server/devices/simulated_p2os.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/protocols/serial/hex.hpp"

namespace devices {
namespace {

namespace p2os = serial::p2os;
using p2os::Command;
using p2os::encode;
using serial::Bytes;
using serial::to_hex;

// A base on ideal ground.
struct Base {
  explicit Base(SimulatedP2osConfig body = {}) {
    body.drive = [this](robot::Twist next) { twist = next; };
    body.enable_motors = [this](bool on) { state.motors_enabled = on; };
    body.odometry = [this] { return robot::Odometry{{}, pose, twist}; };
    body.state = [this] { return state; };
    body.sonars = [] { return robot::SonarScan{{}, {{0, 1.0f}, {8, 2.0f}}}; };
    device = std::make_unique<SimulatedP2os>(body, now);
  }
  std::string say(const Bytes& packet) {
    device->receive(packet, now);
    return to_hex(device->take_output());
  }
  void open() {
    for (const auto step : {Command::sync0, Command::sync1, Command::sync2, Command::open}) say(encode(step));
    say(encode(Command::enable, 1));
  }
  void pass(Duration duration, bool alive = true) {
    const Instant end = now + duration;
    Instant pulse = now;
    while (now < end) {
      const Instant next = std::min(device->due(), end);
      pose = pose * robot::arc(twist, std::chrono::duration<double>(next - now).count());
      now = next;
      if (alive && now - pulse > 400ms) {
        device->receive(encode(Command::pulse), now);
        pulse = now;
      }
      device->advance(now);
      decoder.feed(device->take_output());
      while (const auto body = decoder.next()) {
        if (const auto sip = p2os::parse_sip(*body)) sips.push_back(*sip);
        if (const auto found = p2os::parse_encoders(*body)) encoders.push_back(*found);
        if (const auto found = p2os::parse_config(*body)) config = *found;
      }
    }
  }

  Instant now{};
  robot::Pose pose;
  robot::Twist twist;
  robot::BaseState state{.time = {}, .battery_volts = 12.6};
  p2os::PacketDecoder decoder;
  std::vector<p2os::Sip> sips;
  std::vector<p2os::Encoders> encoders;
  std::optional<p2os::ConfigPacket> config;
  std::unique_ptr<SimulatedP2os> device;
};

TEST(SimulatedP2os, ShakesHandsByteForByte) {
  Base base({.identity = {"MinnieBot", "Pioneer", "p3dx-sh"}});
  EXPECT_EQ(base.say(serial::from_hex("57 4D 53 32 0D FA FB 03 00 00 00")), "FA FB 03 00 00 00");
  EXPECT_EQ(base.say(encode(Command::sync1)), "FA FB 03 01 00 01");
  EXPECT_EQ(base.say(encode(Command::sync2)),
            "FA FB 1D 02 4D 69 6E 6E 69 65 42 6F 74 00 50 69 6F 6E 65 65 72 00 70 33 64 78 2D 73 68 00 0B D9");
  EXPECT_FALSE(base.device->open());
  EXPECT_EQ(base.say(encode(Command::open, 1)), "");
  EXPECT_TRUE(base.device->open());
}

TEST(SimulatedP2os, OutOfStepIsAnError) {
  Base base;
  base.say(encode(Command::sync0));
  EXPECT_EQ(base.say(encode(Command::sync2)), "FA FB 03 FF 00 FF");
  EXPECT_EQ(base.say(encode(Command::sync0)), "FA FB 03 00 00 00");
}

TEST(SimulatedP2os, MotorsAreOffUntilEnabled) {
  Base base;
  base.state.motors_enabled = true;
  for (const auto step : {Command::sync0, Command::sync1, Command::sync2, Command::open}) base.say(encode(step));
  EXPECT_FALSE(base.state.motors_enabled);
  base.say(encode(Command::vel, 300));
  base.pass(2s);
  EXPECT_EQ(base.pose, robot::Pose{});
  ASSERT_FALSE(base.sips.empty());
  EXPECT_FALSE(base.sips.back().flags & p2os::flag_motors);
}

TEST(SimulatedP2os, TwentyPacketsASecondWithItsOdometry) {
  Base base({.baud = 115200});
  base.open();
  base.say(encode(Command::vel, 500));
  base.say(encode(Command::seta, 5000));
  base.pass(4s);
  EXPECT_NEAR(static_cast<double>(base.sips.size()), 80, 2);
  EXPECT_TRUE(base.sips.back().moving);
  EXPECT_NEAR(base.sips.back().x, 1000.0 * base.pose.x, 60);
  EXPECT_EQ(base.sips.back().left, 500);
  EXPECT_THAT(base.sips.back().sonars, testing::ElementsAre(p2os::SonarCount{0, 1000}, p2os::SonarCount{8, 2000}));
}

TEST(SimulatedP2os, ASlowLineDropsWholePackets) {
  Base base;
  base.open();
  base.pass(4s);
  // Some 45 bytes take 47 ms at 9600 baud: they just fit, with ten sonars more they would not.
  EXPECT_GT(base.sips.size(), 30u);
  EXPECT_EQ(base.decoder.counts().bad_checksums, 0u);
}

TEST(SimulatedP2os, OdometryWrapsAt32768Millimetres) {
  Base base({.baud = 115200});
  base.open();
  base.say(encode(Command::setv, 2000));
  base.say(encode(Command::vel, 2000));
  p2os::OdometryTracker tracker(p2os::model_of("peoplebot-sh"));
  base.pass(60s);
  robot::Odometry last;
  int wraps = 0;
  for (std::size_t i = 0; i < base.sips.size(); ++i) {
    if (i > 0 && base.sips[i].x < base.sips[i - 1].x) ++wraps;
    last = tracker.update(base.sips[i]);
  }
  EXPECT_GE(wraps, 3);
  EXPECT_NEAR(last.odom_from_base.x, base.pose.x, 0.2);
}

TEST(SimulatedP2os, RampsFollowTheSettings) {
  Base base({.baud = 115200});
  base.open();
  base.say(encode(Command::seta, 500));
  base.say(encode(Command::seta, -1000));
  base.say(encode(Command::vel, 1000));
  base.pass(1s);
  EXPECT_NEAR(base.twist.linear, 0.5, 0.011);
  base.pass(2s);
  EXPECT_NEAR(base.twist.linear, 1.0, 1e-9);
  base.say(encode(Command::stop));
  base.pass(500ms);
  EXPECT_NEAR(base.twist.linear, 0.5, 0.011);
  base.say(encode(Command::e_stop));
  EXPECT_EQ(base.twist, robot::Twist{});
}

TEST(SimulatedP2os, WheelsOfTheirOwn) {
  Base base({.baud = 115200});
  base.open();
  base.say(p2os::encode_vel2(-10, 10));
  base.pass(3s);
  EXPECT_NEAR(base.twist.linear, 0.0, 1e-9);
  EXPECT_NEAR(base.twist.angular, 200.0 * 0.006, 1e-9);
  EXPECT_EQ(base.sips.back().left, -200);
  EXPECT_EQ(base.sips.back().right, 200);
}

TEST(SimulatedP2os, WaysAndHeadingsAreReached) {
  Base base({.baud = 115200});
  base.open();
  base.say(encode(Command::head, 90));
  base.pass(5s);
  EXPECT_NEAR(robot::degrees(base.pose.theta), 90.0, 1.0);
  base.say(encode(Command::move, 1500));
  base.pass(10s);
  EXPECT_NEAR(base.pose.y, 1.5, 0.02);
  base.say(encode(Command::dhead, -45));
  base.pass(5s);
  EXPECT_NEAR(robot::degrees(base.pose.theta), 45.0, 1.0);
}

TEST(SimulatedP2os, AfterTwoSecondsOfSilenceItStopsAndRevivesWithTheNextWord) {
  Base base({.baud = 115200});
  base.open();
  base.say(encode(Command::vel, 300));
  base.pass(5s);
  EXPECT_NEAR(base.twist.linear, 0.3, 1e-9);
  base.pass(3500ms, false);
  EXPECT_EQ(base.twist.linear, 0.0);
  base.say(encode(Command::pulse));
  base.pass(1500ms, true);
  EXPECT_NEAR(base.twist.linear, 0.3, 1e-9);
}

TEST(SimulatedP2os, CloseStopsItAndRestoresTheRate) {
  Base base;
  base.open();
  base.say(encode(Command::hostbaud, 4));
  EXPECT_EQ(base.device->baud(), 115200);
  base.say(encode(Command::vel, 300));
  base.pass(1s);
  base.say(encode(Command::close));
  EXPECT_FALSE(base.device->open());
  EXPECT_EQ(base.device->baud(), 9600);
  EXPECT_EQ(base.twist, robot::Twist{});
  EXPECT_EQ(base.device->due(), Instant::max());
}

TEST(SimulatedP2os, TellsItsConfigurationAndEncoders) {
  Base base({.baud = 115200});
  base.open();
  base.say(encode(Command::seta, 5000));
  base.say(encode(Command::encoder, 2));
  base.device->receive(encode(Command::config, 1), base.now);
  base.say(encode(Command::vel, 100));
  base.pass(3s);
  EXPECT_GT(base.encoders.size(), 50u);
  EXPECT_NEAR(base.encoders.back().left, base.pose.x * 1000 * 128, 2000);
  EXPECT_FALSE(base.config);  // it went out with the commands above
  base.device->receive(encode(Command::config, 1), base.now);
  base.pass(1ms);
  ASSERT_TRUE(base.config);
  EXPECT_EQ(base.config->sip_cycle_ms, 50u);
  EXPECT_EQ(base.config->watchdog_ms, 2000u);
  EXPECT_EQ(base.config->translation_acceleration_mm, 5000u);
  EXPECT_EQ(base.config->reset_baud, 2u);
}

TEST(SimulatedP2os, SmallCommands) {
  Base base({.baud = 115200});
  base.open();
  base.say(encode(Command::sonar, 0));
  base.say(encode(Command::digout, 0x0F05));
  base.say(encode(Command::adsel, 3));
  base.say(encode(Command::battest, 110));
  base.pass(200ms);
  EXPECT_TRUE(base.sips.back().sonars.empty());
  EXPECT_EQ(base.sips.back().digital_out, 0x05);
  EXPECT_EQ(base.sips.back().analog_port, 3);
  EXPECT_EQ(base.sips.back().battery_dv, 110);
  base.say(encode(Command::sonar, 1));
  base.say(encode(Command::polling, std::string("\x09")));
  base.pass(200ms);
  EXPECT_THAT(base.sips.back().sonars, testing::ElementsAre(p2os::SonarCount{8, 2000}));
  base.pose = {1.0, 2.0, 0.5};
  base.say(encode(Command::seto));
  base.pass(200ms);
  EXPECT_EQ(base.sips.back().x, 0);
  EXPECT_EQ(base.sips.back().theta, 0);
}

}  // namespace
}  // namespace devices
