#include "server/tools/replay_tool.hpp"

#include <memory>
#include <stdexcept>

#include "protocols/files/carmen_map.hpp"
#include "protocols/files/fields.hpp"
#include "protocols/files/problem.hpp"
#include "protocols/files/recording.hpp"
#include "server/tools/replay_score.hpp"
#include "server/tools/report.hpp"

namespace tools {
namespace {

robot::Pose parse_start(const std::string& text) {
  files::Fields fields(text);
  robot::Pose pose;
  double degrees = 0.0;
  if (!fields.numbers(pose.x, pose.y, degrees) || !fields.word().empty()) {
    throw std::invalid_argument("--start takes global or x,y,degrees, such as 3.5,-2,90");
  }
  pose.theta = robot::wrap_angle(robot::radians(degrees));
  return pose;
}

// The truth at the first scan that has one.
std::optional<robot::Pose> first_truth(const ReplaySetup& setup) {
  const auto poses = files::poses_of_scans(setup.log, setup.truth);
  std::size_t number = 0;
  for (const auto& entry : setup.log.entries) {
    const auto* logged = std::get_if<files::LoggedScan>(&entry);
    if (!logged) continue;
    const auto pose = poses[number++];
    if (in_any(setup.windows, robot::to_seconds(logged->scan.time))) return pose;
  }
  return std::nullopt;
}

// Puts the truth on the logger's clock when it was written on the host's.
void align_clock(files::PoseTrack& truth, const files::SensorLog& log) {
  const auto overlaps = [&](double offset) {
    for (const auto& entry : log.entries) {
      const auto* odometry = std::get_if<robot::Odometry>(&entry);
      if (odometry && files::pose_at(truth, robot::to_seconds(odometry->time) + offset)) return true;
    }
    return false;
  };
  if (truth.empty() || overlaps(0.0)) return;
  if (!overlaps(log.clock_offset)) throw std::invalid_argument("--truth covers no time of the log");
  for (auto& timed : truth) timed.time -= log.clock_offset;
}

}  // namespace

ReplaySetup prepare_replay(const ReplayOptions& options) {
  ReplaySetup setup;
  setup.windows = windows_of(options.from, options.to);
  setup.log = files::read_any_log(options.log);
  setup.map = files::read_map(options.map);
  setup.seed = options.seed;
  if (!options.truth.empty()) {
    setup.truth = files::read_poses(options.truth);
    align_clock(setup.truth, setup.log);
  }
  if (options.start.empty()) {
    setup.start = first_truth(setup);
  } else if (options.start != "global") {
    setup.start = parse_start(options.start);
  }
  return setup;
}

nlohmann::json run_replay(const ReplayOptions& options) {
  auto setup = prepare_replay(options);
  const std::string start = setup.start ? "pose" : "global";
  const nlohmann::json log = {{"name", setup.log.name}, {"scans", setup.log.scans}, {"bad_lines", setup.log.bad_lines}};
  const bool corrected = setup.log.corrected;
  Replay replay(std::move(setup));
  ReplayScore score;
  while (replay.next()) score.add(replay.step());
  auto report = score.report();
  if (report["scans"] == 0) throw std::invalid_argument("the log has no scans between --from and --to");
  report["start"] = start;
  report["log"] = log;
  if (corrected) report["warning"] = "the log's poses were corrected by a mapper: they are no odometry";
  if (!options.track.empty()) {
    files::write_poses(options.track, score.track());
  }
  return report;
}

int replay_main(const ReplayOptions& options) {
  write_report(run_replay(options), options.report);
  return 0;
}

CLI::App* add_replay_command(CLI::App& app, std::function<bool(const ReplayOptions&)> instead) {
  auto* command = app.add_subcommand("replay", "Localize over a recorded log");
  auto options = std::make_shared<ReplayOptions>();
  command->add_option("log", options->log, "CARMEN or Wean log, plain or gzipped, or a recording")->required();
  command->add_option("--map", options->map, "map.yaml or its folder, a CARMEN .map or wean.dat")->required();
  command->add_option("--from", options->from, "seconds on the log's clock; may be repeated with --to");
  command->add_option("--to", options->to, "seconds on the log's clock");
  command->add_option("--start", options->start, "global or x,y,degrees; else the truth at the first scan");
  command->add_option("--truth", options->truth, "reference poses in the map's frame");
  command->add_option("--track", options->track, "where the estimated poses go, as time,x,y,theta");
  command->add_option("--report", options->report, "where the JSON report goes; - is standard output");
  command->add_option("--seed", options->seed, "of the robot's dice");
  command->callback([options, instead = std::move(instead)] {
    run_command("replay", [&] { return instead && instead(*options) ? 0 : replay_main(*options); });
  });
  return command;
}

}  // namespace tools
