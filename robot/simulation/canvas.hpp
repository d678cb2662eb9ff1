// What the painter paints on: pixels with their depths, kept column by column because that is how walls are drawn.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "robot/geometry/pose.hpp"
#include "robot/simulation/color.hpp"

namespace robot::simulation {

struct Canvas {
  Canvas(int w, int h)
      : width(w),
        height(h),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)),
        depths(pixels.size(), 1e9f) {}

  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(x) * static_cast<std::size_t>(height) + static_cast<std::size_t>(y);
  }
  // Paints over what lies deeper.
  void blend(int x, int y, float depth, Color color, float share) {
    const std::size_t i = at(x, y);
    if (depth >= depths[i]) return;
    pixels[i] = share >= 0.995f ? pack(color) : pack(mix(hex(pixels[i]), color, share));
    if (share > 0.5f) depths[i] = depth;
  }

  int width, height;
  std::vector<std::uint32_t> pixels;  // 0x00RRGGBB
  std::vector<float> depths;          // m along the optical axis
};

// A camera with an upright picture plane.
struct Lens {
  Pose pose;
  double eye = 1.2;        // m above the floor
  double focal = 500.0;    // pixels
  double middle = 320.0;   // column of the optical axis
  double horizon = 180.0;  // row

  double row(double depth, double z) const { return horizon + focal * (eye - z) / depth; }
  // Depth (m) and column of a place on the map.
  struct Seen {
    double depth, column;
  };
  Seen see(Point p) const {
    const Point local = inverse(pose) * p;
    return {local.x, middle - focal * local.y / (std::abs(local.x) > 1e-6 ? local.x : 1e-6)};
  }
};

inline constexpr Color haze_color = hex(0xDDDCCB);
// How much of a thing at this depth is lost in the hall's bright air.
inline float haze(double depth) { return static_cast<float>(0.85 * (1.0 - std::exp(-depth / 45.0))); }

}  // namespace robot::simulation
