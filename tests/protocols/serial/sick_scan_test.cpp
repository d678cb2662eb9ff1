#include "protocols/serial/sick_scan.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace serial::sick {
namespace {

using robot::LaserId;
using robot::LaserScan;
using testing::ElementsAre;

Bytes payload_of(const Bytes& telegram) { return {telegram.begin() + 4, telegram.end() - 2}; }

Values of(std::vector<std::uint16_t> numbers, Units units = Units::mm) {
  Values values;
  values.units = units;
  values.last = static_cast<unsigned>(numbers.size());
  values.values = std::move(numbers);
  return values;
}

std::vector<std::uint16_t> full(std::uint16_t value) { return std::vector<std::uint16_t>(181, value); }

TEST(SickScan, BeamsGoFromRightToLeft) {
  const auto scan = to_laser_scan(of(full(1000)), {{180, 100}, measuring::range_32m, Units::mm}, LaserId::rear);
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->laser, LaserId::rear);
  EXPECT_NEAR(scan->angle_min, -robot::pi / 2, 1e-12);
  EXPECT_NEAR(scan->angle_min + 180 * scan->angle_step, robot::pi / 2, 1e-12);
  const auto narrow = to_laser_scan(of(std::vector<std::uint16_t>(401, 1000)),
                                    {{100, 25}, measuring::range_32m, Units::mm}, LaserId::front);
  ASSERT_TRUE(narrow);
  EXPECT_NEAR(narrow->angle_min, robot::radians(-50), 1e-12);
}

TEST(SickScan, UnitsComeFromTheTelegramItself) {
  const Geometry geometry{{180, 100}, measuring::range_8m, Units::mm};
  EXPECT_FLOAT_EQ(to_laser_scan(of(full(1500), Units::mm), geometry, LaserId::front)->ranges[7], 1.5f);
  EXPECT_FLOAT_EQ(to_laser_scan(of(full(1500), Units::cm), geometry, LaserId::front)->ranges[7], 15.0f);
  EXPECT_FLOAT_EQ(to_laser_scan(of(full(150), Units::dm), geometry, LaserId::front)->ranges[7], 15.0f);
}

TEST(SickScan, SpecialCodesOfEveryWidthAreNoReturn) {
  struct Mode {
    std::uint8_t mode;
    unsigned top;
  };
  for (const Mode& mode :
       {Mode{0x00, 8191}, {0x01, 8191}, {0x02, 8191}, {0x03, 16383}, {0x04, 16383}, {0x05, 32767}, {0x06, 32767}}) {
    for (const unsigned below : {0u, 1u, 2u, 4u, 5u, 8u}) {
      auto numbers = full(static_cast<std::uint16_t>(mode.top - below));
      const auto scan = to_laser_scan(of(numbers, Units::cm), {{180, 100}, mode.mode, Units::cm}, LaserId::front);
      ASSERT_TRUE(scan);
      EXPECT_TRUE(std::isnan(scan->ranges[0])) << mode.top - below;
    }
  }
}

TEST(SickScan, FlagBitsAreNotRange) {
  auto numbers = full(0xE000 | 1234);
  EXPECT_FLOAT_EQ(to_laser_scan(of(numbers), {{180, 100}, 0x00, Units::mm}, LaserId::front)->ranges[0], 1.234f);
  numbers = full(0x8000 | 12345);
  EXPECT_FLOAT_EQ(to_laser_scan(of(numbers), {{180, 100}, 0x06, Units::mm}, LaserId::front)->ranges[0], 12.345f);
}

TEST(SickScan, MaximumRangesOfTheModes) {
  EXPECT_DOUBLE_EQ(max_range(0x00, Units::mm), 8.0);
  EXPECT_DOUBLE_EQ(max_range(0x03, Units::mm), 16.0);
  EXPECT_DOUBLE_EQ(max_range(0x06, Units::mm), 32.0);
  EXPECT_DOUBLE_EQ(max_range(0x00, Units::cm), 80.0);
  EXPECT_DOUBLE_EQ(max_range(0x06, Units::cm), 80.0);
  EXPECT_DOUBLE_EQ(max_range(0x3F, Units::mm), 0.0);
}

TEST(SickScan, PartialScansBeginBetweenTheDegrees) {
  Values values = of(std::vector<std::uint16_t>(100, 2000));
  values.partial = 3;
  const auto scan = to_laser_scan(values, {{100, 25}, measuring::range_32m, Units::mm}, LaserId::front);
  ASSERT_TRUE(scan);
  EXPECT_NEAR(scan->angle_min, robot::radians(-49.25), 1e-12);
  EXPECT_NEAR(scan->angle_step, robot::radians(1.0), 1e-12);
  EXPECT_EQ(parse_values(payload_of(encode_values(values)))->partial, 3);
}

TEST(SickScan, ASubRangeBeginsAtItsFirstBeam) {
  Values values = of({1000, 1001, 1002});
  values.id = response::sub_range;
  values.first = 91;
  values.last = 93;
  const auto parsed = parse_values(payload_of(encode_values(values)));
  ASSERT_TRUE(parsed);
  const auto scan = to_laser_scan(*parsed, {{180, 100}, measuring::range_32m, Units::mm}, LaserId::front);
  ASSERT_TRUE(scan);
  EXPECT_NEAR(scan->angle_min, 0.0, 1e-12);
  EXPECT_EQ(scan->ranges.size(), 3u);
}

TEST(SickScan, WrongCountsAndModesAreRefused) {
  const Geometry geometry{{180, 100}, measuring::range_32m, Units::mm};
  EXPECT_FALSE(to_laser_scan(of({1, 2, 3}), geometry, LaserId::front));
  EXPECT_FALSE(to_laser_scan(of({}), geometry, LaserId::front));
  EXPECT_FALSE(to_laser_scan(of(full(1)), {{180, 100}, 0x3F, Units::mm}, LaserId::front));
  Values beyond = of({1, 2, 3});
  beyond.id = response::sub_range;
  beyond.first = 180;
  beyond.last = 182;
  EXPECT_FALSE(to_laser_scan(beyond, geometry, LaserId::front));
  beyond.first = 0;
  EXPECT_FALSE(to_laser_scan(beyond, geometry, LaserId::front));
}

TEST(SickScan, InvalidUnitsAndTornCountsAreNoScan) {
  Bytes payload = payload_of(encode_values(of({1, 2, 3})));
  payload[2] |= 0xC0;
  EXPECT_FALSE(parse_values(payload));
  payload = payload_of(encode_values(of({1, 2, 3})));
  payload[1] = 200;
  EXPECT_FALSE(parse_values(payload));
}

TEST(SickScan, RealTimeIndicesBehindTheValuesAreLetBe) {
  const Values values = of({1, 2, 3});
  EXPECT_EQ(parse_values(payload_of(encode_values(values, 0x0707))), values);
}

TEST(SickScan, NothingInSightBecomesBeyondMaximum) {
  LaserScan scan;
  scan.angle_min = -robot::pi / 2;
  scan.angle_step = robot::radians(1.0);
  scan.ranges.assign(181, 2.0f);
  scan.ranges[0] = NAN;
  scan.ranges[1] = INFINITY;
  scan.ranges[2] = 40.0f;
  const Values values = from_laser_scan(scan, {{180, 100}, measuring::range_32m, Units::mm});
  EXPECT_THAT(std::vector(values.values.begin(), values.values.begin() + 4), ElementsAre(32759, 32759, 32759, 2000));
}

RC_GTEST_PROP(SickScan, ScansSurviveTheWireToHalfAMillimetre, ()) {
  const Variant variant =
      *rc::gen::element(Variant{180, 100}, Variant{180, 50}, Variant{100, 100}, Variant{100, 50}, Variant{100, 25});
  const std::uint8_t mode = *rc::gen::element<std::uint8_t>(0x05, 0x06);
  const Geometry geometry{variant, mode, Units::mm};
  LaserScan scan;
  scan.angle_min = robot::radians(-0.5 * variant.angle_deg);
  scan.angle_step = robot::radians(variant.resolution_cdeg / 100.0);
  for (unsigned i = 0; i < variant.values(); ++i) {
    const int mm = *rc::gen::inRange(-1, 32000);
    scan.ranges.push_back(mm < 0 ? NAN : static_cast<float>(mm * 0.001 + 0.0003));
  }
  const auto back = to_laser_scan(*parse_values(payload_of(encode_values(from_laser_scan(scan, geometry)))), geometry,
                                  LaserId::front);
  RC_ASSERT(back.has_value());
  RC_ASSERT(std::abs(back->angle_min - scan.angle_min) < 1e-9);
  RC_ASSERT(back->ranges.size() == scan.ranges.size());
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    RC_ASSERT(std::isnan(scan.ranges[i]) == std::isnan(back->ranges[i]));
    if (!std::isnan(scan.ranges[i])) RC_ASSERT(std::abs(scan.ranges[i] - back->ranges[i]) < 0.00051);
  }
}

RC_GTEST_PROP(SickScan, AnyPayloadIsReadOrRefused, (const std::vector<std::uint8_t>& bytes)) {
  Bytes payload = bytes;
  if (!payload.empty()) payload[0] = *rc::gen::element<std::uint8_t>(0xB0, 0xB6, 0xB7, 0xBF, payload[0]);
  if (const auto values = parse_values(payload)) {
    const auto scan = to_laser_scan(*values, {{180, 100}, measuring::range_32m, Units::mm}, LaserId::front);
    if (scan) RC_ASSERT(scan->ranges.size() == values->values.size());
  }
  parse_reply(payload);
  parse_status(payload);
  parse_config(payload);
  parse_variant_reply(payload);
}

}  // namespace
}  // namespace serial::sick
