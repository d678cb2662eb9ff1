#include "server/tools/replay_tool.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "protocols/files/bytes.hpp"
#include "protocols/files/map_server_file.hpp"
#include "protocols/files/problem.hpp"
#include "server/tools/map_tool.hpp"
#include "server/tools/replay_score.hpp"
#include "tests/support/recorded_drive.hpp"
#include "tests/support/temporary_folder.hpp"

namespace tools {
namespace {

using ::testing::HasSubstr;

class ReplayTool : public ::testing::Test {
 protected:
  ReplayTool() {
    const auto written = testing_support::drive();
    options_.log = folder_.write("drive.log", written.log);
    options_.truth = folder_.write("truth.txt", written.truth);
    options_.map = folder_.path() / "map.yaml";
    options_.report = folder_.path() / "report.json";
    files::write_map_server(options_.map, testing_support::room());
  }
  std::string complaint() {
    try {
      run_replay(options_);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }

  testing_support::TemporaryFolder folder_;
  ReplayOptions options_;
};

TEST_F(ReplayTool, TracksFromTheTrueStart) {
  const auto report = run_replay(options_);
  EXPECT_EQ(report["scans"], 300);
  EXPECT_EQ(report["start"], "pose");
  EXPECT_LT(report["translation"]["median_m"], 0.05);
  EXPECT_LT(report["translation"]["max_m"], 0.3);
  EXPECT_LT(report["rotation"]["median_deg"], 1.0);
  EXPECT_LT(report["final_error_m"], 0.2);
  EXPECT_EQ(report["lost_seconds"], 0.0);
  EXPECT_GT(report["scan_ms"]["median"], 0.0);
  EXPECT_EQ(report["converged"]["seconds"], 0.0);
  EXPECT_NEAR(report["path_m"], 299 * 0.2 * 0.4 * 1.03, 0.5);
}

TEST_F(ReplayTool, SameSeedSameTrack) {
  options_.track = folder_.path() / "a.csv";
  run_replay(options_);
  const auto first = files::read_bytes(options_.track, 1 << 20);
  run_replay(options_);
  EXPECT_EQ(files::read_bytes(options_.track, 1 << 20), first);
  EXPECT_EQ(files::read_poses(options_.track).size(), 300u);
}

TEST_F(ReplayTool, TruthOnTheHostsClockIsUnderstood) {
  std::string shifted;
  for (const auto& timed : files::read_poses(options_.truth)) {
    char line[128];
    std::snprintf(line, sizeof line, "%.3f %.6f %.6f %.6f\n", timed.time + 1000.0, timed.pose.x, timed.pose.y,
                  timed.pose.theta);
    shifted += line;
  }
  folder_.write("truth.txt", shifted);
  EXPECT_LT(run_replay(options_)["translation"]["median_m"], 0.05);
}

TEST_F(ReplayTool, WindowsLeaveScansOut) {
  options_.from = {0.0, 40.0};
  options_.to = {20.0, 50.0};
  const auto report = run_replay(options_);
  EXPECT_EQ(report["scans"], 150);
  EXPECT_LT(report["final_error_m"], 0.3) << "odometry goes on between the stretches";
}

TEST_F(ReplayTool, WithoutTruthThereAreNoErrorsToTell) {
  options_.truth.clear();
  options_.start = "1.5,0,0";
  const auto report = run_replay(options_);
  EXPECT_TRUE(report["translation"]["median_m"].is_null());
  EXPECT_TRUE(report["final_error_m"].is_null());
  EXPECT_GT(report["beams"]["map"], 0.9);
}

TEST_F(ReplayTool, BadOptionsSayWhatToMend) {
  options_.start = "here";
  EXPECT_THAT(complaint(), HasSubstr("--start takes global or x,y,degrees"));
  options_.start = "";
  options_.from = {5.0};
  options_.to = {5.0};
  EXPECT_THAT(complaint(), HasSubstr("--from must lie before its --to"));
  options_.from = {5000.0};
  options_.to = {};
  EXPECT_THAT(complaint(), HasSubstr("no scans between --from and --to"));
  options_.map = "nowhere.map";
  EXPECT_THAT(complaint(), HasSubstr("nowhere.map: no such file"));
}

TEST_F(ReplayTool, MapsFromKnownPosesCanBeLocalizedOn) {
  MapOptions options{options_.log, options_.truth, folder_.path() / "made", {}, {}, {30.0}, 0.05, "-"};
  const auto made = make_map(options);
  EXPECT_EQ(made["scans"], 150);
  EXPECT_GT(made["realtime_factor"], 1.0);
  EXPECT_EQ(files::read_poses(options.out / "poses.csv").size(), 150u);
  options_.map = options.out;
  options_.from = {30.0};
  options_.to = {};
  const auto report = run_replay(options_);
  EXPECT_LT(report["translation"]["median_m"], 0.06);
}

ReplayStep step_at(double time, double x, std::optional<double> true_x, bool localized) {
  ReplayStep step;
  step.time = time;
  step.pose.map_from_base = {x, 0.0, 0.0};
  step.pose.localized = localized;
  step.path_m = time;
  if (true_x) step.truth = robot::Pose{*true_x, 0.0, 0.0};
  return step;
}

TEST(ReplayScore, CountsErrorsFromConvergenceOn) {
  ReplayScore score;
  score.add(step_at(0.0, 9.0, 0.0, false));
  score.add(step_at(1.0, 9.0, 1.0, true));  // sure of the wrong place
  score.add(step_at(2.0, 2.1, 2.0, true));
  score.add(step_at(3.0, 3.3, 3.0, true));
  score.add(step_at(5.0, 9.0, 5.0, true));  // lost without knowing
  score.add(step_at(6.0, 6.2, 6.0, true));
  const auto report = score.report();
  EXPECT_EQ(report["scans"], 6);
  EXPECT_EQ(report["converged"]["seconds"], 2.0);
  EXPECT_EQ(report["converged"]["metres"], 2.0);
  EXPECT_NEAR(report["translation"]["max_m"], 4.0, 1e-9);
  EXPECT_NEAR(report["translation"]["median_m"], 0.25, 1e-9);
  EXPECT_EQ(report["lost_seconds"], 2.0);
  EXPECT_EQ(report["lost_unnoticed_seconds"], 2.0);
  EXPECT_NEAR(report["final_error_m"], 0.2, 1e-9);
}

TEST(ReplayScore, NeverConvergedIsSaid) {
  ReplayScore score;
  score.add(step_at(0.0, 9.0, 0.0, false));
  EXPECT_TRUE(score.report()["converged"].is_null());
  EXPECT_TRUE(score.report()["translation"]["median_m"].is_null());
}

TEST(Windows, OpenEndsAndHull) {
  const auto windows = windows_of({10.0, 30.0}, {20.0});
  EXPECT_TRUE(in_any(windows, 10.0));
  EXPECT_FALSE(in_any(windows, 20.0));
  EXPECT_TRUE(in_any(windows, 1e9));
  EXPECT_DOUBLE_EQ(hull_of(windows).from, 10.0);
  EXPECT_TRUE(in_any(windows_of({}, {}), 0.0));
  EXPECT_THROW(windows_of({2.0}, {1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace tools
