// An upright rectangle of the scene on the canvas: its pixels visited with their places in metres.
#pragma once

#include <algorithm>
#include <cmath>

#include "robot/simulation/canvas.hpp"

namespace robot::simulation {

struct Sprite {
  // Stands at a place of the map, `toward` metres nearer to the camera than that.
  Sprite(const Lens& lens, Point place, double toward = 0.0)
      : seen(lens.see(place)), eye(lens.eye), horizon(lens.horizon) {
    depth = seen.depth - toward;
    scale = depth > 0.15 ? lens.focal / depth : 0.0;
    lost = haze(depth);
  }

  bool visible() const { return scale > 0.0; }

  // Visits pixels of |a| <= half, low <= z <= high: paint(a, z) gives {colour, coverage}; a in m to the right.
  template <typename Paint>
  void each(Canvas& canvas, double half, double low, double high, Paint&& paint) const {
    if (!visible()) return;
    const double column = seen.column;
    const int left = std::max(0, static_cast<int>(std::floor(column - half * scale)));
    const int right = std::min(canvas.width - 1, static_cast<int>(std::ceil(column + half * scale)));
    const int top = std::max(0, static_cast<int>(std::floor(horizon + (eye - high) * scale)));
    const int bottom = std::min(canvas.height - 1, static_cast<int>(std::ceil(horizon + (eye - low) * scale)));
    const double metres = 1.0 / scale;
    for (int x = left; x <= right; ++x) {
      const double a = (x + 0.5 - column) * metres;
      for (int y = top; y <= bottom; ++y) {
        if (static_cast<float>(depth) >= canvas.depths[canvas.at(x, y)]) continue;
        const double z = eye - (y + 0.5 - horizon) * metres;
        const auto [color, share] = paint(a, z);
        if (share > 0.02f) {
          canvas.blend(x, y, static_cast<float>(depth), mix(color, haze_color, lost), std::min(1.0f, share));
        }
      }
    }
  }

  // How much of a pixel lies within a border that is `inside` metres away (negative: outside).
  float cover(double inside) const { return static_cast<float>(std::clamp(inside * scale + 0.5, 0.0, 1.0)); }

  Lens::Seen seen;
  double eye, horizon, depth = 0.0, scale = 0.0;
  float lost = 0.0f;
};

struct Paint {
  Color color;
  float share = 0.0f;
};

}  // namespace robot::simulation
