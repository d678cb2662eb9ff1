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
#include "robot/localization/localizer_config.hpp"

namespace robot {

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
