#include "robot/localization/global_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "robot/localization/scan_match.hpp"

namespace robot {
namespace {

constexpr int block = 32;      // positions scored together: one vector register of bytes
constexpr int best_value = 4;  // of an end point in the coarse map; times coarse_beams it must fit a byte
constexpr int blocks_a_unit = 2000;
constexpr std::size_t states_a_unit = 500;

// How good an end point is whose coarse cell has its nearest surface this far away (m).
std::uint8_t value_of(float distance) {
  if (distance <= 0.10f) return best_value;
  if (distance <= 0.20f) return 3;
  if (distance <= 0.35f) return 2;
  return distance <= 0.55f ? 1 : 0;
}

template <typename T>
std::vector<T> thinned(const std::vector<T>& all, int at_most) {
  if (static_cast<int>(all.size()) <= at_most) return all;
  std::vector<T> some;
  some.reserve(static_cast<std::size_t>(at_most));
  for (int i = 0; i < at_most; ++i)
    some.push_back(all[all.size() * static_cast<std::size_t>(i) / static_cast<std::size_t>(at_most)]);
  return some;
}

// One end point a square of this size: somebody who stands close fills many beams but few squares.
std::vector<Point> spread_out(const std::vector<Point>& ends, double square) {
  std::vector<Point> some;
  std::vector<std::pair<long, long>> taken;
  for (const Point& end : ends) {
    const std::pair<long, long> at{std::lround(end.x / square), std::lround(end.y / square)};
    if (std::find(taken.begin(), taken.end(), at) != taken.end()) continue;
    taken.push_back(at);
    some.push_back(end);
  }
  return some;
}

}  // namespace

Peak judge_place(const RayCaster& caster, const LikelihoodField& field, const Look& look, const Pose& map_from_base) {
  constexpr double sigma = 0.12, hit = 0.6, shorter = 0.35, anything = 0.005;
  const double peak_density = hit / (sigma * std::sqrt(2.0 * pi));
  double sum = 0.0, hits = 0.0;
  int count = 0;
  for (const Beams& laser : look.lasers) {
    const Point from = map_from_base * laser.origin;
    for (const Beam& beam : laser.beams) {
      const Point direction = (map_from_base * beam.direction) - map_from_base.position();
      const double expected = caster.cast(from, direction, beam.range + 5.0);
      const double over = beam.range - expected;
      // A beam that just slips past an edge still ends on a surface.
      const Cell cell = field.distances().cell(map_from_base * beam.end);
      const double off = over > 3.0 * sigma || !field.distances().contains(cell)
                             ? std::abs(over)
                             : std::min<double>(std::abs(over), sigma + field.distances()[cell]);
      const double fit = std::exp(-off * off / (2.0 * sigma * sigma));
      const double short_density = over < 0.0 ? shorter / std::max(expected, 1.0) : 0.0;
      sum += std::log((peak_density * fit + short_density + anything) / peak_density);
      hits += fit;
      ++count;
    }
  }
  if (count == 0) return {map_from_base, 0.0, 0.0};
  return {map_from_base, sum * std::min(1.0, 30.0 / count), hits / count};
}

GlobalSearch::GlobalSearch(const OccupancyGrid& map, const RayCaster& caster, const LikelihoodField& field,
                           GlobalSearchConfig config)
    : config_(config), caster_(caster), field_(field), origin_(map.origin()) {
  const double r = map.resolution();
  const auto cells = [&](double metres) { return static_cast<int>(std::ceil(metres / config_.cell)); };
  width_ = cells(map.width() * r);
  height_ = cells(map.height() * r);
  rim_ = cells(config_.max_range) + 1;
  stride_ = (width_ + block - 1) / block * block + 2 * rim_;
  headings_ = std::max(1, static_cast<int>(std::lround(2.0 * pi / config_.heading)));
  const auto size = static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_ + 2 * rim_);
  values_.assign(size, 0);
  free_.assign(size, 0);
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      const int column = static_cast<int>((x + 0.5) * r / config_.cell),
                row = static_cast<int>((y + 0.5) * r / config_.cell);
      const auto at = static_cast<std::size_t>(row + rim_) * static_cast<std::size_t>(stride_) +
                      static_cast<std::size_t>(column + rim_);
      values_[at] = std::max(values_[at], value_of(field.distances()[{x, y}]));
      if (is_free(map[{x, y}])) free_[at] = 255;
    }
  }
}

void GlobalSearch::start(Look look) {
  look_ = std::move(look);
  beams_.clear();
  std::vector<Point> ends;
  for (auto& laser : look_.lasers) {
    for (const Beam& beam : laser.beams) ends.push_back(beam.end);
    laser.beams = thinned(laser.beams, std::max(1, config_.beams / static_cast<int>(look_.lasers.size())));
    beams_.insert(beams_.end(), laser.beams.begin(), laser.beams.end());
  }
  ends_ = spread_out(ends, 0.5 * config_.cell);
  std::erase_if(ends, [&](Point end) { return norm(end) >= config_.max_range; });
  coarse_ends_ = thinned(spread_out(ends, config_.cell), std::min(config_.coarse_beams, 255 / best_value));
  states_.clear();
  candidates_.clear();
  peaks_.clear();
  next_ = 0;
  picked_ = 0;
  row_ = 0;
  // A place that explains less than a fifth of a look is no place.
  floor_ = static_cast<std::uint8_t>(coarse_ends_.size() * best_value / 5);
  stage_ = coarse_ends_.empty() || width_ == 0 || height_ == 0 ? Stage::idle : Stage::coarse;
  if (stage_ == Stage::coarse) set_heading(0);
}

bool GlobalSearch::step(int units) {
  const int rows_a_unit = std::max(1, blocks_a_unit * block / std::max(block, stride_ - 2 * rim_));
  for (; units > 0 && running(); --units) {
    if (stage_ == Stage::coarse) {
      for (int k = 0; k < rows_a_unit && stage_ == Stage::coarse; ++k) {
        score_row(row_);
        if (++row_ < height_) continue;
        row_ = 0;
        if (heading_ + 1 < headings_) {
          set_heading(heading_ + 1);
        } else {
          trim();
          std::sort(states_.begin(), states_.end(), better);
          stage_ = Stage::picking;
        }
      }
    } else if (stage_ == Stage::picking) {
      pick_candidates();
    } else if (next_ < candidates_.size()) {
      align(candidates_[next_++]);
    } else {
      finish();
    }
  }
  return running();
}

void GlobalSearch::set_heading(int heading) {
  heading_ = heading;
  const double angle = heading * 2.0 * pi / headings_, c = std::cos(angle), s = std::sin(angle);
  offsets_.clear();
  for (const Point& end : coarse_ends_) {
    const auto x = std::lround((c * end.x - s * end.y) / config_.cell),
               y = std::lround((s * end.x + c * end.y) / config_.cell);
    offsets_.push_back(static_cast<std::ptrdiff_t>(y) * stride_ + x);
  }
}

void GlobalSearch::score_row(int row) {
  const auto start = static_cast<std::ptrdiff_t>(row + rim_) * stride_ + rim_;
  for (int column = 0; column < width_; column += block) {
    const std::uint8_t* here = values_.data() + start + column;
    const std::uint8_t* open = free_.data() + start + column;
    bool any = false;
    for (int k = 0; k < block; ++k) any |= open[k] != 0;
    if (!any) continue;
    std::array<std::uint8_t, block> sum{};
    for (const std::ptrdiff_t offset : offsets_) {
      for (int k = 0; k < block; ++k) sum[static_cast<std::size_t>(k)] += here[offset + k];
    }
    std::uint8_t most = 0;
    for (int k = 0; k < block; ++k) {
      auto& score = sum[static_cast<std::size_t>(k)];
      score &= open[k];
      most = std::max(most, score);
    }
    if (most <= floor_) continue;
    for (int k = 0; k < block; ++k) keep(sum[static_cast<std::size_t>(k)], heading_, row, column + k);
  }
}

void GlobalSearch::keep(std::uint8_t score, int heading, int row, int column) {
  if (score <= floor_) return;
  const auto place =
      (static_cast<std::uint32_t>(heading) * static_cast<std::uint32_t>(height_) + static_cast<std::uint32_t>(row)) *
          static_cast<std::uint32_t>(width_) +
      static_cast<std::uint32_t>(column);
  states_.push_back({score, place});
  if (static_cast<int>(states_.size()) >= 4 * config_.kept) trim();
}

// Drops all but the best; whatever scores no better than the worst of them is not even collected from now on.
void GlobalSearch::trim() {
  if (static_cast<int>(states_.size()) <= config_.kept) return;
  const auto last = states_.begin() + config_.kept;
  std::nth_element(states_.begin(), last, states_.end(), better);
  floor_ = std::max(floor_, last->score);
  states_.erase(last, states_.end());
}

Pose GlobalSearch::pose_of(const State& state) const {
  const auto w = static_cast<std::uint32_t>(width_), h = static_cast<std::uint32_t>(height_);
  const auto column = state.place % w, row = state.place / w % h, heading = state.place / w / h;
  return {origin_.x + (column + 0.5) * config_.cell, origin_.y + (row + 0.5) * config_.cell,
          wrap_angle(heading * 2.0 * pi / headings_)};
}

// Goes down the list of coarse states, a slice at a time, and takes each that is far enough from all taken before.
void GlobalSearch::pick_candidates() {
  const std::size_t end = std::min(states_.size(), picked_ + states_a_unit);
  for (; picked_ < end && static_cast<int>(candidates_.size()) < config_.candidates; ++picked_) {
    const Pose pose = pose_of(states_[picked_]);
    const bool fresh = std::none_of(candidates_.begin(), candidates_.end(), [&](const Pose& other) {
      return distance(pose.position(), other.position()) < config_.apart_metres &&
             std::abs(wrap_angle(pose.theta - other.theta)) < config_.apart_radians;
    });
    if (fresh) candidates_.push_back(pose);
  }
  if (picked_ < states_.size() && static_cast<int>(candidates_.size()) < config_.candidates) return;
  states_.clear();
  stage_ = Stage::fine;
}

// The best of a small lattice round the coarse place, then Gauss-Newton, then the beam model.
void GlobalSearch::align(const Pose& start) {
  std::vector<double> x, y, theta;
  for (int i = 0; i < 7 * 7 * 7; ++i) {
    const int column = i % 7 - 3, row = i / 7 % 7 - 3, turn = i / 49 - 3;
    x.push_back(start.x + 0.1 * column);
    y.push_back(start.y + 0.1 * row);
    theta.push_back(start.theta + 0.7 * config_.heading * turn);
  }
  std::vector<float> fit(x.size());
  field_.weigh(x, y, theta, ends_, fit);
  const auto best = static_cast<std::size_t>(std::max_element(fit.begin(), fit.end()) - fit.begin());
  const Pose around{x[best], y[best], wrap_angle(theta[best])};
  const Eigen::Matrix3d spread = Eigen::Vector3d(0.04, 0.04, 0.0012).asDiagonal();
  const Pose aligned = match_scan(field_.distances(), field_.surface_offset(), beams_, around, spread, {}).pose;
  peaks_.push_back(judge_place(caster_, field_, look_, aligned));
}

void GlobalSearch::finish() {
  stage_ = Stage::idle;
  std::stable_sort(peaks_.begin(), peaks_.end(), [](const Peak& a, const Peak& b) { return a.score > b.score; });
  std::vector<Peak> places;
  for (const Peak& peak : peaks_) {
    if (peak.score < peaks_.front().score - config_.margin) break;
    const bool fresh = std::none_of(places.begin(), places.end(), [&](const Peak& other) {
      return distance(peak.pose.position(), other.pose.position()) < config_.apart_metres &&
             std::abs(wrap_angle(peak.pose.theta - other.pose.theta)) < config_.apart_radians;
    });
    if (fresh) places.push_back(peak);
  }
  peaks_ = std::move(places);
}

}  // namespace robot
