// Localization over a recorded log, scan by scan: what the robot would have believed, and how far off it was.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "protocols/files/pose_file.hpp"
#include "protocols/files/sensor_log.hpp"
#include "robot/geometry/grid.hpp"
#include "robot/localization/localizer.hpp"
#include "robot/outputs.hpp"
#include "server/tools/windows.hpp"

namespace tools {

struct ReplaySetup {
  files::SensorLog log;
  robot::OccupancyGrid map;
  files::PoseTrack truth;            // in the map's frame; empty: nobody knows
  std::optional<robot::Pose> start;  // none: the whole map is searched
  // Scans of these stretches only; odometry from the first one's beginning to the last one's end, so that in a gap the
  // robot drives on blindly.
  std::vector<Window> windows = {Window{}};
  std::uint64_t seed = 1;
  robot::LocalizerConfig localizer;
};

// What one scan changed.
struct ReplayStep {
  double time = 0.0;  // s on the logger's clock
  robot::PoseEstimate pose;
  robot::ScanView scan;
  bool lost = false;       // the localizer says so
  bool weighed = false;    // the belief was weighed by this scan
  double scan_ms = 0.0;    // of processor time: motion since the last scan and the scan itself
  double search_ms = 0.0;  // of the search over the whole map that went on beside it
  double path_m = 0.0;     // of odometry since the start
  std::optional<robot::Pose> truth;
};

class Replay {
 public:
  explicit Replay(ReplaySetup setup);
  ~Replay();
  Replay(Replay&&) noexcept;
  Replay& operator=(Replay&&) noexcept;

  // Goes on to the next scan of the window; false when there is none.
  bool next();
  const ReplayStep& step() const { return step_; }
  // The belief after this scan, thinned.
  robot::Belief belief(int at_most = 200) const;
  const robot::OccupancyGrid& map() const { return setup_.map; }

 private:
  void move(const robot::Odometry& odometry);
  void search_until(double time);
  void take(const files::LoggedScan& logged);

  ReplaySetup setup_;
  std::unique_ptr<robot::Localizer> localizer_;
  Window drive_;                                   // of odometry
  std::vector<std::optional<robot::Pose>> truth_;  // of all scans of the log
  std::size_t scan_ = 0;                           // number of the next scan in the log
  std::size_t at_ = 0;                             // the next entry
  std::optional<robot::Odometry> odometry_;
  std::optional<double> searched_until_;
  double pending_ms_ = 0.0;  // of motion since the last scan
  ReplayStep step_;
};

}  // namespace tools
