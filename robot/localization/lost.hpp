// Lost or not: a two-state filter over what scans say about the pose. Crowds do not disturb it: people make readings
// shorter, and only readings that are longer than the map allows speak against a place, only those that end where the
// map says speak for it.
#pragma once

#include "robot/localization/beam_reading.hpp"

namespace robot {

struct LostConfig {
  double far_share = 0.35;   // share of impossible beams among map and impossible ones at which a scan says nothing
  double gain = 8.0;         // log-odds a unit of that share
  double most_a_scan = 1.0;  // log-odds
  double lost_above = 3.0;   // log-odds
  double found_below = -1.0;
  double bound = 6.0;  // certainty's limit: what is sure now may be wrong in a minute
  int beams = 30;      // map and impossible beams that make a scan count in full
};

class LostJudge {
 public:
  explicit LostJudge(LostConfig config) : config_(config), log_odds_(config.found_below) {}

  // One scan, read at the pose that is believed.
  void observe(const BeamCounts& counts);
  // Starts anew with the given log-odds of being lost.
  void reset(double log_odds) {
    log_odds_ = log_odds;
    lost_ = false;
  }
  bool lost() const { return lost_; }
  double log_odds() const { return log_odds_; }
  // The scans seen so far speak for the pose.
  bool confirmed() const { return log_odds_ <= config_.found_below; }

 private:
  LostConfig config_;
  double log_odds_;
  bool lost_ = false;
};

}  // namespace robot
