// Logs that real robots recorded, read, mapped and localized: map and test from other parts of the log, never the same
// scans. The bounds leave room beside what is measured; the full figures are in README.md of this folder.
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

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
                                                  0.8,
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

// The Wean Hall logs come without poses: their reference is tests/bench/register.py's, in `wean/` of this folder.
std::filesystem::path wean_log(int number) {
  return recorded_data("wean/robotdata" + std::to_string(number) + ".log.gz");
}
std::filesystem::path wean_reference(int number) {
  return "tests/replay/wean/robotdata" + std::to_string(number) + ".csv";
}

struct OtherLog {
  int mapped, tested;
};

// In the first log other doors stand open than in the others, people walk along, and the second log drives off what the
// others saw of the corridor.
class WeanHallOnAnotherLogsMap : public ::testing::TestWithParam<OtherLog> {
 protected:
  nlohmann::json run(const std::string& start) const {
    const auto [mapped, tested] = GetParam();
    make_map({wean_log(mapped), wean_reference(mapped), folder_.path(), {}, {}, {}, 0.05, "-"});
    ReplayOptions options;
    options.log = wean_log(tested);
    options.map = folder_.path();
    options.truth = wean_reference(tested);
    options.start = start;
    return run_replay(options);
  }
  const testing_support::TemporaryFolder folder_;
};

TEST_P(WeanHallOnAnotherLogsMap, IsTrackedFromTheStartToTheEnd) {
  NEED_RECORDING(wean_log(1));
  const auto report = run("");
  EXPECT_LT(report["translation"]["median_m"], 0.15);
  EXPECT_LT(report["translation"]["max_m"], 1.5);
  EXPECT_LT(report["rotation"]["median_deg"], 2.0);
  EXPECT_LT(report["final_error_m"], 0.5);
  EXPECT_EQ(report["lost_seconds"], 0.0);
}

INSTANTIATE_TEST_SUITE_P(Log, WeanHallOnAnotherLogsMap,
                         ::testing::Values(OtherLog{1, 2}, OtherLog{1, 3}, OtherLog{2, 1}, OtherLog{2, 3},
                                           OtherLog{3, 1}, OtherLog{3, 2}),
                         [](const auto& named) {
                           return std::to_string(named.param.tested) + "OnTheMapOf" +
                                  std::to_string(named.param.mapped);
                         });

class WeanHallFoundOnAnotherLogsMap : public WeanHallOnAnotherLogsMap {};

TEST_P(WeanHallFoundOnAnotherLogsMap, FromNothing) {
  NEED_RECORDING(wean_log(1));
  const auto report = run("global");
  ASSERT_FALSE(report["converged"].is_null());
  EXPECT_LT(report["converged"]["seconds"], 20.0);
  EXPECT_LT(report["translation"]["median_m"], 0.15);
  EXPECT_LT(report["final_error_m"], 0.5);
}

INSTANTIATE_TEST_SUITE_P(Log, WeanHallFoundOnAnotherLogsMap, ::testing::Values(OtherLog{2, 1}, OtherLog{2, 3}),
                         [](const auto& named) { return std::to_string(named.param.tested); });

// The map that came with the logs is of another time: other doors, other furniture, another width of the corridor.
TEST(WeanHall, IsTrackedOnAnOldMap) {
  NEED_RECORDING(wean_log(1));
  for (int number = 1; number <= 3; ++number) {
    ReplayOptions options;
    options.log = wean_log(number);
    options.map = recorded_data("wean/wean.dat.gz");
    options.truth = wean_reference(number);
    const auto report = run_replay(options);
    EXPECT_LT(report["translation"]["median_m"], 0.4) << "log " << number;
    EXPECT_LT(report["translation"]["max_m"], 2.5) << "log " << number;
    EXPECT_LT(report["rotation"]["median_deg"], 2.0) << "log " << number;
  }
}

}  // namespace
}  // namespace tools
