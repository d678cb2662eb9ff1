#include "robot/localization/likelihood_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace robot {
namespace {

constexpr std::size_t lane = 8;  // inner loops of this fixed length become vector instructions

// End points in cells, padded to whole lanes with points that lie outside every map.
struct Ends {
  Ends(std::span<const Point> points, double resolution) {
    const std::size_t padded = (points.size() + lane - 1) / lane * lane;
    x.assign(padded, 1e8f);
    y.assign(padded, 1e8f);
    for (std::size_t i = 0; i < points.size(); ++i) {
      x[i] = static_cast<float>(points[i].x / resolution);
      y[i] = static_cast<float>(points[i].y / resolution);
    }
    padding = padded - points.size();
  }
  std::vector<float> x, y;
  std::size_t padding = 0;
};

}  // namespace

LikelihoodField::LikelihoodField(const OccupancyGrid& map, LikelihoodConfig config, double surface_offset)
    : config_(config), offset_(surface_offset), distances_(distance_field(map)) {
  width_ = map.width() + 2;
  height_ = map.height() + 2;
  levels_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 255);
  for (auto& d : distances_.cells()) d = std::min(d, far);
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      const float d = distances_[{x, y}];
      const bool says_nothing = map[{x, y}] < 0 && d > 2 * static_cast<float>(map.resolution());
      const auto level = says_nothing ? 255 : std::lround(d / far * steps);
      levels_[static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x + 1)] =
          static_cast<std::uint8_t>(level);
    }
  }
  set_unknown_cost(std::numeric_limits<double>::max());
}

void LikelihoodField::set_surface_offset(double metres) {
  offset_ = metres;
  fill_costs();
}

void LikelihoodField::set_unknown_cost(double nats) {
  const double worst = std::log1p(config_.random) - std::log(config_.random);
  unknown_cost_ = std::min(nats, config_.unknown_share * worst);
  fill_costs();
}

void LikelihoodField::fill_costs() {
  const double norm = std::log1p(config_.random);
  for (int level = 0; level <= steps; ++level) {
    const double d = static_cast<double>(far) * level / steps - offset_;
    const double p = std::exp(-d * d / (2.0 * config_.hit_sigma * config_.hit_sigma)) + config_.random;
    cost_[static_cast<std::size_t>(level)] = static_cast<std::uint16_t>(std::lround((norm - std::log(p)) / cost_unit));
  }
  cost_[255] = static_cast<std::uint16_t>(std::lround(unknown_cost_ / cost_unit));
}

void LikelihoodField::weigh(std::span<const double> x, std::span<const double> y, std::span<const double> theta,
                            std::span<const Point> ends, std::span<float> out) const {
  const Ends beams(ends, distances_.resolution());
  const double temper = ends.empty() ? 0.0 : std::min(1.0, config_.effective_beams / static_cast<double>(ends.size()));
  const auto padding = static_cast<std::uint32_t>(beams.padding * cost_[255]);
  const double to_cells = 1.0 / distances_.resolution();
  const int right = width_ - 1, top = height_ - 1;
  for (std::size_t i = 0; i < x.size(); ++i) {
    // One cell more for the frame; the conversion to int truncates, which only matters outside.
    const auto px = static_cast<float>((x[i] - distances_.origin().x) * to_cells + 1.0);
    const auto py = static_cast<float>((y[i] - distances_.origin().y) * to_cells + 1.0);
    const auto c = static_cast<float>(std::cos(theta[i])), s = static_cast<float>(std::sin(theta[i]));
    std::uint32_t cost = 0;
    for (std::size_t b = 0; b < beams.x.size(); b += lane) {
      std::array<std::int32_t, lane> at;
      for (std::size_t k = 0; k < lane; ++k) {
        const float u = px + c * beams.x[b + k] - s * beams.y[b + k];
        const float v = py + s * beams.x[b + k] + c * beams.y[b + k];
        const int column = std::min(std::max(static_cast<int>(u), 0), right);
        const int row = std::min(std::max(static_cast<int>(v), 0), top);
        at[k] = row * width_ + column;
      }
      for (std::size_t k = 0; k < lane; ++k) cost += cost_[levels_[static_cast<std::size_t>(at[k])]];
    }
    out[i] = static_cast<float>(-temper * cost_unit * static_cast<double>(cost - padding));
  }
}

double LikelihoodField::log_likelihood(const Pose& pose, std::span<const Point> ends) const {
  double sum = 0.0;
  for (const Point& end : ends) sum -= cost_unit * cost_[level_at(pose * end)];
  return sum;
}

std::uint8_t LikelihoodField::level_at(Point point) const {
  const Cell cell = distances_.cell(point);
  if (!distances_.contains(cell)) return 255;
  return levels_[static_cast<std::size_t>(cell.y + 1) * static_cast<std::size_t>(width_) +
                 static_cast<std::size_t>(cell.x + 1)];
}

}  // namespace robot
