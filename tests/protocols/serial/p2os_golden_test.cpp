// Every byte-exact example of the Pioneer reference, both ways where there are two.
#include <gmock/gmock.h>

#include "protocols/serial/p2os.hpp"
#include "tests/protocols/serial/hex.hpp"

namespace serial::p2os {
namespace {

Bytes only_body(const std::string& hex) {
  PacketDecoder decoder;
  decoder.feed(from_hex(hex));
  const auto body = decoder.next();
  EXPECT_TRUE(body) << hex;
  Bytes copy;
  if (body) copy.assign(body->begin(), body->end());
  EXPECT_FALSE(decoder.next());
  EXPECT_EQ(decoder.counts().skipped_bytes, 0u);
  return copy;
}

struct Example {
  const char* what;
  Bytes bytes;
  const char* hex;
};

TEST(P2osGolden, Commands) {
  const Example examples[] = {
      {"SYNC0", encode(Command::sync0), "FA FB 03 00 00 00"},
      {"SYNC1", encode(Command::sync1), "FA FB 03 01 00 01"},
      {"SYNC2", encode(Command::sync2), "FA FB 03 02 00 02"},
      {"OPEN 1", encode(Command::open, 1), "FA FB 06 01 3B 01 00 02 3B"},
      {"ENABLE 1", encode(Command::enable, 1), "FA FB 06 04 3B 01 00 05 3B"},
      {"ENABLE 0", encode(Command::enable, 0), "FA FB 06 04 3B 00 00 04 3B"},
      {"VEL 200", encode(Command::vel, 200), "FA FB 06 0B 3B C8 00 D3 3B"},
      {"VEL -200", encode(Command::vel, -200), "FA FB 06 0B 1B C8 00 D3 1B"},
      {"RVEL 30", encode(Command::rvel, 30), "FA FB 06 15 3B 1E 00 33 3B"},
      {"RVEL -30", encode(Command::rvel, -30), "FA FB 06 15 1B 1E 00 33 1B"},
      {"HEAD 90", encode(Command::head, 90), "FA FB 06 0C 3B 5A 00 66 3B"},
      {"VEL2 10 10", encode_vel2(10, 10), "FA FB 06 20 3B 0A 0A 2A 45"},
      {"VEL2 -10 10", encode_vel2(-10, 10), "FA FB 06 20 1B F6 09 16 24"},
      {"VEL2 10 -10", encode_vel2(10, -10), "FA FB 06 20 3B F6 0A 16 45"},
      {"VEL2 -5 -5", encode_vel2(-5, -5), "FA FB 06 20 1B 05 04 25 1F"},
      {"SETV 750", encode(Command::setv, 750), "FA FB 06 06 3B EE 02 F4 3D"},
      {"SETA 300", encode(Command::seta, 300), "FA FB 06 05 3B 2C 01 31 3C"},
      {"SETA -300", encode(Command::seta, -300), "FA FB 06 05 1B 2C 01 31 1C"},
      {"SETRV 100", encode(Command::setrv, 100), "FA FB 06 0A 3B 64 00 6E 3B"},
      {"SONAR 1", encode(Command::sonar, 1), "FA FB 06 1C 3B 01 00 1D 3B"},
      {"STOP", encode(Command::stop), "FA FB 03 1D 00 1D"},
      {"E_STOP", encode(Command::e_stop), "FA FB 03 37 00 37"},
      {"SETO", encode(Command::seto), "FA FB 03 07 00 07"},
      {"CONFIG 1", encode(Command::config, 1), "FA FB 06 12 3B 01 00 13 3B"},
  };
  for (const Example& example : examples) {
    EXPECT_EQ(to_hex(example.bytes), example.hex) << example.what;
    EXPECT_TRUE(parse_command(only_body(example.hex))) << example.what;
  }
}

TEST(P2osGolden, WhatTheBaseReadsOfThem) {
  const auto back = parse_command(only_body("FA FB 06 0B 1B C8 00 D3 1B"));
  ASSERT_TRUE(back);
  EXPECT_TRUE(back->is(Command::vel));
  EXPECT_EQ(back->argument, -200);
  const auto bare = parse_command(only_body("FA FB 03 1D 00 1D"));
  ASSERT_TRUE(bare);
  EXPECT_FALSE(bare->argument);
  const auto wheels = parse_vel2(*parse_command(only_body("FA FB 06 20 3B F6 0A 16 45"))->argument);
  EXPECT_EQ(wheels.left, 10);
  EXPECT_EQ(wheels.right, -10);
}

TEST(P2osGolden, IdentityOfMinnieBot) {
  const char* hex = "FA FB 1D 02 4D 69 6E 6E 69 65 42 6F 74 00 50 69 6F 6E 65 65 72 00 70 33 64 78 2D 73 68 00 0B D9";
  EXPECT_EQ(to_hex(encode_identity({"MinnieBot", "Pioneer", "p3dx-sh"})), hex);
  const auto identity = parse_identity(only_body(hex));
  ASSERT_TRUE(identity);
  EXPECT_EQ(identity->name, "MinnieBot");
  EXPECT_EQ(identity->class_name, "Pioneer");
  EXPECT_EQ(identity->subclass, "p3dx-sh");
}

TEST(P2osGolden, MovingSip) {
  const char* hex =
      "FA FB 21 33 E8 03 FF 7F 00 FC C8 00 B4 00 7E 01 00 00 00 03 00 00 02 00 DC 05 07 88 13 00 00 00 FF 00 47 D8";
  Sip sip;
  sip.moving = true;
  sip.x = 1000;
  sip.y = 32767;
  sip.theta = -1024;
  sip.left = 200;
  sip.right = 180;
  sip.battery_dv = 126;
  sip.left_stall = true;
  sip.flags = 3;
  sip.sonars = {{0, 1500}, {7, 5000}};
  sip.digital_in = 0xFF;
  EXPECT_EQ(to_hex(encode_sip(sip)), hex);
  EXPECT_EQ(parse_sip(only_body(hex)), sip);
}

}  // namespace
}  // namespace serial::p2os
