#include "robot/geometry/distance_field.hpp"

#include <algorithm>

namespace robot {
namespace {

constexpr int far_away = 1 << 20;  // cells; its square still fits a float's exponent and an int64

// Per column, the vertical distance in cells to the nearest set cell: one sweep up, one sweep down.
std::vector<int> column_distances(const Mask& mask) {
  const int w = mask.width(), h = mask.height();
  std::vector<int> rows(mask.size());
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      const auto i = mask.index({x, y});
      const int below = y > 0 ? rows[i - static_cast<std::size_t>(w)] : far_away;
      rows[i] = mask.cells()[i] ? 0 : std::min(below + 1, far_away);
    }
  }
  for (int y = h - 2; y >= 0; --y) {
    for (int x = 0; x < w; ++x) {
      const auto i = mask.index({x, y});
      rows[i] = std::min(rows[i], rows[i + static_cast<std::size_t>(w)] + 1);
    }
  }
  return rows;
}

// The lower envelope of the parabolas (x - q)^2 + g[q]^2 over one row.
class Envelope {
 public:
  explicit Envelope(int width) : apex_(static_cast<std::size_t>(width)), start_(static_cast<std::size_t>(width)) {}

  void transform(const int* g, float* out, int width, double resolution) {
    int last = -1;
    for (int q = 0; q < width; ++q) {
      if (g[q] >= far_away) continue;
      int from = 0;
      while (last >= 0) {
        from = first_better(apex_[last], q, g);
        if (from > start_[last]) break;
        --last;
      }
      if (last < 0) from = 0;
      if (from >= width) continue;
      ++last;
      apex_[last] = q;
      start_[last] = from;
    }
    if (last < 0) {
      std::fill(out, out + width, std::numeric_limits<float>::infinity());
      return;
    }
    for (int x = width - 1; x >= 0; --x) {
      while (start_[last] > x) --last;
      const double dx = x - apex_[last], dy = g[apex_[last]];
      out[x] = static_cast<float>(resolution * std::sqrt(dx * dx + dy * dy));
    }
  }

 private:
  // The first x at which parabola q (right of p) is lower than p: exact in integers.
  static int first_better(int p, int q, const int* g) {
    const std::int64_t a = static_cast<std::int64_t>(q) * q + static_cast<std::int64_t>(g[q]) * g[q];
    const std::int64_t b = static_cast<std::int64_t>(p) * p + static_cast<std::int64_t>(g[p]) * g[p];
    const std::int64_t n = a - b, d = 2 * static_cast<std::int64_t>(q - p);
    if (n < 0) return 0;
    return static_cast<int>(std::min<std::int64_t>(n / d + 1, std::numeric_limits<int>::max()));
  }

  std::vector<int> apex_;
  std::vector<int> start_;
};

}  // namespace

Mask surfaces(const OccupancyGrid& map) {
  Mask mask(map.width(), map.height(), map.resolution(), map.origin(), 0);
  const auto seen_from = [&](Cell c) {
    const auto value = map.at_or(c, unknown_cell);
    return value >= 0 && !is_occupied(value);
  };
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      if (!is_occupied(map[{x, y}])) continue;
      bool seen = false;
      for (int dy = -1; dy <= 1 && !seen; ++dy) {
        for (int dx = -1; dx <= 1 && !seen; ++dx) seen = seen_from({x + dx, y + dy});
      }
      mask[{x, y}] = seen ? 1 : 0;
    }
  }
  return mask;
}

DistanceField distance_to(const Mask& mask) {
  DistanceField field(mask.width(), mask.height(), mask.resolution(), mask.origin());
  const std::vector<int> columns = column_distances(mask);
  Envelope envelope(mask.width());
  for (int y = 0; y < mask.height(); ++y) {
    const auto row = mask.index({0, y});
    envelope.transform(columns.data() + row, field.cells().data() + row, mask.width(), mask.resolution());
  }
  return field;
}

FieldSample interpolate(const DistanceField& field, Point point) {
  const double r = field.resolution();
  const double u = (point.x - field.origin().x) / r - 0.5, v = (point.y - field.origin().y) / r - 0.5;
  const double cu = std::clamp(u, 0.0, field.width() - 1.0), cv = std::clamp(v, 0.0, field.height() - 1.0);
  const int x = std::min(static_cast<int>(cu), std::max(field.width() - 2, 0));
  const int y = std::min(static_cast<int>(cv), std::max(field.height() - 2, 0));
  const int x1 = std::min(x + 1, field.width() - 1), y1 = std::min(y + 1, field.height() - 1);
  const double a = cu - x, b = cv - y;
  const double f00 = field[{x, y}], f10 = field[{x1, y}], f01 = field[{x, y1}], f11 = field[{x1, y1}];
  const double low = f00 + a * (f10 - f00), high = f01 + a * (f11 - f01);
  const FieldSample sample{low + b * (high - low), {((f10 - f00) * (1 - b) + (f11 - f01) * b) / r, (high - low) / r}};
  const double beyond = std::hypot(u - cu, v - cv);
  if (beyond == 0.0) return sample;
  return {sample.value + beyond * r, {(u - cu) / beyond, (v - cv) / beyond}};
}

}  // namespace robot
