#include "robot/localization/scan_match.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>

namespace robot {
namespace {

struct Normal {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();
  double say = 0.0;
  double residual = 0.0;
};

// Sums up what each beam asks of the pose. Distances are unsigned; an end counts as behind its surface when the beam
// clearly came to it from the other side.
Normal normal_equations(const DistanceField& distances, double offset, std::span<const Beam> beams, const Pose& pose,
                        double outlier) {
  Normal sum;
  const double c = std::cos(pose.theta), s = std::sin(pose.theta);
  for (const Beam& beam : beams) {
    const Point arm{c * beam.end.x - s * beam.end.y, s * beam.end.x + c * beam.end.y};
    const FieldSample sample = interpolate(distances, {pose.x + arm.x, pose.y + arm.y});
    if (sample.value > 4.0 * outlier) continue;
    const Point direction{c * beam.direction.x - s * beam.direction.y, s * beam.direction.x + c * beam.direction.y};
    const double sign = dot(direction, sample.gradient) > 0.3 ? -1.0 : 1.0;
    const double residual = sign * sample.value - offset;
    const double share = 1.0 + residual * residual / (outlier * outlier);
    const double say = 1.0 / (share * share);
    const Point slope = sign * sample.gradient;
    const Eigen::Vector3d row(slope.x, slope.y, cross(arm, slope));
    sum.information.noalias() += say * row * row.transpose();
    sum.pull.noalias() -= say * residual * row;
    sum.say += say;
    sum.residual += say * residual;
  }
  return sum;
}

}  // namespace

ScanMatch match_scan(const DistanceField& distances, double surface_offset, std::span<const Beam> beams,
                     const Pose& prior_mean, const Eigen::Matrix3d& prior_covariance, const ScanMatchConfig& config) {
  ScanMatch match{prior_mean, prior_covariance, 0.0, 0.0, 0.0};
  if (beams.empty()) return match;
  const Eigen::Matrix3d prior = prior_covariance.inverse();
  const double count = static_cast<double>(beams.size());
  const double each = std::min(1.0, config.effective_beams / count) / (config.sigma * config.sigma);
  for (int round = 0; round < config.rounds; ++round) {
    const double net = std::max(config.outlier, config.first_outlier * std::pow(0.5, round));
    const Normal sum = normal_equations(distances, surface_offset, beams, match.pose, net);
    const Eigen::Vector3d off(match.pose.x - prior_mean.x, match.pose.y - prior_mean.y,
                              wrap_angle(match.pose.theta - prior_mean.theta));
    const Eigen::Matrix3d information = each * sum.information + prior;
    const Eigen::LDLT<Eigen::Matrix3d> solver(information);
    const Eigen::Vector3d step = solver.solve(each * sum.pull - prior * off);
    if (!step.allFinite()) return {prior_mean, prior_covariance, 0.0, 0.0, 0.0};
    match.pose = {match.pose.x + step[0], match.pose.y + step[1], wrap_angle(match.pose.theta + step[2])};
    match.covariance = solver.solve(Eigen::Matrix3d::Identity());
    match.fit = sum.say / count;
    match.beams = sum.say;
    match.residual = sum.say > 0.0 ? sum.residual / sum.say : 0.0;
    const bool settled = std::hypot(step[0], step[1]) < 2e-4 && std::abs(step[2]) < 2e-5;
    if (settled && net <= config.outlier) break;
  }
  return match;
}

ScanMatch search_nearby(const LikelihoodField& field, std::span<const Beam> beams, const Pose& around,
                        const ScanMatchConfig& config) {
  constexpr int reach = 5, turns = 10;  // lattice steps to every side
  constexpr double step = 0.2, turn = radians(4);
  std::vector<double> x, y, theta;
  for (int k = -turns; k <= turns; ++k) {
    for (int j = -reach; j <= reach; ++j) {
      for (int i = -reach; i <= reach; ++i) {
        x.push_back(around.x + step * i);
        y.push_back(around.y + step * j);
        theta.push_back(wrap_angle(around.theta + turn * k));
      }
    }
  }
  std::vector<Point> ends;
  for (std::size_t i = 0; i < beams.size(); i += 2) ends.push_back(beams[i].end);
  std::vector<float> fit(x.size());
  field.weigh(x, y, theta, ends, fit);
  const auto best = static_cast<std::size_t>(std::max_element(fit.begin(), fit.end()) - fit.begin());
  const Eigen::Matrix3d spread = Eigen::Vector3d(step * step, step * step, turn * turn).asDiagonal();
  return match_scan(field.distances(), field.surface_offset(), beams, {x[best], y[best], theta[best]}, spread, config);
}

}  // namespace robot
