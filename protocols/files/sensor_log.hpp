// A robot's drive as it was recorded: odometry and laser scans in the order in which they were logged.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "robot/inputs.hpp"

namespace files {

struct LoggedScan {
  robot::LaserScan scan;        // times on the logger's clock
  robot::Pose base_from_laser;  // as the log says
  int record = -1;              // number of the ODOM line that it follows, from 0; -1: it follows none
};

using LogEntry = std::variant<robot::Odometry, LoggedScan>;

struct BadLine {
  int line = 0;
  std::string reason;
};

struct SensorLog {
  std::string name;
  // In the file's order; stamps may run backwards. Each scan follows its odometry. Of a Wean log only that.
  std::vector<LogEntry> entries;
  std::size_t scans = 0;
  double clock_offset = 0.0;       // s: the host's clock minus the logger's, median over the log
  bool corrected = false;          // written by a mapper: its poses are no odometry
  std::size_t other_lines = 0;     // messages that are not read here
  std::size_t bad_lines = 0;       // lines that were dropped, all of them counted,
  std::vector<BadLine> first_bad;  // the first ones with what is wrong
};

// A log in CARMEN's or in the Wean course's format, plain or gzipped, recognised by its content. A bad line is dropped
// and counted. Throws FileError when nothing can be read.
SensorLog read_log(const std::filesystem::path& path);
SensorLog parse_log(std::string_view text, const std::string& name);

}  // namespace files
