#include "protocols/files/sensor_log.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "protocols/files/bytes.hpp"
#include "protocols/files/fields.hpp"
#include "protocols/files/problem.hpp"

namespace files {
namespace {

constexpr std::size_t max_log_bytes = 256u << 20;
constexpr int max_beams = 4096;
constexpr std::size_t kept_bad_lines = 20;
constexpr double farthest_stamp = 4e9;     // s; about the year 2096
constexpr double farthest_place = 1e6;     // m
constexpr double wean_laser_ahead = 0.25;  // m from the base's centre

// Reads lines of both formats. CARMEN: http://carmen.sourceforge.net/logger_playback.html
class LogReader {
 public:
  explicit LogReader(SensorLog& log) : log_(log) {}

  void read(int number, std::string_view line) {
    Fields fields(line);
    const auto keyword = fields.word();
    const char* reason = nullptr;
    if (keyword == "ODOM") {
      reason = odom(fields);
      ++record_;
    } else if (keyword == "FLASER") {
      reason = flaser(fields);
    } else if (keyword == "ROBOTLASER1") {
      reason = robot_laser(fields);
    } else if (keyword == "O") {
      reason = wean_odometry(fields);
      if (!reason) wean_odometry_.push_back(log_.entries.size() - 1);
    } else if (keyword == "L") {
      reason = wean_laser(fields);
      wean_scans_ |= !reason;
    } else if (!keyword.empty()) {
      ++log_.other_lines;
      log_.corrected |= keyword == "NEFF";  // GMapping's number of effective particles
    }
    if (!reason) return;
    if (++log_.bad_lines <= kept_bad_lines) log_.first_bad.push_back({number, reason});
  }

  void finish() {
    if (!offsets_.empty()) {
      std::nth_element(offsets_.begin(), offsets_.begin() + static_cast<std::ptrdiff_t>(offsets_.size() / 2),
                       offsets_.end());
      log_.clock_offset = offsets_[offsets_.size() / 2];
    }
    if (wean_scans_) drop_wean_odometry();
    mark_no_returns();
  }

 private:
  // Each returns what is wrong with the line, or nothing.
  const char* odom(Fields& fields) {
    robot::Pose pose;
    robot::Twist twist;
    double acceleration = 0.0;
    if (!fields.numbers(pose.x, pose.y, pose.theta, twist.linear, twist.angular, acceleration)) {
      return "ODOM needs six finite numbers";
    }
    const auto time = stamps(fields);
    if (!time) return "ODOM has no usable time stamps";
    return add(robot::Odometry{*time, pose, twist});
  }

  const char* flaser(Fields& fields) {
    const auto beams = fields.integer();
    if (!beams || *beams < 1 || *beams > max_beams) return "FLASER needs 1 to 4096 beams";
    LoggedScan logged;
    if (!ranges(fields, *beams, 1.0, logged.scan)) return "FLASER holds fewer finite ranges than it says";
    // 180 and 360 beams start at -90 degrees and leave out +90, odd counts hold both ends.
    logged.scan.angle_min = -robot::pi / 2;
    logged.scan.angle_step = robot::pi / (*beams % 2 == 0 ? *beams : std::max(1, *beams - 1));
    robot::Pose laser, base;
    if (!fields.numbers(laser.x, laser.y, laser.theta, base.x, base.y, base.theta)) return "FLASER needs two poses";
    const auto time = stamps(fields);
    if (!time) return "FLASER has no usable time stamps";
    return add(logged, *time, laser, base);
  }

  const char* robot_laser(Fields& fields) {
    double type = 0, start = 0, fov = 0, step = 0, max_range = 0, accuracy = 0, remission_mode = 0;
    if (!fields.numbers(type, start, fov, step, max_range, accuracy, remission_mode)) {
      return "ROBOTLASER1 needs seven finite numbers first";
    }
    const auto beams = fields.integer();
    if (!beams || *beams < 1 || *beams > max_beams) return "ROBOTLASER1 needs 1 to 4096 beams";
    if (!(step > 0.0 && step < 1.0 && std::abs(start) < 10.0)) return "ROBOTLASER1 has unusable angles";
    LoggedScan logged;
    if (!ranges(fields, *beams, 1.0, logged.scan)) return "ROBOTLASER1 holds fewer finite ranges than it says";
    logged.scan.angle_min = start;
    logged.scan.angle_step = step;
    logged.scan.max_range = static_cast<float>(std::max(0.0, max_range));
    const auto remissions = fields.integer();
    if (!remissions || *remissions < 0 || *remissions > max_beams || !fields.skip(*remissions)) {
      return "ROBOTLASER1 holds fewer remissions than it says";
    }
    robot::Pose laser, base;
    double tv = 0, rv = 0, forward = 0, side = 0, turn = 0;
    if (!fields.numbers(laser.x, laser.y, laser.theta, base.x, base.y, base.theta, tv, rv, forward, side, turn)) {
      return "ROBOTLASER1 needs two poses, speeds and safety distances";
    }
    const auto time = stamps(fields);
    if (!time) return "ROBOTLASER1 has no usable time stamps";
    return add(logged, *time, laser, base, {tv, rv});
  }

  // cm and radians; O x y theta t
  const char* wean_odometry(Fields& fields) {
    double x = 0, y = 0, theta = 0, seconds = 0;
    if (!fields.numbers(x, y, theta, seconds) || !usable(seconds)) return "O needs four finite numbers";
    return add(robot::Odometry{robot::from_seconds(seconds), {x / 100, y / 100, theta}, {}});
  }

  // L x y theta xl yl thetal r1..r180 t
  const char* wean_laser(Fields& fields) {
    double x = 0, y = 0, theta = 0, xl = 0, yl = 0, thetal = 0, seconds = 0;
    LoggedScan logged;
    if (!fields.numbers(x, y, theta, xl, yl, thetal) || !ranges(fields, 180, 0.01, logged.scan) ||
        !fields.numbers(seconds) || !usable(seconds)) {
      return "L needs two poses, 180 ranges and a time";
    }
    logged.scan.angle_min = -robot::pi / 2;
    logged.scan.angle_step = robot::pi / 180;
    const robot::Pose base{x / 100, y / 100, theta};
    return add(logged, robot::from_seconds(seconds), base * robot::Pose{wean_laser_ahead, 0, 0}, base);
  }

  static bool usable(double seconds) { return seconds >= 0.0 && seconds <= farthest_stamp; }

  // The line's end: time on the host's clock, the host's name, time on the logger's clock.
  std::optional<robot::Time> stamps(Fields& fields) {
    const auto host_time = fields.number();
    if (fields.word().empty()) return std::nullopt;
    const auto logger_time = fields.number();
    if (!host_time || !logger_time || !usable(*host_time) || !usable(*logger_time)) return std::nullopt;
    offsets_.push_back(*host_time - *logger_time);
    return robot::from_seconds(*logger_time);
  }

  static bool ranges(Fields& fields, int beams, double metres, robot::LaserScan& scan) {
    scan.ranges.reserve(static_cast<std::size_t>(beams));
    for (int i = 0; i < beams; ++i) {
      const auto range = fields.number();
      if (!range) return false;
      scan.ranges.push_back(static_cast<float>(*range * metres));
    }
    return true;
  }

  const char* add(robot::Odometry odometry) {
    const auto& pose = odometry.odom_from_base;
    if (std::abs(pose.x) > farthest_place || std::abs(pose.y) > farthest_place || std::abs(pose.theta) > 1e6) {
      return "the pose is out of this world";
    }
    odometry.odom_from_base.theta = robot::wrap_angle(pose.theta);
    log_.entries.emplace_back(odometry);
    return nullptr;
  }

  const char* add(LoggedScan& logged, robot::Time time, const robot::Pose& laser, const robot::Pose& base,
                  const robot::Twist& twist = {}) {
    const auto base_from_laser = robot::relative(base, laser);
    if (!robot::is_finite(base_from_laser) || robot::norm(base_from_laser.position()) > 5.0) {
      return "the laser is not on the robot";
    }
    if (const char* reason = add(robot::Odometry{time, base, twist})) return reason;
    logged.scan.time = time;
    logged.base_from_laser = base_from_laser;
    logged.record = record_;
    log_.entries.emplace_back(std::move(logged));
    ++log_.scans;
    return nullptr;
  }

  // An L line carries the odometry of its scan's own time, which lies a tenth of a second before that of the O line
  // above it: mixed, the robot would seem to jump back at each scan.
  void drop_wean_odometry() {
    std::vector<LogEntry> kept;
    std::size_t next = 0;
    for (std::size_t i = 0; i < log_.entries.size(); ++i) {
      if (next < wean_odometry_.size() && wean_odometry_[next] == i) {
        ++next;
      } else {
        kept.push_back(std::move(log_.entries[i]));
      }
    }
    log_.entries = std::move(kept);
  }

  // Lasers report "nothing seen" as their greatest values (81.83, 81.87, 81.91, 51.1, 50.0 ...), which one the format
  // does not say: whatever lies within 10 cm of the log's greatest value, or of the line's own limit.
  void mark_no_returns() {
    constexpr float below = 0.1f;
    float greatest = 0.0f;
    for (const auto& entry : log_.entries) {
      if (const auto* logged = std::get_if<LoggedScan>(&entry)) {
        for (const float range : logged->scan.ranges) greatest = std::max(greatest, range);
      }
    }
    for (auto& entry : log_.entries) {
      auto* logged = std::get_if<LoggedScan>(&entry);
      if (!logged) continue;
      auto& scan = logged->scan;
      scan.max_range = scan.max_range > 0.0f ? std::min(scan.max_range, greatest) : greatest;
      for (float& range : scan.ranges) {
        if (!(range > 0.0f) || range >= scan.max_range - below) range = std::numeric_limits<float>::quiet_NaN();
      }
    }
  }

  SensorLog& log_;
  std::vector<double> offsets_;
  int record_ = -1;                         // of the last ODOM line
  std::vector<std::size_t> wean_odometry_;  // entries that are O lines
  bool wean_scans_ = false;
};

}  // namespace

SensorLog parse_log(std::string_view text, const std::string& name) {
  SensorLog log;
  log.name = name;
  LogReader reader(log);
  for_each_line(text, [&](int number, std::string_view line) { reader.read(number, line); });
  reader.finish();
  if (log.entries.empty()) {
    const int line = log.first_bad.empty() ? 0 : log.first_bad.front().line;
    const std::string reason = log.first_bad.empty() ? "" : " (" + log.first_bad.front().reason + ")";
    throw FileError({name, line, "holds no odometry and no scans" + reason,
                     "give a CARMEN log with ODOM, FLASER or ROBOTLASER1, or a Wean log with O and L"});
  }
  return log;
}

SensorLog read_log(const std::filesystem::path& path) {
  return parse_log(read_bytes(path, max_log_bytes), path.string());
}

}  // namespace files
