// Fine alignment of a scan with the map: Gauss-Newton on the distances of its end points to the map's surfaces, held by
// the belief it starts from. Where the scan says nothing (along a corridor) the belief decides.
#pragma once

#include <Eigen/Core>
#include <span>

#include "robot/geometry/distance_field.hpp"
#include "robot/geometry/pose.hpp"
#include "robot/localization/beams.hpp"
#include "robot/localization/likelihood_field.hpp"

namespace robot {

struct ScanMatchConfig {
  double sigma = 0.06;          // m, of one end point's distance to its surface
  double effective_beams = 45;  // a scan counts like this many independent beams at most
  double outlier = 0.12;        // m: ends farther off than this lose their say (Geman and McClure) ...
  double first_outlier = 0.4;   // m ... in the last rounds; in the first one the net is cast wider
  int rounds = 8;
};

struct ScanMatch {
  Pose pose;  // map_from_base
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double fit = 0.0;       // 0..1: mean say of the beams; 1: all lie on surfaces
  double residual = 0.0;  // m: mean signed distance before the surfaces that is left over
  double beams = 0.0;     // that had a say
};

// distances: to the surfaces' cell centres, finite. surface_offset: m, how far before them a laser sees the surface.
// prior: the belief's mean and covariance (x, y, theta).
ScanMatch match_scan(const DistanceField& distances, double surface_offset, std::span<const Beam> beams,
                     const Pose& prior_mean, const Eigen::Matrix3d& prior_covariance, const ScanMatchConfig& config);

// The pose near `around` that fits the scan best: a lattice of 1 m and 40 degrees to every side, then the fine
// alignment. For a belief that has come off the track, when wheels slipped farther than any noise allows for.
ScanMatch search_nearby(const LikelihoodField& field, std::span<const Beam> beams, const Pose& around,
                        const ScanMatchConfig& config);

}  // namespace robot
