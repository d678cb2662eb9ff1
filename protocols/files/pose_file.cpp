#include "protocols/files/pose_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "protocols/files/bytes.hpp"
#include "protocols/files/fields.hpp"
#include "protocols/files/problem.hpp"

namespace files {
namespace {

constexpr std::size_t max_bytes = 256u << 20;

int count_fields(std::string_view line) {
  Fields fields(line);
  int count = 0;
  while (!fields.word().empty()) ++count;
  return count;
}

bool is_comment(std::string_view line) {
  const auto start = line.find_first_not_of(" \t\r");
  return start == std::string_view::npos || line[start] == '#';
}

// The poses of a corrected log: those of its scans.
PoseTrack poses_of_log(std::string_view text, const std::string& name) {
  const auto log = parse_log(text, name);
  PoseTrack track;
  robot::Pose newest;
  for (const auto& entry : log.entries) {
    if (const auto* odometry = std::get_if<robot::Odometry>(&entry)) {
      newest = odometry->odom_from_base;
    } else {
      track.push_back({robot::to_seconds(std::get<LoggedScan>(entry).scan.time), newest});
    }
  }
  return track;
}

std::optional<TimedPose> parse_pose(std::string_view line, int columns) {
  Fields fields(line);
  TimedPose timed;
  if (columns == 6) {
    const auto record = fields.integer();
    if (!record || *record < 0) return std::nullopt;
    timed.record = *record;
  }
  if (!fields.numbers(timed.time, timed.pose.x, timed.pose.y, timed.pose.theta)) return std::nullopt;
  timed.pose.theta = robot::wrap_angle(timed.pose.theta);
  return timed;
}

PoseTrack poses_of_table(std::string_view text, const std::string& name) {
  PoseTrack track;
  int columns = 0;
  for_each_line(text, [&](int number, std::string_view line) {
    if (is_comment(line) || line.starts_with("time,")) return;
    if (columns == 0) columns = count_fields(line);
    const auto timed = columns == 4 || columns == 6 ? parse_pose(line, columns) : std::nullopt;
    if (!timed) {
      throw FileError({name, number, "is not a pose", "give `index time x y theta flag` or `time x y theta`"});
    }
    track.push_back(*timed);
  });
  return track;
}

}  // namespace

PoseTrack parse_poses(std::string_view text, const std::string& name) {
  const bool is_log = text.find("\nFLASER ") != std::string_view::npos || text.starts_with("FLASER ");
  PoseTrack track = is_log ? poses_of_log(text, name) : poses_of_table(text, name);
  if (track.empty())
    throw FileError({name, 0, "holds no poses", "give `index time x y theta flag` or `time x y theta`"});
  std::stable_sort(track.begin(), track.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  return track;
}

PoseTrack read_poses(const std::filesystem::path& path) {
  return parse_poses(read_bytes(path, max_bytes), path.string());
}

void write_poses(const std::filesystem::path& path, const PoseTrack& track) {
  std::string text = "time,x,y,theta\n";
  char line[128];
  for (const auto& timed : track) {
    const int length = std::snprintf(line, sizeof line, "%.6f,%.6f,%.6f,%.6f\n", timed.time, timed.pose.x, timed.pose.y,
                                     timed.pose.theta);
    text.append(line, static_cast<std::size_t>(length));
  }
  write_bytes(path, text);
}

std::optional<robot::Pose> pose_at(const PoseTrack& track, double time, double max_gap, double tolerance) {
  const auto after = std::lower_bound(track.begin(), track.end(), time,
                                      [](const TimedPose& timed, double t) { return timed.time < t; });
  if (after != track.end() && after->time == time) return after->pose;
  if (after == track.begin() || after == track.end()) {
    if (track.empty()) return std::nullopt;
    const auto& nearest = after == track.end() ? track.back() : track.front();
    return std::abs(nearest.time - time) <= tolerance ? std::optional(nearest.pose) : std::nullopt;
  }
  const auto& a = *(after - 1);
  const auto& b = *after;
  if (b.time - a.time > max_gap) {
    const auto& nearest = time - a.time < b.time - time ? a : b;
    return std::abs(nearest.time - time) <= tolerance ? std::optional(nearest.pose) : std::nullopt;
  }
  const double share = (time - a.time) / (b.time - a.time);
  const double turn = robot::wrap_angle(b.pose.theta - a.pose.theta);
  return robot::Pose{a.pose.x + share * (b.pose.x - a.pose.x), a.pose.y + share * (b.pose.y - a.pose.y),
                     robot::wrap_angle(a.pose.theta + share * turn)};
}

std::vector<std::optional<robot::Pose>> poses_of_scans(const SensorLog& log, const PoseTrack& track) {
  constexpr double same_time = 0.02;  // s: else the records are not this log's
  std::map<int, const TimedPose*> by_record;
  for (const auto& timed : track) {
    if (timed.record >= 0) by_record[timed.record] = &timed;
  }
  std::vector<std::optional<robot::Pose>> poses;
  for (const auto& entry : log.entries) {
    const auto* logged = std::get_if<LoggedScan>(&entry);
    if (!logged) continue;
    const double time = robot::to_seconds(logged->scan.time);
    const auto named = by_record.find(logged->record);
    const bool fits = named != by_record.end() && std::abs(named->second->time - time) < same_time;
    poses.push_back(fits ? std::optional(named->second->pose) : pose_at(track, time));
  }
  return poses;
}

std::vector<Relation> parse_relations(std::string_view text, const std::string& name) {
  std::vector<Relation> relations;
  for_each_line(text, [&](int number, std::string_view line) {
    if (is_comment(line)) return;
    Fields fields(line);
    Relation relation;
    double z = 0, roll = 0, pitch = 0;
    if (!fields.numbers(relation.from_time, relation.to_time, relation.relative.x, relation.relative.y, z, roll, pitch,
                        relation.relative.theta)) {
      throw FileError({name, number, "is not a relation", "give `t1 t2 x y z roll pitch yaw`"});
    }
    relations.push_back(relation);
  });
  if (relations.empty()) throw FileError({name, 0, "holds no relations", "give `t1 t2 x y z roll pitch yaw`"});
  return relations;
}

std::vector<Relation> read_relations(const std::filesystem::path& path) {
  return parse_relations(read_bytes(path, max_bytes), path.string());
}

}  // namespace files
