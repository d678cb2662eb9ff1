// What each beam met: the map, somebody, or something that cannot be. The distance filter of Fox, Burgard and Thrun
// (JAIR 11, 1999; MINERVA 3.3): people make readings shorter than the map allows, never longer.
#pragma once

#include <span>
#include <vector>

#include "robot/geometry/grid.hpp"
#include "robot/geometry/pose.hpp"
#include "robot/geometry/ray_cast.hpp"
#include "robot/inputs.hpp"
#include "robot/localization/beams.hpp"
#include "robot/localization/likelihood_field.hpp"
#include "robot/outputs.hpp"

namespace robot {

struct BeamReadingConfig {
  double sigma = 0.1;          // m, of a range that met the map
  double surely_short = 0.99;  // beams that are shorter than the map with this probability are somebody's
  double tolerance = 0.2;      // m: what a map may be off before a reading contradicts it
};

// What a scan meant, seen from the pose it was understood at.
struct ScanReading {
  Pose map_from_laser;
  std::vector<BeamKind> kinds;  // one a beam of the scan
  std::vector<float> expected;  // m, one a beam: range to the map's first surface
  int unknown = 0;              // beams among those of kind map that ended where the map is unknown
  bool weighed = false;         // the samples were weighed by this scan
};

// How many of a scan's beams were which.
struct BeamCounts {
  int map = 0;  // without those that ended in unknown space
  int person = 0;
  int far = 0;
  int unknown = 0;
  int none = 0;
  // Impossible ones among those that say something about the place: 0..1.
  double far_share() const { return map + far > 0 ? static_cast<double>(far) / (map + far) : 0.0; }
};
BeamCounts count_beams(const ScanReading& reading);

class BeamReader {
 public:
  // Keeps references: both must outlive the reader.
  BeamReader(const RayCaster& caster, const LikelihoodField& field, BeamReadingConfig config);

  // Reads every beam from one pose that is known to within the given standard deviations (m, rad).
  // Ends in unknown space count as map: they contradict nothing. So do beams that slip past an edge.
  ScanReading read(const LaserScan& scan, const Pose& map_from_laser, double sigma_position, double sigma_theta) const;

  // The distance filter: is the beam shorter than the map allows, with all but certainty over the belief?
  // `belief`: equally weighted base poses; base_from_laser as for the scan.
  bool is_short(const Beam& beam, Point laser, std::span<const Pose> belief) const;

 private:
  bool slips_past(Point from, double angle, double reach, double swing) const;

  const RayCaster& caster_;
  const LikelihoodField& field_;
  BeamReadingConfig config_;
};

}  // namespace robot
