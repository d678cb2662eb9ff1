#include "server/tools/map_tool.hpp"

#include <chrono>
#include <memory>

#include "protocols/files/map_server_file.hpp"
#include "protocols/files/problem.hpp"
#include "protocols/files/recording.hpp"
#include "robot/mapping/occupancy_mapper.hpp"
#include "server/tools/relations.hpp"
#include "server/tools/report.hpp"

namespace tools {
namespace {

files::PoseTrack odometry_of(const files::SensorLog& log) {
  files::PoseTrack track;
  for (const auto& entry : log.entries) {
    if (const auto* odometry = std::get_if<robot::Odometry>(&entry)) {
      track.push_back({robot::to_seconds(odometry->time), odometry->odom_from_base});
    }
  }
  std::stable_sort(track.begin(), track.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  return track;
}

nlohmann::json relations_report(const std::filesystem::path& path, const files::SensorLog& log,
                                const files::PoseTrack& poses) {
  const auto relations = files::read_relations(path);
  const auto offset = find_clock_offset(relations, poses, {0.0, log.clock_offset});
  if (!offset) {
    throw files::FileError(
        {path.string(), 0, "disagrees with the poses at every clock offset", "give the relations of this log"});
  }
  const auto score = score_relations(relations, poses, odometry_of(log), *offset);
  return {{"matched", score.matched},
          {"given", relations.size()},
          {"clock_offset_s", *offset},
          {"translation_mean_m", score.translation_mean_m},
          {"translation_sd_m", score.translation_sd_m},
          {"rotation_mean_deg", score.rotation_mean_deg},
          {"rotation_sd_deg", score.rotation_sd_deg}};
}

files::PoseTrack within(files::PoseTrack track, const std::vector<Window>& windows) {
  std::erase_if(track, [&](const files::TimedPose& timed) { return !in_any(windows, timed.time); });
  return track;
}

double seconds_covered(const files::PoseTrack& poses, const std::vector<Window>& windows) {
  double covered = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    for (const auto& window : windows) {
      if (window.contains(poses[i - 1].time) && window.contains(poses[i].time)) {
        covered += poses[i].time - poses[i - 1].time;
      }
    }
  }
  return covered;
}

}  // namespace

KnownPoseMap map_from_poses(const files::SensorLog& log, const files::PoseTrack& track,
                            const std::vector<Window>& windows, double resolution) {
  robot::OccupancyMapperConfig config;
  config.resolution = resolution;
  robot::OccupancyMapper mapper(config);
  const auto poses = files::poses_of_scans(log, track);
  KnownPoseMap made;
  std::size_t number = 0;
  for (const auto& entry : log.entries) {
    const auto* logged = std::get_if<files::LoggedScan>(&entry);
    if (!logged) continue;
    const double time = robot::to_seconds(logged->scan.time);
    const auto pose = poses[number++];
    if (!pose || !in_any(windows, time)) continue;
    mapper.insert(logged->scan, *pose * logged->base_from_laser);
    made.poses.push_back({time, *pose});
  }
  if (made.poses.empty()) {
    throw files::FileError({log.name, 0, "no scan of this time has a pose",
                            "give poses on the same clock and a stretch that the log covers"});
  }
  std::stable_sort(made.poses.begin(), made.poses.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  made.grid = mapper.map();
  return made;
}

nlohmann::json make_map(const MapOptions& options) {
  const auto windows = windows_of(options.from, options.to);
  const auto log = files::read_any_log(options.log);
  const auto track = files::read_poses(options.poses);
  const auto begun = std::chrono::steady_clock::now();
  const auto made = map_from_poses(log, track, windows, options.resolution);
  const robot::Seconds took = std::chrono::steady_clock::now() - begun;
  std::filesystem::create_directories(options.out);
  files::write_map_server(options.out / "map.yaml", made.grid);
  files::write_poses(options.out / "poses.csv", made.poses);
  const double covered = seconds_covered(made.poses, windows);
  nlohmann::json report = {
      {"scans", made.poses.size()},
      {"scans_in_log", log.scans},
      {"bad_lines", log.bad_lines},
      {"seconds", took.count()},
      {"log_seconds", covered},
      {"realtime_factor", took.count() > 0.0 ? covered / took.count() : 0.0},
      {"map",
       {{"width", made.grid.width()}, {"height", made.grid.height()}, {"resolution_m", made.grid.resolution()}}}};
  if (!options.relations.empty())
    report["relations"] = relations_report(options.relations, log, within(track, windows));
  return report;
}

void add_map_command(CLI::App& app) {
  auto* command = app.add_subcommand("map", "Make a map from a recorded log");
  auto options = std::make_shared<MapOptions>();
  command->add_option("log", options->log, "CARMEN or Wean log, plain or gzipped, or a recording")->required();
  command->add_option("--poses", options->poses, "reference poses, a corrected log or poses.csv")->required();
  command->add_option("--out", options->out, "folder for map.yaml, map.pgm and poses.csv")->required();
  command->add_option("--from", options->from, "seconds on the log's clock; may be repeated with --to");
  command->add_option("--to", options->to, "seconds on the log's clock");
  command->add_option("--relations", options->relations, "verified relations to score the poses with");
  command->add_option("--resolution", options->resolution, "metres a cell")->check(CLI::Range(0.01, 1.0));
  command->add_option("--report", options->report, "where the JSON report goes; - is standard output");
  command->callback([options] {
    run_command("map", [&] {
      write_report(make_map(*options), options->report);
      return 0;
    });
  });
}

}  // namespace tools
