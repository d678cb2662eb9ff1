#include "robot/simulation/surfaces.hpp"

#include <algorithm>
#include <cmath>

namespace robot::simulation {
namespace {

constexpr Color tile_light = hex(0xD3D0BD), tile_dark = hex(0xC9C6B2), grout = hex(0xB9B6A2);
constexpr Color chalk_wall = hex(0xE6E5D9), wainscot = hex(0xA9B9AD), rail = hex(0x6F8A7C), skirting = hex(0x2F4A3F);
constexpr Color iron = hex(0x3E5F52), glass = hex(0xFBF5DC), mullion = hex(0x8BA093), oak = hex(0x9A7B55);
constexpr Color stone = hex(0xA9ACA2);
constexpr Point sun{-0.53, 0.85};

// Position within a repeating pattern, 0 <= result < period.
double within(double value, double period) { return value - period * std::floor(value / period); }

}  // namespace

Color floor_color(const Scene& scene, const SceneCell& ground, Point p, double depth) {
  const Cell cell = scene.cells.cell(p);
  const float light = scene.cells.contains(cell) ? static_cast<float>(scene.cells[cell].light) / 255.0f : 1.0f;
  if (ground.material == Material::steps) {
    const double step = within(p.y, 0.32);
    return light * (step < 0.05 ? hex(0xE8D9A8) : mix(hex(0x59645E), hex(0x7B857D), static_cast<float>(step / 0.32)));
  }
  // Diagonal tiles, fading into their mean where a pixel covers several.
  const double u = (p.x + p.y) * 0.9, v = (p.x - p.y) * 0.9;
  const bool odd = (static_cast<long>(std::floor(u)) + static_cast<long>(std::floor(v))) & 1;
  const float clear = static_cast<float>(1.0 / (1.0 + depth * depth / 90.0));
  const Color mean = 0.5f * (tile_light + tile_dark);
  Color color = mix(mean, odd ? tile_light : tile_dark, clear);
  const double seam = std::min(within(u, 1.0), within(v, 1.0));
  if (seam < 0.025) color = mix(color, grout, 0.8f * clear);
  return light * color;
}

Color top_color(const Scene& scene, const SceneCell& cell, Point p) {
  switch (cell.material) {
    case Material::plinth:
      return 1.06f * stone;
    case Material::plate:
      return within(p.x + p.y, 0.3) < 0.03 ? hex(0x77817B) : hex(0x929C96);
    case Material::exhibit: {
      const Color base = scene.exhibits[cell.exhibit].color;
      return mix(1.12f * base, hex(0xFFFFFF), 0.12f);
    }
    case Material::furniture:
      return 1.15f * oak;
    default:
      return 0.9f * chalk_wall;
  }
}

Color ceiling_color(Point p, double depth) {
  const float clear = static_cast<float>(1.0 / (1.0 + depth * depth / 500.0));
  const double across = within(p.x, 6.0), along = within(p.y, 3.0);
  Color color = hex(0xC6CFC4);
  if (across > 2.2 && across < 4.2) {
    color = along < 0.12 || std::abs(across - 3.2) < 0.05 ? hex(0x9FB2A6) : hex(0xF7F2DC);  // skylight
  } else if (across < 0.22) {
    color = iron;  // girders
  } else if (along < 0.14) {
    color = hex(0x8FA598);
  }
  return mix(hex(0xD3D8CB), color, std::max(0.25f, clear));
}

SidePainter::SidePainter(const Scene& scene, const SceneCell& cell, Point p, double metres)
    : material_(cell.material), metres_(metres), height_(cell.height) {
  const Point normal{0.01 * cell.normal_x, 0.01 * cell.normal_y};
  light_ = static_cast<float>(0.88 + 0.14 * dot(normal, sun));
  along_ = normal.x * p.y - normal.y * p.x;
  switch (material_) {
    case Material::exhibit:
      base_ = scene.exhibits[cell.exhibit].color;
      break;
    case Material::plinth:
      base_ = stone;
      break;
    case Material::plate:
      base_ = hex(0x6D7772);
      break;
    case Material::column:
      base_ = iron;
      break;
    case Material::furniture:
      base_ = oak;
      break;
    default:
      base_ = chalk_wall;
  }
}

Color SidePainter::color(double z) const {
  switch (material_) {
    case Material::wall:
    case Material::outer_wall:
      return light_ * wall(z);
    case Material::exhibit: {
      Color body = base_;
      const double below_top = height_ - z;
      if (below_top < 0.07) body = mix(base_, hex(0xFFF4D8), 0.45f);                     // a bright edge
      if (metres_ < 0.03 && within(along_, 0.6) < 0.03) body = 0.8f * base_;             // panels
      if (std::abs(z - 0.75 * height_) < 0.025) body = mix(base_, hex(0xE9C46A), 0.6f);  // brass line
      return (light_ * static_cast<float>(0.72 + 0.3 * z / height_)) * body;
    }
    case Material::column:
      return (light_ * (z < 0.5 || std::abs(z - 3.6) < 0.1 ? 0.8f : 1.0f)) * base_;
    case Material::furniture:
      return (light_ * (z > height_ - 0.05 ? 1.15f : within(along_, 0.5) < 0.03 ? 0.8f : 0.95f)) * base_;
    default:
      return light_ * base_;
  }
}

Color SidePainter::wall(double z) const {
  if (z < 0.16) return skirting;
  if (z < 1.05) {
    const double panel = within(along_, 1.2);
    const bool line = metres_ < 0.04 && (panel < 0.04 || (z > 0.28 && z < 0.31) || (z > 0.90 && z < 0.93));
    return line ? 0.88f * wainscot : wainscot;
  }
  if (z < 1.12) return rail;
  const auto shade = static_cast<float>(0.97 + 0.03 * std::min(1.0, z / 4.0));
  const Color chalk = shade * chalk_wall;
  if (z > 5.1 && z < 5.22) return rail;
  return material_ == Material::outer_wall ? window(z, chalk) : chalk;
}

// Tall windows with round heads, every four metres.
Color SidePainter::window(double z, Color chalk) const {
  const double off = within(along_, 4.0) - 2.0;  // m from the window's middle
  constexpr double half = 1.05, sill = 1.75, spring = 3.55;
  const double rise = z > spring ? std::hypot(off, z - spring) : std::abs(off);
  if (z < sill - 0.1 || rise > half + 0.14) return chalk;
  if (z < sill || rise > half) return mullion;
  const bool bars = metres_ < 0.06 && (within(off + 0.35, 0.7) < 0.06 || within(z - sill, 0.6) < 0.06 ||
                                       (z > spring - 0.05 && z < spring + 0.05));
  if (bars) return mullion;
  return mix(hex(0xE9EBDC), glass, static_cast<float>(std::clamp((z - sill) / 2.0, 0.0, 1.0)));
}

}  // namespace robot::simulation
