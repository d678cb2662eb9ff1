#include "protocols/files/sensor_log.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "protocols/files/problem.hpp"
#include "tests/support/hostile_bytes.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/recorded_data.hpp"

namespace files {
namespace {

using robot::testing::PoseNear;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using testing_support::recorded_data;

const std::string carmen =
    "# a comment\n"
    "PARAM robot_use_laser on nohost 0\n"
    "ODOM 1.0 2.0 0.5 0.3 0.1 0 1000.25 host 0.25\n"
    "FLASER 4 1.5 81.83 2.5 0 1.1 2.0 0.5 1.0 2.0 0.5 1000.5 host 0.5\n"
    "ODOM 1.1 2.0 nan 0.3 0.1 0 1000.75 host 0.75\n"
    "FLASER 5 1.5 2.5 1.1 2.0 0.5 1.0 2.0 0.5 1000.5 host 0.5\n"
    "ROBOTLASER1 0 -1.5 3.0 0.5 40.0 0.01 0 3 1.0 50.0 3.0 2 7 8 2.2 3.0 0 2.0 3.0 0 0.4 0.2 0 0 0 1001.0 host 0.9\n";

const robot::Odometry& odometry(const SensorLog& log, std::size_t i) {
  return std::get<robot::Odometry>(log.entries.at(i));
}
const LoggedScan& scan(const SensorLog& log, std::size_t i) { return std::get<LoggedScan>(log.entries.at(i)); }

TEST(SensorLog, ReadsCarmenLines) {
  const auto log = parse_log(carmen, "a.log");
  ASSERT_THAT(log.entries, SizeIs(5));
  EXPECT_EQ(log.scans, 2u);
  EXPECT_EQ(log.other_lines, 2u);
  EXPECT_NEAR(log.clock_offset, 1000.0, 0.2);
  EXPECT_THAT(odometry(log, 0).odom_from_base, PoseNear(robot::Pose{1.0, 2.0, 0.5}, 1e-9));
  EXPECT_EQ(odometry(log, 0).twist, (robot::Twist{0.3, 0.1}));
  EXPECT_DOUBLE_EQ(robot::to_seconds(odometry(log, 0).time), 0.25);
  const auto& flaser = scan(log, 2);
  EXPECT_DOUBLE_EQ(robot::to_seconds(flaser.scan.time), 0.5);
  EXPECT_DOUBLE_EQ(flaser.scan.angle_min, -robot::pi / 2);
  EXPECT_DOUBLE_EQ(flaser.scan.angle_step, robot::pi / 4);
  EXPECT_NEAR(flaser.base_from_laser.x, 0.1 * std::cos(0.5), 1e-9);
  const auto& robot_laser = scan(log, 4);
  EXPECT_DOUBLE_EQ(robot_laser.scan.angle_min, -1.5);
  EXPECT_DOUBLE_EQ(robot_laser.scan.angle_step, 0.5);
  EXPECT_NEAR(robot_laser.base_from_laser.x, 0.2, 1e-9);
  EXPECT_EQ(odometry(log, 3).twist, (robot::Twist{0.4, 0.2}));
}

TEST(SensorLog, GreatestValuesMeanNothingSeen) {
  const auto log = parse_log(carmen, "a.log");
  const auto& far = scan(log, 2).scan;
  EXPECT_FLOAT_EQ(far.ranges[0], 1.5f);
  EXPECT_TRUE(std::isnan(far.ranges[1]));
  EXPECT_TRUE(std::isnan(far.ranges[3])) << "zero is no distance";
  EXPECT_FLOAT_EQ(far.max_range, 81.83f);
  EXPECT_TRUE(std::isnan(scan(log, 4).scan.ranges[1])) << "beyond the line's own limit";
}

TEST(SensorLog, BadLinesAreCountedAndSayWhy) {
  const auto log = parse_log(carmen, "a.log");
  EXPECT_EQ(log.bad_lines, 2u);
  ASSERT_THAT(log.first_bad, SizeIs(2));
  EXPECT_EQ(log.first_bad[0].line, 5);
  EXPECT_THAT(log.first_bad[0].reason, HasSubstr("ODOM needs six finite numbers"));
  EXPECT_EQ(log.first_bad[1].line, 6);
}

TEST(SensorLog, OddBeamCountsHoldBothEnds) {
  std::string line = "FLASER 181";
  for (int i = 0; i < 181; ++i) line += " 1." + std::to_string(i);
  const auto log = parse_log(line + " 0 0 0 0 0 0 1 h 1\n", "a.log");
  EXPECT_DOUBLE_EQ(scan(log, 1).scan.angle_step, robot::pi / 180);
}

TEST(SensorLog, StampsThatRunBackwardsAreKept) {
  const auto log = parse_log("ODOM 0 0 0 0 0 0 5 h 5\nODOM 1 0 0 0 0 0 4 h 4\n", "a.log");
  ASSERT_THAT(log.entries, SizeIs(2));
  EXPECT_DOUBLE_EQ(robot::to_seconds(odometry(log, 1).time), 4.0);
}

TEST(SensorLog, ReadsWeanLinesInMetres) {
  std::string line = "L 100 200 0 125 200 0";
  for (int i = 0; i < 180; ++i) line += i == 7 ? " 8191" : " 250";
  const auto log = parse_log("O 49 19 -2.8 0.6\n" + line + " 0.9\n", "b.log");
  ASSERT_THAT(log.entries, SizeIs(2)) << "the scan brings its own odometry, the O lines are of other times";
  EXPECT_THAT(odometry(log, 0).odom_from_base, PoseNear(robot::Pose{1.0, 2.0, 0.0}, 1e-9));
  EXPECT_FLOAT_EQ(scan(log, 1).scan.ranges[0], 2.5f);
  EXPECT_TRUE(std::isnan(scan(log, 1).scan.ranges[7]));
  EXPECT_NEAR(scan(log, 1).base_from_laser.x, 0.25, 1e-9);
  const auto wheels = parse_log("O 49 19 -2.8 0.6\n", "b.log");
  EXPECT_THAT(odometry(wheels, 0).odom_from_base, PoseNear(robot::Pose{0.49, 0.19, -2.8}, 1e-9));
}

TEST(SensorLog, NothingReadableIsRefused) {
  EXPECT_THROW(parse_log("", "a.log"), FileError);
  EXPECT_THROW(parse_log("ODOM 1 2\nFLASER 99999 1\n", "a.log"), FileError);
}

RC_GTEST_PROP(SensorLog, DamagedLogsAreReadAsFarAsTheyGo, ()) {
  try {
    const auto log = parse_log(*testing_support::damaged(carmen), "a.log");
    for (const auto& entry : log.entries) {
      if (const auto* odometry = std::get_if<robot::Odometry>(&entry)) {
        RC_ASSERT(robot::is_finite(odometry->odom_from_base));
      } else {
        const auto& logged = std::get<LoggedScan>(entry);
        RC_ASSERT(!logged.scan.ranges.empty() && logged.scan.ranges.size() <= 4096u);
        RC_ASSERT(std::isfinite(logged.scan.angle_step) && robot::is_finite(logged.base_from_laser));
      }
    }
  } catch (const FileError& error) {
    RC_ASSERT(!error.problem().text.empty());
  }
}

// What the catalogue of recordings says of each log.
struct Recorded {
  const char* file;
  std::size_t scans;
  std::size_t beams;
  float max_range;
};

class RecordedLog : public ::testing::TestWithParam<Recorded> {};

TEST_P(RecordedLog, HoldsWhatItsMakersSay) {
  const auto path = recorded_data(GetParam().file);
  NEED_RECORDING(path);
  const auto log = read_log(path);
  EXPECT_EQ(log.scans, GetParam().scans);
  EXPECT_EQ(log.bad_lines, 0u);
  EXPECT_FALSE(log.corrected);
  for (const auto& entry : log.entries) {
    if (const auto* logged = std::get_if<LoggedScan>(&entry)) {
      ASSERT_EQ(logged->scan.ranges.size(), GetParam().beams);
      ASSERT_NEAR(logged->scan.max_range, GetParam().max_range, 0.1);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Logs, RecordedLog,
                         ::testing::Values(Recorded{"intel/intel-dense-rawodom.log.gz", 3461, 180, 81.83f},
                                           Recorded{"freiburg-079/freiburg-079-rawodom.log.gz", 4791, 360, 81.91f},
                                           Recorded{"fhw-museum/fhw-rawodom.log.gz", 488, 180, 51.1f},
                                           Recorded{"freiburg-101/freiburg-101-rawodom.log.gz", 292, 360, 81.91f},
                                           Recorded{"edmonton/edmonton-rawodom.log.gz", 340, 180, 51.15f},
                                           Recorded{"wean/robotdata1.log.gz", 713, 180, 81.91f},
                                           Recorded{"wean/robotdata2.log.gz", 2251, 180, 81.91f},
                                           Recorded{"wean/robotdata3.log.gz", 1241, 180, 81.91f}),
                         [](const auto& named) {
                           std::string name = named.param.file;
                           std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
                           return name;
                         });

TEST(SensorLog, CorrectedLogsAreRecognised) {
  const auto path = recorded_data("fhw-museum/fhw-corrected.log.gz");
  NEED_RECORDING(path);
  EXPECT_TRUE(read_log(path).corrected);
}

}  // namespace
}  // namespace files
