// The localizer: where the robot is on its map, from odometry and laser scans, among people. It keeps a belief (Monte
// Carlo localization), reads each beam against it, says when it is lost and looks for itself over the whole map when it
// must. Deterministic: the same calls with the same seed give the same answers.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "robot/geometry/grid.hpp"
#include "robot/geometry/pose.hpp"
#include "robot/inputs.hpp"
#include "robot/localization/beam_reading.hpp"
#include "robot/localization/global_search.hpp"
#include "robot/localization/likelihood_field.hpp"
#include "robot/localization/lost.hpp"
#include "robot/localization/monte_carlo.hpp"
#include "robot/localization/motion_model.hpp"
#include "robot/localization/scan_match.hpp"

namespace robot {

struct LocalizerConfig {
  MonteCarloConfig particles;
  MotionNoise motion;
  LikelihoodConfig likelihood;
  BeamReadingConfig reading;
  ScanMatchConfig match;
  GlobalSearchConfig search;
  LostConfig lost;
  int beams = 60;                    // a scan is thinned to this many for weighing
  double update_after_metres = 0.1;  // of way since the samples were last weighed ...
  double update_after_turn = 0.05;   // rad ... or of turning ...
  Seconds update_after_rest{1.0};    // ... or of standing still
  double rest_temper = 0.3;          // what a scan counts at rest: it repeats what the last one said
  double unfiltered_share = 0.1;     // of beams that pass the distance filter untested: evidence against a wrong belief
  int filter_samples = 16;           // of the belief, that the distance filter asks
  double match_share = 0.05;         // of the samples, drawn anew round each accepted scan match
  double doubt_above = 0.1;          // share of impossible beams over the usual: worth a look round the belief
  double doubt_gain = 3.0;           // nats of the beam model that a place found there must be better
  double doubt_share = 0.2;          // of the samples, drawn at a better place found there
  double surface_offset = 0.0;       // m, see LikelihoodField; where tracking starts from ...
  bool learn_surface_offset = true;  // ... when it may be learned while localized
  Seconds search_again{3.0};         // while lost, not yet localized or suspicious
  double suspicious_below = 0.35;    // share of beams that meet the map, for a while: worth a search though localized
  double adopting_margin = 6.0;      // nats a place found must then be better than where the robot is believed to be
  int looks_at_rest = 3;             // that a lost robot which stands still must find the same place in
  double worth_adopting = 0.5;       // share of its beams that a place found must explain to replace a belief
};

struct Estimate {
  Pose map_from_base;                                    // carried on by the odometry since the last scan
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // x, y, theta in the map frame; m and rad
  bool localized = false;  // one place explains what is seen, and it is known well enough to drive
  bool lost = false;       // was localized, and what is seen contradicts the map there
  int particles = 0;
  int modes = 0;  // places with more than 5 % of the belief
  // One standard deviation, m: larger axis.
  double sigma_position() const;
  double sigma_theta() const;  // rad
};

class Localizer {
 public:
  Localizer(const OccupancyGrid& map, LocalizerConfig config, std::uint64_t seed);
  ~Localizer();
  Localizer(Localizer&&) noexcept;
  Localizer& operator=(Localizer&&) noexcept;

  // Standard deviations in m (each axis) and rad. A pose that is not finite is ignored.
  void start_at(const Pose& map_from_base, double sigma_position, double sigma_theta);
  // Nothing is known: the next scan starts a search over the whole map, which work() carries out.
  void start_globally();

  // Dead reckoning since the last call moves the belief. Poses in the odom frame, which is smooth.
  void move(const Pose& odom_from_base, Time time);
  // Weighs a scan that was taken at odom_from_base (the base's odometry at the scan's own time) and reads its beams.
  // Several lasers: a call for each.
  ScanReading update(const LaserScan& scan, const Pose& base_from_laser, const Pose& odom_from_base);
  // A slice of the search over the whole map; a unit is about 0.1 ms of work on a 2020s core. True while there is more.
  bool work(int units);

  Estimate estimate() const;
  // A thinned picture of the belief, equally weighted.
  std::vector<Pose> samples(int at_most) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace robot
