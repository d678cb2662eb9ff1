// The likelihood field (Thrun et al., "Probabilistic Robotics", table 6.3): how well a scan's end points lie on the
// map's surfaces. Per beam, relative to a perfect fit,
//   p = (hit(d) + random) / (1 + random),   hit(d) = exp(-d^2 / 2 sigma^2),
// so that no beam can cost more than `worst` = -log(random / (1 + random)): people and changed furniture stay bearable.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "robot/geometry/distance_field.hpp"
#include "robot/geometry/pose.hpp"

namespace robot {

struct LikelihoodConfig {
  double hit_sigma = 0.20;     // m: sensor noise, map's grain and its age together; the scan match is finer
  double random = 0.05;        // weight of "anything" beside a perfect hit
  double unknown_share = 0.5;  // an end in unknown space costs at most this share of the worst: it says little
  double effective_beams =
      15;  // neighbouring beams say the same: a scan counts like this many independent ones at most
};

class LikelihoodField {
 public:
  // surface_offset: how far before the centres of occupied cells the surfaces lie that a laser measures (m): half a
  // cell where a map was drawn from geometry, about nothing where a map was learned from scans.
  LikelihoodField(const OccupancyGrid& map, LikelihoodConfig config, double surface_offset = 0.0);

  // Cheap: only a table of 256 entries is made anew.
  void set_surface_offset(double metres);
  double surface_offset() const { return offset_; }
  // What an end in unknown space costs, nats; no more than configured.
  void set_unknown_cost(double nats);

  // Log-likelihood of a scan at each pose, tempered; `ends` are the end points of its beams in the base frame. Poses
  // outside the map are allowed. out: one a pose.
  void weigh(std::span<const double> x, std::span<const double> y, std::span<const double> theta,
             std::span<const Point> ends, std::span<float> out) const;
  // The same for one pose, without tempering: the textbook.
  double log_likelihood(const Pose& pose, std::span<const Point> ends) const;

  // Whether a beam's end there says anything: not in unknown space away from all surfaces, nor outside.
  bool tells(Point end) const { return level_at(end) != 255; }

  // Distance to the surfaces' cell centres, m; finite everywhere, at most `far`.
  const DistanceField& distances() const { return distances_; }
  static constexpr float far = 2.0f;

 private:
  void fill_costs();
  std::uint8_t level_at(Point point) const;

  LikelihoodConfig config_;
  double offset_ = 0.0;
  double unknown_cost_ = 0.0;
  DistanceField distances_;
  // Distances in steps, in a frame one cell wider than the map on each side; 255: unknown or outside.
  static constexpr int steps = 254;
  int width_ = 0;
  int height_ = 0;
  std::vector<std::uint8_t> levels_;
  std::array<std::uint16_t, 256> cost_{};  // of a level, in units of `cost_unit`
  static constexpr double cost_unit = 1.0 / 1024;
};

}  // namespace robot
