// What stands on the exhibits, and their number plates.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "robot/simulation/figures.hpp"
#include "robot/simulation/sprite.hpp"

namespace robot::simulation {
namespace {

constexpr Color iron_red = hex(0xB0483A), brass = hex(0xD1A24A), dark_iron = hex(0x33423C), wood = hex(0xC9A36A);

// Digits of 3 x 5 squares, rows from the top, three bits each.
constexpr std::array<std::uint16_t, 10> digits{
    0b111101101101111, 0b010110010010111, 0b111001111100111, 0b111001111001111, 0b101101111001001,
    0b111100111001111, 0b111100111101111, 0b111001001001001, 0b111101111101111, 0b111101111001111};

bool digit_covers(int digit, double across, double up) {  // both 0..1
  const int column = std::min(2, static_cast<int>(across * 3.0)), row = std::min(4, static_cast<int>((1.0 - up) * 5.0));
  return digits[static_cast<std::size_t>(digit)] >> (14 - row * 3 - column) & 1;
}

Paint flywheel(const Sprite& sprite, double a, double z) {
  constexpr double outer = 0.62, rim = 0.10;
  const double r = std::hypot(a, z), angle = std::atan2(z, a);
  const double spoke = std::abs(std::remainder(angle, pi / 3.0)) * r;
  const float hub = sprite.cover(0.11 - r);
  if (hub > 0.0f) return {brass, hub};
  const float ring = sprite.cover(0.5 * rim - std::abs(r - outer + 0.5 * rim));
  const float spokes = r < outer ? sprite.cover(0.022 - spoke) : 0.0f;
  return {static_cast<float>(1.0 + 0.15 * z / outer) * iron_red, std::max(ring, spokes)};
}

Paint globe(const Sprite& sprite, double a, double z) {
  constexpr double radius = 0.42;
  const double r = std::hypot(a, z);
  const double bright = 1.05 - 0.5 * std::hypot(a + 0.14, z - 0.16) / radius;
  const bool line =
      std::abs(z) < 0.018 || std::abs(std::abs(a) - 0.24 * std::sqrt(std::max(0.0, 1 - z * z / 0.18))) < 0.012;
  return {static_cast<float>(line ? 0.7 * bright : bright + 0.1) * brass, sprite.cover(radius - r)};
}

Paint chimney(const Sprite& sprite, double a, double z) {
  const double w = z > 1.05 ? 0.22 : 0.15;
  const bool band = std::abs(z - 0.35) < 0.035 || std::abs(z - 0.75) < 0.035;
  const float light = static_cast<float>(1.25 - 0.45 * (a / w + 1.0) * 0.5);
  return {light * (band ? brass : dark_iron), z < 1.25 ? sprite.cover(w - std::abs(a)) : 0.0f};
}

Paint propeller(const Sprite& sprite, double a, double z) {
  const double r = std::hypot(a, z), angle = std::atan2(z, a);
  const float hub = sprite.cover(0.10 - r);
  if (hub > 0.0f) return {dark_iron, hub};
  const double petal = std::cos(1.5 * (angle - pi / 2));
  const double edge = 0.64 * std::sqrt(std::abs(petal)) - r;
  const float light = static_cast<float>(0.95 + 0.25 * std::sin(angle * 3.0));
  return {light * brass, std::abs(petal) > 0.35 ? sprite.cover(edge) : 0.0f};
}

Paint glider(const Sprite& sprite, double a, double z) {
  const double wing = 0.04 + 0.10 * (1.0 - std::abs(a) / 2.0);
  if (z > 0.25) return {dark_iron, 0.7f * sprite.cover(0.008 - std::abs(std::abs(a) - 0.9))};  // wires
  const double off = z - 0.03 * a * a;
  const bool rib = std::abs(std::remainder(a, 0.3)) < 0.015;
  return {(rib ? 0.75f : 1.0f) * wood, std::abs(a) < 2.0 ? sprite.cover(wing - std::abs(off)) : 0.0f};
}

}  // namespace

void paint_ornament(Canvas& canvas, const Lens& lens, const SceneExhibit& exhibit) {
  const Sprite sprite(lens, exhibit.center);
  if (exhibit.radius < 0.25 && exhibit.ornament != Ornament::hanging) return;
  const double size = std::clamp(exhibit.radius / 0.7, 0.5, 1.3);
  const auto stand = [&](double half, double low, double high, double middle, auto&& shape) {
    sprite.each(canvas, half * size, exhibit.height + low * size, exhibit.height + high * size,
                [&](double a, double z) { return shape(sprite, a / size, (z - exhibit.height) / size - middle); });
  };
  switch (exhibit.ornament) {
    case Ornament::flywheel:
      return stand(0.66, 0.0, 1.3, 0.60, flywheel);
    case Ornament::globe:
      return stand(0.45, 0.0, 0.9, 0.42, globe);
    case Ornament::chimney:
      return stand(0.25, 0.0, 1.3, 0.0, chimney);
    case Ornament::propeller:
      return stand(0.68, 0.0, 1.3, 0.58, propeller);
    case Ornament::hanging:
      return stand(2.0, -0.2, 3.0, 0.3, glider);
  }
}

void paint_plate(Canvas& canvas, const Lens& lens, const SceneExhibit& exhibit) {
  const Sprite sprite(lens, exhibit.center, exhibit.radius + 0.04);
  const bool hanging = exhibit.ornament == Ornament::hanging;
  const double middle = hanging ? 2.45 : std::min(0.95, 0.62 * exhibit.height);
  constexpr double radius = 0.23;
  const std::string text = std::to_string(exhibit.number);
  const auto count = static_cast<double>(text.size());
  const double high = 0.24, wide = 0.12, gap = 0.03, all = count * wide + (count - 1.0) * gap;
  sprite.each(canvas, radius + 0.02, middle - radius - 0.02, middle + radius + 0.02, [&](double a, double z) -> Paint {
    const double r = std::hypot(a, z - middle);
    const float share = sprite.cover(radius - r);
    if (r > radius - 0.03) return {hex(0xF6F3E2), share};
    const double across = a + 0.5 * all, up = (z - middle + 0.5 * high) / high;
    const double slot = std::floor(across / (wide + gap)), within = across - slot * (wide + gap);
    const bool ink = up > 0.0 && up < 1.0 && slot >= 0.0 && slot < count && within < wide &&
                     digit_covers(text[static_cast<std::size_t>(slot)] - '0', within / wide, up);
    return {ink ? hex(0xF6F3E2) : hex(0x2F5C4A), share};
  });
}

}  // namespace robot::simulation
