#include "robot/simulation/figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "robot/simulation/sprite.hpp"

namespace robot::simulation {
namespace {

constexpr std::array clothes{hex(0x7B5578), hex(0x4F6C9C), hex(0x9A6B45), hex(0xB98B4A),
                             hex(0x5D7466), hex(0x8E4B3F), hex(0x3B4A66), hex(0xCFC3A6)};
constexpr std::array trousers{hex(0x3A4450), hex(0x4A4238), hex(0x2F3A36), hex(0x56504A)};
constexpr std::array skins{hex(0xD9A67E), hex(0xB97C56), hex(0x8A5A3C), hex(0xE8C19A)};
constexpr std::array hairs{hex(0x3A2A20), hex(0x6B4A2B), hex(0x1F1B1A), hex(0x9C8F84), hex(0xB98A4A)};

// Takes away light from the floor in an ellipse.
void paint_shadow(Canvas& canvas, const Lens& lens, Point place, double radius) {
  const Lens::Seen seen = lens.see(place);
  if (seen.depth < 0.5 || seen.depth > 40.0) return;
  const double half_x = radius * lens.focal / seen.depth, row = lens.row(seen.depth, 0.0);
  const double half_y = std::max(1.0, lens.row(std::max(0.3, seen.depth - radius), 0.0) - row);
  const int left = std::max(0, static_cast<int>(seen.column - half_x));
  const int right = std::min(canvas.width - 1, static_cast<int>(seen.column + half_x));
  const int top = std::max(0, static_cast<int>(row - half_y));
  const int low = std::min(canvas.height - 1, static_cast<int>(row + half_y));
  for (int x = left; x <= right; ++x) {
    for (int y = top; y <= low; ++y) {
      const double dx = (x + 0.5 - seen.column) / half_x, dy = (y + 0.5 - row) / half_y;
      const double off = dx * dx + dy * dy;
      if (off >= 1.0) continue;
      const std::size_t i = canvas.at(x, y);
      const double floor = lens.focal * lens.eye / std::max(1e-3, y + 0.5 - lens.horizon);
      if (std::abs(canvas.depths[i] - floor) > 0.02 * floor) continue;
      canvas.pixels[i] = pack(static_cast<float>(1.0 - 0.38 * (1.0 - off)) * hex(canvas.pixels[i]));
    }
  }
}

}  // namespace

void paint_person(Canvas& canvas, const Lens& lens, const Person& person) {
  const Sprite sprite(lens, person.position);
  if (!sprite.visible() || sprite.depth > 60.0) return;
  const double h = person.height, child = person.child ? 1.12 : 1.0;  // children have bigger heads
  const std::uint32_t look = person.look;
  const Color cloth = clothes[look % clothes.size()], trouser = trousers[look / 8 % trousers.size()];
  const Color skin = skins[look / 32 % skins.size()], hair = hairs[look / 128 % hairs.size()];
  const bool long_hair = look / 1024 % 2 == 0;
  const double turned = wrap_angle(person.heading - lens.pose.theta);  // 0: shows the back
  const double broad = 0.70 + 0.30 * std::abs(std::cos(turned)), face = -std::cos(turned), side = -std::sin(turned);
  const double reach = std::min(0.30, 0.24 * norm(person.velocity)) * std::sin(person.stride) * side;
  const double spread = 0.052 * h * broad;
  const double head_z = h - 0.075 * h * child, head_w = 0.052 * h * child, head_h = 0.073 * h * child;

  const auto paint = [&](double a, double z) -> Paint {
    if (z > 0.835 * h) {  // head
      const double across = a / head_w, up = (z - head_z) / head_h, off = std::hypot(across, up);
      const float share = sprite.cover((1.0 - off) * head_w);
      const float neck = z < 0.90 * h ? sprite.cover(0.034 * h - std::abs(a)) : 0.0f;
      const Color under = 0.88f * (long_hair ? hair : skin);
      if (share <= 0.0f) return {under, neck};
      const double hairline = face > 0.2 ? 0.35 : face < -0.3 ? -0.8 : 0.1;
      const bool in_hair = up > hairline || (long_hair && std::abs(across) > 0.72) || across * side < -0.35;
      const Color head = static_cast<float>(1.06 - 0.10 * (across + 1.0)) * (in_hair ? hair : skin);
      return {mix(under, head, neck > 0.0f ? share : 1.0f), std::max(share, neck)};
    }
    if (z > 0.47 * h) {  // torso and arms
      const double w = (0.100 + 0.028 * (z / h - 0.47) / 0.3) * h * broad;
      double outer = w + 0.034 * h;
      if (z > 0.72 * h) outer *= std::sqrt(std::max(0.0, 1.0 - std::pow((z - 0.72 * h) / (0.122 * h), 2.0)));
      const bool arm = std::abs(a) > w - 0.004 * h && z < 0.775 * h, hand = arm && z < 0.50 * h;
      const float shade = static_cast<float>(1.10 - 0.13 * (a / std::max(w, 0.01) + 1.0));
      return {hand ? skin : (arm ? 0.84f : 1.0f) * shade * cloth, sprite.cover(outer - std::abs(a))};
    }
    const double down = 1.0 - z / (0.47 * h);
    const double left = -spread + reach * down, right = spread - reach * down;
    const double w = (0.050 - 0.014 * down) * h;
    const double off = std::min(std::abs(a - left), std::abs(a - right));
    const bool further = std::abs(a - (reach > 0 ? right : left)) < w;
    const Color color = z < 0.035 * h ? hex(0x2A2622) : (further ? 0.86f : 1.0f) * trouser;
    return {color, sprite.cover(w - off)};
  };
  sprite.each(canvas, 0.21 * h + std::abs(reach), 0.0, h, paint);
}

void paint_robot(Canvas& canvas, const Lens& lens, const Pose& map_from_base) {
  const Sprite sprite(lens, map_from_base.position());
  const double turned = wrap_angle(map_from_base.theta - lens.pose.theta);
  const double facing = -std::cos(turned), aside = -0.20 * std::sin(turned);
  constexpr double half = 0.27, top = 1.18;
  const auto paint = [&](double a, double z) -> Paint {
    double w = z < 0.22 ? half : 0.215 + 0.03 * std::abs(z - 0.7);
    if (z > top - 0.2) w *= std::sqrt(std::max(0.0, 1.0 - std::pow((z - top + 0.2) / 0.2, 2.0)));
    const float share = sprite.cover(w - std::abs(a));
    const float light = static_cast<float>(1.12 - 0.24 * (a / half + 1.0));
    Color color = light * (z < 0.22 ? hex(0x2B3440) : hex(0x2F55D8));
    if (z > 0.22 && z < 0.26) color = hex(0xF5B81E);
    const double screen_w = 0.155 * std::max(0.15, facing), off = (a - aside) / screen_w;
    if (facing > 0.1 && std::abs(off) < 1.0 && z > 0.80 && z < 1.04) {
      color = hex(0x12352A);
      const bool eye = std::hypot((std::abs(off) - 0.45) * 0.155, z - 0.93) < 0.045;
      if (eye) color = hex(0xF5F4E6);
    }
    return {color, share};
  };
  sprite.each(canvas, half + 0.02, 0.0, top, paint);
}

void paint_figures(Canvas& canvas, const Lens& lens, const Scene& scene, const Snapshot& moment, bool robot) {
  enum class Kind { person, guide, ornament, plate };
  struct Figure {
    double depth;
    Kind kind;
    std::size_t index;
  };
  std::vector<Figure> figures;
  const auto add = [&](Point place, double toward, Kind kind, std::size_t index) {
    const Lens::Seen seen = lens.see(place);
    const double slack = 2.5 * lens.focal / std::max(0.3, seen.depth);
    if (seen.depth - toward < 0.15 || seen.column < -slack || seen.column > canvas.width + slack) return;
    figures.push_back({seen.depth - toward, kind, index});
  };
  for (std::size_t i = 0; i < moment.people.size(); ++i) add(moment.people[i].position, 0.0, Kind::person, i);
  for (std::size_t i = 0; i < scene.exhibits.size(); ++i) {
    add(scene.exhibits[i].center, 0.0, Kind::ornament, i);
    add(scene.exhibits[i].center, scene.exhibits[i].radius, Kind::plate, i);
  }
  if (robot) add(moment.robot.position(), 0.0, Kind::guide, 0);
  std::ranges::stable_sort(figures, [](const Figure& a, const Figure& b) { return a.depth > b.depth; });
  for (const Figure& figure : figures) {
    if (figure.kind == Kind::person) paint_shadow(canvas, lens, moment.people[figure.index].position, 0.38);
    if (figure.kind == Kind::guide) paint_shadow(canvas, lens, moment.robot.position(), 0.45);
  }
  for (const Figure& figure : figures) {
    switch (figure.kind) {
      case Kind::person:
        paint_person(canvas, lens, moment.people[figure.index]);
        break;
      case Kind::guide:
        paint_robot(canvas, lens, moment.robot);
        break;
      case Kind::ornament:
        paint_ornament(canvas, lens, scene.exhibits[figure.index]);
        break;
      case Kind::plate:
        paint_plate(canvas, lens, scene.exhibits[figure.index]);
    }
  }
}

}  // namespace robot::simulation
