#include "server/tools/simulate_tool.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "protocols/files/recording.hpp"
#include "protocols/files/site_file.hpp"

namespace tools {
namespace {

using ::testing::Ge;
using ::testing::Gt;

nlohmann::json few_minutes(double minutes, std::uint64_t seed) {
  SimulateOptions options;
  options.hours = minutes / 60.0;
  options.visitors = 20;
  options.seed = seed;
  options.requests_per_hour = 120.0;
  return simulate(files::load_site("static/sites/rhine-hall"), options);
}

// What does not depend on how fast this machine is.
nlohmann::json without_clock(nlohmann::json report) {
  for (const char* key : {"realtime_factor", "realtime_factor_of_processor", "wall_s", "cpu_s"}) report.erase(key);
  return report;
}

TEST(SimulateTool, ReportsADeployment) {
  const nlohmann::json report = few_minutes(4.0, 3);
  EXPECT_NEAR(report.at("hours").get<double>(), 4.0 / 60.0, 1e-6);
  EXPECT_THAT(report.at("distance_m").get<double>(), Gt(5.0));
  EXPECT_THAT(report.at("speed_max_mps").get<double>(), Gt(0.2));
  EXPECT_LT(report.at("speed_max_mps").get<double>(), 0.75);
  EXPECT_LT(report.at("speed_mean_mps").get<double>(), report.at("speed_max_mps").get<double>());
  EXPECT_THAT(report.at("requests").get<int>(), Gt(0));
  for (const char* key : {"fulfilled", "success_rate", "tours", "exhibits", "realtime_factor"}) {
    EXPECT_TRUE(report.contains(key)) << key;
  }
  for (const char* key : {"static", "hazard", "person_robot_fault", "person_own_fault"}) {
    EXPECT_THAT(report.at("contacts").at(key).get<int>(), Ge(0)) << key;
  }
  EXPECT_EQ(report.at("contacts").at("static"), 0) << report.at("contact_list").dump(2);
  EXPECT_EQ(report.at("contacts").at("hazard"), 0) << report.at("contact_list").dump(2);
  EXPECT_LT(report.at("localization").at("median_m").get<double>(), 0.1);
  EXPECT_EQ(report.at("localization").at("lost_unnoticed"), 0);
}

TEST(SimulateTool, SameSeedSameDay) {
  EXPECT_EQ(without_clock(few_minutes(1.0, 5)), without_clock(few_minutes(1.0, 5)));
}

TEST(SimulateTool, RecordsWhatTheRobotHeardAndSaid) {
  const auto file = std::filesystem::temp_directory_path() / "docent_simulate_test.mcap";
  SimulateOptions options;
  options.hours = 10.0 / 3600.0;
  options.visitors = 5;
  options.record = file;
  simulate(files::load_site("static/sites/rhine-hall"), options);
  const files::Recording recording = files::read_recording(file);
  std::filesystem::remove(file);
  EXPECT_EQ(recording.info.site, "rhine-hall");
  int ticks = 0, commands = 0;
  for (const auto& entry : recording.entries) {
    const auto* input = std::get_if<robot::Input>(&entry);
    ticks += input && std::holds_alternative<robot::Tick>(input->event);
    const auto* said = std::get_if<files::RecordedOutput>(&entry);
    commands += said && std::holds_alternative<robot::WheelCommand>(said->output);
  }
  EXPECT_EQ(ticks, 200);
  EXPECT_GE(commands, 200);
}

}  // namespace
}  // namespace tools
