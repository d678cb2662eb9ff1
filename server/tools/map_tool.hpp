// `docent map LOG --poses FILE --out DIR`: an occupancy map from a log's scans at known poses, scored by relations.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "protocols/files/pose_file.hpp"
#include "protocols/files/sensor_log.hpp"
#include "robot/geometry/grid.hpp"
#include "server/tools/windows.hpp"

namespace tools {

struct MapOptions {
  std::filesystem::path log;
  std::filesystem::path poses;
  std::filesystem::path out;
  std::filesystem::path relations;  // empty: not scored
  std::vector<double> from, to;     // s
  double resolution = 0.05;         // m a cell
  std::string report = "-";
};

struct KnownPoseMap {
  robot::OccupancyGrid grid;
  files::PoseTrack poses;  // of the scans that went in
};

// Puts the scans of the windows into a grid at the track's poses; scans without a pose are left out. Throws
// files::FileError when no scan has one.
KnownPoseMap map_from_poses(const files::SensorLog& log, const files::PoseTrack& track,
                            const std::vector<Window>& windows, double resolution);

// Carries the command out and returns its report.
nlohmann::json make_map(const MapOptions& options);

void add_map_command(CLI::App& app);

}  // namespace tools
