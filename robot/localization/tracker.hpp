// The belief while it is tracked: samples that follow the wheels and are weighed by scans, and between them the
// estimate, a scan aligned with the map and held by the belief. Knows nothing of being lost or of searching the whole
// map.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "robot/geometry/grid.hpp"
#include "robot/geometry/ray_cast.hpp"
#include "robot/inputs.hpp"
#include "robot/localization/beam_reading.hpp"
#include "robot/localization/beams.hpp"
#include "robot/localization/localizer_config.hpp"

namespace robot {

// One standard deviation of a covariance over x, y and theta: m (larger axis) and rad.
double position_sigma(const Eigen::Matrix3d& covariance);
double heading_sigma(const Eigen::Matrix3d& covariance);

class Tracker {
 public:
  Tracker(const OccupancyGrid& map, const LocalizerConfig& config, Random random);
  Tracker(const Tracker&) = delete;  // its parts refer to each other

  // The belief anew, at the newest odometry: at places, or anywhere on the map's free cells.
  void start(std::span<const Seed> seeds);
  void start_anywhere();

  // Dead reckoning, odom frame.
  void move(const Pose& odom_from_base);
  // Aligns the estimate with a scan taken at this odometry. False when the scan fits well only where the belief is not.
  bool refine(const LaserScan& scan, const Pose& base_from_laser, const Pose& odom);
  // All that a scan does to the belief. temper: 0..1, how much it counts.
  void take_in(const LaserScan& scan, const Pose& base_from_laser, const Pose& odom, double temper);
  // Whether the place is in no doubt, only the pose: then driving off the map costs little, and estimates teach how far
  // before the cells' centres this map's surfaces lie.
  void set_sure(bool sure) {
    sure_ = sure;
    found_ |= sure;
  }
  // The scan's beams, read at a pose that is known as well as the estimate.
  ScanReading read(const LaserScan& scan, const Pose& map_from_laser) const;
  // Whether clearly more of its beams are longer than the map allows than usual, and than of the last scan taken in.
  bool surprising(const ScanReading& reading) const;

  bool has_odometry() const { return odom_now_.has_value(); }
  Pose odometry() const { return odom_now_.value_or(Pose{}); }
  // The estimate, carried to an odometry.
  Pose pose_at(const Pose& odom) const { return pose_ * relative(pose_odom_, odom); }
  const Eigen::Matrix3d& covariance() const { return covariance_; }  // of the estimate
  const Cluster& best() const { return best_; }                      // heaviest lump of the belief
  int modes() const { return modes_; }                               // lumps with more than 5 % of it
  int particles() const { return static_cast<int>(filter_.particles().size()); }
  std::vector<Pose> samples(int at_most) const;  // at the newest odometry

  const LikelihoodField& field() const { return field_; }
  const RayCaster& caster() const { return caster_; }

 private:
  void forget_motion(const Pose& odom);
  void advance(const Pose& odom);
  void summarize();
  Beams comb(const LaserScan& scan, const Pose& base_from_laser) const;
  std::vector<Point> trusted_ends(const Beams& beams);
  void price_unknown(std::span<const Point> telling, const Pose& mean);
  double trust(const Cluster& before) const;
  void weigh(const Beams& beams, double temper, bool once_more = false);
  bool doubt(const Beams& beams, const ScanReading& reading);
  void learn_offset(const ScanMatch& match);

  LocalizerConfig config_;
  OccupancyGrid map_;
  LikelihoodField field_;
  RayCaster caster_;
  BeamReader reader_;
  Random random_;
  MonteCarlo filter_;

  std::optional<Pose> odom_now_;   // newest odometry
  std::optional<Pose> odom_then_;  // odometry at the samples' time
  MotionStep since_;               // way and turns since then
  int weighed_ = 0;
  Cluster best_;                                                    // at the samples' time
  Eigen::Matrix3d predicted_covariance_ = Eigen::Matrix3d::Zero();  // of its belief before the last scan was weighed
  int modes_ = 0;
  double usual_far_ = 0.05;  // share of impossible beams, slow average
  double last_far_ = 0.05;   // the same of the last scan

  Pose pose_;       // the estimate ...
  Pose pose_odom_;  // ... and the odometry it belongs to
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  double match_fit_ = 0.0;  // of the scan aligned last; 0 when it could not be
  bool sure_ = false;
  bool found_ = false;   // was sure since the belief was last set up
  double offset_ = 0.0;  // m, learned so far
  int offsets_learned_ = 0;
};

}  // namespace robot
