// Poses over time: reference poses beside logs, tracks that the tools write, and manually verified relations.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocols/files/sensor_log.hpp"
#include "robot/geometry/pose.hpp"

namespace files {

struct TimedPose {
  double time = 0.0;  // s
  robot::Pose pose;
  int record = -1;  // number of the log's odometry record that it belongs to; -1: none is named
};

// Sorted by time.
using PoseTrack = std::vector<TimedPose>;

// Reads `index time x y theta flag` (reference poses), `time x y theta` (ground truth), `time,x,y,theta` (poses.csv) or
// a log that a mapper corrected (FLASER lines); # starts a comment, plain or gzipped. Throws FileError with the line.
PoseTrack read_poses(const std::filesystem::path& path);
PoseTrack parse_poses(std::string_view text, const std::string& name);

// Writes poses.csv: time,x,y,theta with a head line.
void write_poses(const std::filesystem::path& path, const PoseTrack& track);

// The pose at a time: interpolated between neighbours that are at most max_gap seconds apart, else the nearest one
// within `tolerance` seconds, else nothing.
std::optional<robot::Pose> pose_at(const PoseTrack& track, double time, double max_gap = 1.0, double tolerance = 0.05);

// The pose of each scan of a log, in the log's order: that of its odometry record where the track names records, else
// the one at its time. Stamps of a hundredth of a second are shared by several records of some logs.
std::vector<std::optional<robot::Pose>> poses_of_scans(const SensorLog& log, const PoseTrack& track);

// The pose at to_time seen from the pose at from_time (either may come first).
struct Relation {
  double from_time = 0.0;  // s
  double to_time = 0.0;    // s
  robot::Pose relative;
};

// Reads `t1 t2 x y z roll pitch yaw` (Kuemmerle et al. 2009). Throws FileError with the line.
std::vector<Relation> read_relations(const std::filesystem::path& path);
std::vector<Relation> parse_relations(std::string_view text, const std::string& name);

}  // namespace files
