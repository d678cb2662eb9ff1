#include "robot/localization/lost.hpp"

#include <algorithm>

namespace robot {

void LostJudge::observe(const BeamCounts& counts) {
  const int telling = counts.map + counts.far;
  if (telling == 0) return;
  const double weight = std::min(1.0, static_cast<double>(telling) / config_.beams);
  const double change =
      std::clamp(config_.gain * (counts.far_share() - config_.far_share), -config_.most_a_scan, config_.most_a_scan);
  log_odds_ = std::clamp(log_odds_ + weight * change, -config_.bound, config_.bound);
  if (log_odds_ >= config_.lost_above) lost_ = true;
  if (log_odds_ <= config_.found_below) lost_ = false;
}

}  // namespace robot
