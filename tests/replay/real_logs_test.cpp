// Logs that real robots recorded, read, mapped and localized: map and test from other parts of the log, never the same
// scans. The bounds leave room beside what is measured; the full figures are in README.md of this folder.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "protocols/files/pose_file.hpp"
#include "server/tools/map_tool.hpp"
#include "server/tools/replay_tool.hpp"
#include "tests/support/recorded_data.hpp"
#include "tests/support/temporary_folder.hpp"

namespace tools {
namespace {

using testing_support::recorded_data;

struct Split {
  const char* name;
  const char* log;
  const char* poses;
  std::vector<double> map_from, map_to;
  std::vector<double> test_from, test_to;
  double median_m, worst_m, median_deg;
};

// Turns of `period` seconds: map and test take alternate ones.
Split turns(Split split, double from, double to, double period) {
  for (double t = from; t < to; t += 2 * period) {
    split.map_from.push_back(t);
    split.map_to.push_back(t + period);
    split.test_from.push_back(t + period);
    split.test_to.push_back(t + 2 * period);
  }
  return split;
}

class RealLog : public ::testing::TestWithParam<Split> {};

TEST_P(RealLog, IsTrackedFromTheStartToTheEnd) {
  const auto& split = GetParam();
  const auto log = recorded_data(split.log), poses = recorded_data(split.poses);
  NEED_RECORDING(log);
  const testing_support::TemporaryFolder folder;
  make_map({log, poses, folder.path(), {}, split.map_from, split.map_to, 0.05, "-"});
  ReplayOptions options;
  options.log = log;
  options.map = folder.path();
  options.truth = poses;
  options.from = split.test_from;
  options.to = split.test_to;
  const auto report = run_replay(options);
  EXPECT_LT(report["translation"]["median_m"], split.median_m);
  EXPECT_LT(report["translation"]["max_m"], split.worst_m);
  EXPECT_LT(report["rotation"]["median_deg"], split.median_deg);
  EXPECT_LT(report["final_error_m"], split.worst_m);
  EXPECT_EQ(report["lost_seconds"], 0.0);
}

INSTANTIATE_TEST_SUITE_P(Split, RealLog,
                         ::testing::Values(Split{"IntelSecondLapOnTheFirst",
                                                 "intel/intel-dense-rawodom.log.gz",
                                                 "intel/intel-refposes.txt.gz",
                                                 {},
                                                 {400},
                                                 {400},
                                                 {720},
                                                 0.06,
                                                 0.5,
                                                 2.0},
                                           Split{"IntelLastLap",
                                                 "intel/intel-dense-rawodom.log.gz",
                                                 "intel/intel-refposes.txt.gz",
                                                 {},
                                                 {1880},
                                                 {1880},
                                                 {2270},
                                                 0.08,
                                                 0.6,
                                                 2.0},
                                           Split{"MuseumInAthensSecondHalf",
                                                 "fhw-museum/fhw-rawodom.log.gz",
                                                 "fhw-museum/fhw-refposes.txt.gz",
                                                 {},
                                                 {1090},
                                                 {1090},
                                                 {1900},
                                                 0.10,
                                                 1.0,
                                                 1.5},
                                           turns({"MuseumInAthens",
                                                  "fhw-museum/fhw-rawodom.log.gz",
                                                  "fhw-museum/fhw-refposes.txt.gz",
                                                  {},
                                                  {},
                                                  {},
                                                  {},
                                                  0.08,
                                                  0.8,
                                                  1.0},
                                                 0, 2190, 5),
                                           turns({"Freiburg101",
                                                  "freiburg-101/freiburg-101-rawodom.log.gz",
                                                  "freiburg-101/freiburg-101-refposes.txt.gz",
                                                  {},
                                                  {},
                                                  {},
                                                  {},
                                                  0.06,
                                                  0.5,
                                                  1.0},
                                                 150, 1080, 10)),
                         [](const auto& named) { return std::string(named.param.name); });

// The relations were verified by hand and are the only truth that does not come from another mapper.
TEST(Relations, ReferencePosesScoreAsTheirCatalogueSays) {
  const auto log = recorded_data("intel/intel-dense-rawodom.log.gz");
  NEED_RECORDING(log);
  const testing_support::TemporaryFolder folder;
  MapOptions options{log,
                     recorded_data("intel/intel-refposes.txt.gz"),
                     folder.path(),
                     recorded_data("intel/intel.relations.gz"),
                     {},
                     {},
                     0.1,
                     "-"};
  const auto intel = make_map(options)["relations"];
  EXPECT_EQ(intel["matched"], 2984);
  EXPECT_NEAR(intel["translation_mean_m"], 0.066, 0.015);
  EXPECT_NEAR(intel["rotation_mean_deg"], 2.3, 0.3);
  options.log = recorded_data("freiburg-079/freiburg-079-rawodom.log.gz");
  options.poses = recorded_data("freiburg-079/freiburg-079-refposes.txt.gz");
  options.relations = recorded_data("freiburg-079/fr079.relations.gz");
  const auto freiburg = make_map(options)["relations"];
  EXPECT_EQ(freiburg["matched"], 1685);
  EXPECT_NEAR(freiburg["translation_mean_m"], 0.058, 0.01);
  EXPECT_NEAR(freiburg["clock_offset_s"], 1211.43, 0.06);
}

// Nobody knows where the robot was in Wean Hall, but runs with other dice must come to agree.
class WeanHall : public ::testing::TestWithParam<int> {
 protected:
  ReplayOptions options() const {
    ReplayOptions options;
    options.log = recorded_data("wean/robotdata" + std::to_string(GetParam()) + ".log.gz");
    options.map = recorded_data("wean/wean.dat.gz");
    options.start = "global";
    return options;
  }
  const testing_support::TemporaryFolder folder;
};

TEST_P(WeanHall, TwoGlobalStartsAgree) {
  auto options = this->options();
  NEED_RECORDING(options.log);
  options.track = folder.path() / "first.csv";
  run_replay(options);
  options.seed = 2;
  options.truth = options.track;
  options.track = folder.path() / "second.csv";
  const auto report = run_replay(options);
  ASSERT_FALSE(report["converged"].is_null());
  EXPECT_LT(report["converged"]["seconds"], 20.0);
  EXPECT_LT(report["translation"]["median_m"], 0.2);
  EXPECT_LT(report["translation"]["p95_m"], 2.5);
  EXPECT_LT(report["final_error_m"], 1.0);
}

// The second log drives off the map's rim, and all of them past doors and furniture that the map knows otherwise.
TEST_P(WeanHall, IsTrackedFromAPoseToTheEnd) {
  auto options = this->options();
  NEED_RECORDING(options.log);
  options.track = folder.path() / "first.csv";
  run_replay(options);
  const auto track = files::read_poses(options.track);
  const auto at = std::find_if(track.begin(), track.end(), [](const auto& entry) { return entry.time > 40.0; });
  ASSERT_NE(at, track.end());
  options.start = std::to_string(at->pose.x) + "," + std::to_string(at->pose.y) + "," +
                  std::to_string(robot::degrees(at->pose.theta));
  options.from = {at->time};
  options.seed = 2;
  options.truth = options.track;
  options.track = folder.path() / "second.csv";
  const auto report = run_replay(options);
  EXPECT_LT(report["translation"]["max_m"], 3.0);
  EXPECT_LT(report["final_error_m"], 1.0);
}

INSTANTIATE_TEST_SUITE_P(Log, WeanHall, ::testing::Values(1, 2, 3));

}  // namespace
}  // namespace tools
