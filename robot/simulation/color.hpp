// Colours of the painted pictures: red, green, blue from 0 to 255, mixed as floats, kept as bytes.
#pragma once

#include <algorithm>
#include <cstdint>

namespace robot::simulation {

struct Color {
  float r = 0.0f, g = 0.0f, b = 0.0f;
};

constexpr Color hex(std::uint32_t rgb) {
  return {static_cast<float>(rgb >> 16 & 255), static_cast<float>(rgb >> 8 & 255), static_cast<float>(rgb & 255)};
}
constexpr Color operator*(float s, Color c) { return {s * c.r, s * c.g, s * c.b}; }
constexpr Color operator+(Color a, Color b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
// 0: a, 1: b.
constexpr Color mix(Color a, Color b, float share) { return (1.0f - share) * a + share * b; }

constexpr std::uint32_t pack(Color c) {
  const auto byte = [](float v) { return static_cast<std::uint32_t>(std::min(255.0f, std::max(0.0f, v))); };
  return byte(c.r) << 16 | byte(c.g) << 8 | byte(c.b);
}

}  // namespace robot::simulation
