// Scores estimated poses by manually verified relations between pairs of them: Kuemmerle et al. 2009, "On measuring the
// accuracy of SLAM algorithms". Only relative poses are compared, so no common frame is needed.
#pragma once

#include <optional>
#include <vector>

#include "protocols/files/pose_file.hpp"

namespace tools {

struct RelationsScore {
  int matched = 0;  // relations of which both times had a pose
  double translation_mean_m = 0.0;
  double translation_sd_m = 0.0;
  double rotation_mean_deg = 0.0;
  double rotation_sd_deg = 0.0;
};

// The estimated pose at a time: the nearest estimate within 0.1 s, else the nearest one within 10 s carried on by the
// odometry. Both tracks on one clock.
std::optional<robot::Pose> carried_pose(const files::PoseTrack& estimates, const files::PoseTrack& odometry,
                                        double time);

// offset: seconds to add to the tracks' clock to get the relations' clock.
RelationsScore score_relations(const std::vector<files::Relation>& relations, const files::PoseTrack& estimates,
                               const files::PoseTrack& odometry, double offset);

// The offset between the relations' clock and the log's. `likely` ones, such as that between the log's own two clocks,
// are taken when they fit; logs that were re-stamped for publication need a search: the offset at which the estimates'
// own steps agree best with the relations. (Odometry will not do for this: it lags behind the scans by a tenth of a
// second on some robots.) Nothing when no offset makes them agree.
std::optional<double> find_clock_offset(const std::vector<files::Relation>& relations,
                                        const files::PoseTrack& estimates, const std::vector<double>& likely);

}  // namespace tools
