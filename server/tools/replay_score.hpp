// Sums up a replay: errors against the truth, times per scan, when it found itself and whether it stayed found.
#pragma once

#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocols/files/pose_file.hpp"
#include "server/tools/replay.hpp"

namespace tools {

class ReplayScore {
 public:
  // How far off is lost.
  static constexpr double lost_metres = 1.0;
  static constexpr double lost_degrees = 30.0;

  void add(const ReplayStep& step);

  // The keys of the replay report: scans, translation, rotation, scan_ms, converged, lost_seconds, final_error_m, and
  // more. Errors count from convergence on: the first scan from which it says that it is localized and, where the truth
  // is known, is no more than lost_metres and lost_degrees off. From then on, time is lost while it is farther off or
  // says that it is lost, and unsure while it does not say that it is localized. Without truth there are no errors to
  // tell.
  nlohmann::json report() const;
  // The estimate at each scan.
  const files::PoseTrack& track() const { return track_; }

 private:
  void add_error(const ReplayStep& step, double elapsed);

  std::size_t scans_ = 0, weighed_ = 0, with_truth_ = 0;
  std::optional<double> first_time_, last_time_;
  std::vector<double> metres_, degrees_, scan_ms_, weighed_ms_, search_ms_, particles_, sigmas_;
  std::optional<double> converged_seconds_, converged_metres_, final_error_;
  double lost_seconds_ = 0.0, lost_unnoticed_seconds_ = 0.0, unsure_seconds_ = 0.0, path_ = 0.0;
  std::size_t beams_map_ = 0, beams_near_ = 0, beams_far_ = 0;
  files::PoseTrack track_;
};

}  // namespace tools
