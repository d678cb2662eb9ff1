#include "robot/mapping/occupancy_mapper.hpp"

#include <algorithm>
#include <cmath>

namespace robot {
namespace {

constexpr double unit = 1000.0;
constexpr int margin = 40;  // cells of room that each growth leaves over, beside a quarter of the size

std::int16_t log_odds(double p) { return static_cast<std::int16_t>(std::lround(unit * std::log(p / (1.0 - p)))); }

template <typename T>
Grid<T> moved_into(const Grid<T>& old, int width, int height, int left, int below) {
  const double r = old.resolution();
  Grid<T> grown(width, height, r, {old.origin().x - left * r, old.origin().y - below * r}, T{});
  for (int y = 0; y < old.height(); ++y) {
    const auto from = old.cells().begin() + static_cast<std::ptrdiff_t>(old.index({0, y}));
    std::copy(from, from + old.width(),
              grown.cells().begin() + static_cast<std::ptrdiff_t>(grown.index({left, y + below})));
  }
  return grown;
}

}  // namespace

OccupancyMapper::OccupancyMapper(OccupancyMapperConfig config) : config_(config) {
  const bool sound = config.hit > 0.5 && config.hit < 1.0 && config.miss > 0.0 && config.miss < 0.5 &&
                     config.least > 0.0 && config.least < 0.5 && config.most > 0.5 && config.most < 1.0 &&
                     config.resolution > 0.0;
  if (!sound) throw std::invalid_argument("occupancy mapper: probabilities must lie between 0, 1/2 and 1");
  hit_ = log_odds(config.hit);
  miss_ = log_odds(config.miss);
  least_ = log_odds(config.least);
  most_ = log_odds(config.most);
}

void OccupancyMapper::insert(const LaserScan& scan, const Pose& map_from_laser) {
  if (!is_finite(map_from_laser)) return;
  const Point from = map_from_laser.position();
  if (scans_ == 0) first_ = from;
  if (!(distance(from, first_) < config_.max_extent)) return;
  struct End {
    Point point;
    bool marked;
  };
  std::vector<End> ends;
  Reach reach{from.x, from.y, from.x, from.y};
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range = scan.ranges[i];
    if (!(range > 0.02) || !(range < 0.995 * scan.max_range)) continue;
    const double angle = map_from_laser.theta + scan.angle_min + static_cast<double>(i) * scan.angle_step;
    const double way = std::min(range, config_.max_range);
    const Point to = from + way * Point{std::cos(angle), std::sin(angle)};
    if (!is_finite(to)) continue;
    ends.push_back({to, range <= config_.max_range});
    reach = {std::min(reach.left, to.x), std::min(reach.bottom, to.y), std::max(reach.right, to.x),
             std::max(reach.top, to.y)};
  }
  make_room(reach);
  ++scans_;
  for (const auto& end : ends) {
    if (end.marked) touch(log_odds_.cell(end.point), hit_);
  }
  for (const auto& end : ends) trace(from, end.point, end.marked);
}

void OccupancyMapper::make_room(const Reach& reach) {
  const double r = config_.resolution, most = config_.max_extent;
  const auto bounded = [&](double v, double center) { return std::clamp(v, center - most, center + most); };
  const double left = bounded(reach.left, first_.x), right = bounded(reach.right, first_.x);
  const double bottom = bounded(reach.bottom, first_.y), top = bounded(reach.top, first_.y);
  if (log_odds_.empty()) {
    const Point origin{std::floor(left / r - margin) * r, std::floor(bottom / r - margin) * r};
    const int width = static_cast<int>((right - origin.x) / r) + margin;
    const int height = static_cast<int>((top - origin.y) / r) + margin;
    log_odds_ = Grid<std::int16_t>(width, height, r, origin, 0);
    stamp_ = Grid<std::int32_t>(width, height, r, origin, 0);
    return;
  }
  const Point o = log_odds_.origin();
  const int spare_x = margin + log_odds_.width() / 4, spare_y = margin + log_odds_.height() / 4;
  const auto lacking = [&](double metres, int spare) {
    return metres > 0.0 ? static_cast<int>(metres / r) + 1 + spare : 0;
  };
  const int more_left = lacking(o.x - left, spare_x), more_below = lacking(o.y - bottom, spare_y);
  const int more_right = lacking(right - (o.x + (log_odds_.width() - 1) * r), spare_x);
  const int more_above = lacking(top - (o.y + (log_odds_.height() - 1) * r), spare_y);
  if (more_left + more_below + more_right + more_above == 0) return;
  const int width = log_odds_.width() + more_left + more_right, height = log_odds_.height() + more_below + more_above;
  log_odds_ = moved_into(log_odds_, width, height, more_left, more_below);
  stamp_ = moved_into(stamp_, width, height, more_left, more_below);
}

void OccupancyMapper::touch(Cell cell, std::int16_t change) {
  if (!log_odds_.contains(cell) || stamp_[cell] == scans_) return;
  stamp_[cell] = scans_;
  auto& value = log_odds_[cell];
  value = static_cast<std::int16_t>(std::clamp(value + change, static_cast<int>(least_), static_cast<int>(most_)));
}

// Every cell that the beam crosses before the one in which it ends (Amanatides and Woo 1987).
void OccupancyMapper::trace(Point from, Point to, bool ends_there) {
  const double r = config_.resolution;
  const Point o = log_odds_.origin();
  const double x0 = (from.x - o.x) / r, y0 = (from.y - o.y) / r, dx = (to.x - from.x) / r, dy = (to.y - from.y) / r;
  Cell cell{static_cast<int>(std::floor(x0)), static_cast<int>(std::floor(y0))};
  const Cell last{static_cast<int>(std::floor(x0 + dx)), static_cast<int>(std::floor(y0 + dy))};
  const int step_x = dx > 0 ? 1 : -1, step_y = dy > 0 ? 1 : -1;
  const double forever = std::numeric_limits<double>::infinity();
  double next_x = dx == 0 ? forever : (cell.x + (step_x > 0) - x0) / dx;
  double next_y = dy == 0 ? forever : (cell.y + (step_y > 0) - y0) / dy;
  const double each_x = dx == 0 ? forever : step_x / dx, each_y = dy == 0 ? forever : step_y / dy;
  int left = std::abs(last.x - cell.x) + std::abs(last.y - cell.y);
  for (; left > 0; --left) {
    touch(cell, miss_);
    if (next_x < next_y) {
      cell.x += step_x;
      next_x += each_x;
    } else {
      cell.y += step_y;
      next_y += each_y;
    }
  }
  if (!ends_there) touch(last, miss_);
}

OccupancyGrid OccupancyMapper::map() const {
  if (log_odds_.empty()) return {};
  OccupancyGrid map(log_odds_.width(), log_odds_.height(), log_odds_.resolution(), log_odds_.origin(), unknown_cell);
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (stamp_.cells()[i] == 0) continue;
    map.cells()[i] = static_cast<std::int8_t>(std::lround(100.0 / (1.0 + std::exp(-log_odds_.cells()[i] / unit))));
  }
  return map;
}

}  // namespace robot
