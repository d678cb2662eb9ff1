#include "robot/simulation/painter.hpp"

#include <algorithm>
#include <cmath>

#include "robot/simulation/canvas.hpp"
#include "robot/simulation/figures.hpp"
#include "robot/simulation/surfaces.hpp"

namespace robot::simulation {
namespace {

constexpr double near_plane = 0.05, far_plane = 120.0;  // m

// Paints one column of walls, exhibits, floor and ceiling, from the bottom up and from near to far.
class ColumnPainter {
 public:
  ColumnPainter(const Scene& scene, const Lens& lens, Canvas& canvas) : scene_(scene), lens_(lens), canvas_(canvas) {
    for (int y = 0; y < canvas.height; ++y) {
      const double below = y + 0.5 - lens.horizon;
      const double floor = below > 0.0 ? lens.focal * lens.eye / below : far_plane;
      const double ceiling = below < 0.0 ? lens.focal * (scene.ceiling - lens.eye) / -below : far_plane;
      rows_.push_back({static_cast<float>(floor), haze(floor), static_cast<float>(ceiling), haze(ceiling)});
    }
  }

  void paint(int x) {
    x_ = x;
    const double aside = (lens_.middle - (x + 0.5)) / lens_.focal;
    const double c = std::cos(lens_.pose.theta), s = std::sin(lens_.pose.theta);
    way_ = {c - aside * s, s + aside * c};
    stretch_ = std::sqrt(1.0 + aside * aside);
    bottom_ = canvas_.height;
    glass_.clear();
    const double end = march();
    paint_ceiling(end);
    for (auto it = glass_.rbegin(); it != glass_.rend(); ++it) paint_glass(*it);
  }

 private:
  struct Row {
    float floor, floor_haze, ceiling, ceiling_haze;
  };

  Point place(double depth) const { return lens_.pose.position() + depth * way_; }

  // Depth of the wall that ends the column.
  double march() {
    const auto& cells = scene_.cells;
    const double r = cells.resolution();
    double s = leave_mounting();
    double flat_from = s;
    SceneCell ground{};  // what the ray runs over
    bool plain = true;
    while (s < far_plane && bottom_ > 0) {
      const Cell here = cells.cell(place(s));
      if (!cells.contains(here)) break;
      const double free = scene_.free_way[here];
      if (free > 3.0 * r && plain) {  // over open floor without another look
        s += (free - 1.5 * r) / stretch_;
        continue;
      }
      const SceneCell& cell = cells[here];
      const bool other = cell.height != ground.height || cell.material != ground.material ||
                         cell.exhibit != ground.exhibit || cell.glass != ground.glass;
      if (other) {
        paint_flat(ground, flat_from, s);
        if (cell.glass != ground.glass) glass_.push_back(s);
        if (cell.height > ground.height) paint_side(cell, s, place(s));
        if (cell.height >= scene_.ceiling) return s;
        ground = cell;
        plain = cell.height == 0.0f && !cell.glass && cell.material == Material::floor;
        flat_from = s;
      }
      s += free > 3.0 * r ? (free - 1.5 * r) / stretch_ : to_next_cell(place(s), here);
    }
    paint_flat(ground, flat_from, std::min(s, far_plane));
    return std::min(s, far_plane);
  }

  // A wall camera hangs on its wall: skip what it is mounted on.
  double leave_mounting() const {
    double start = near_plane;
    for (double s = near_plane; s < 0.8; s += 0.02) {
      if (scene_.cells.at_or(scene_.cells.cell(place(s)), {}).height >= lens_.eye) start = s + 0.02;
    }
    return start;
  }

  double to_next_cell(Point p, Cell cell) const {
    const double r = scene_.cells.resolution();
    const Point low = scene_.cells.origin() + Point{cell.x * r, cell.y * r};
    const double to_x = way_.x > 0.0 ? (low.x + r - p.x) / way_.x : way_.x < 0.0 ? (low.x - p.x) / way_.x : 1e9;
    const double to_y = way_.y > 0.0 ? (low.y + r - p.y) / way_.y : way_.y < 0.0 ? (low.y - p.y) / way_.y : 1e9;
    return std::max(0.0, std::min(to_x, to_y)) + 1e-6;
  }

  void put(int y, float depth, Color color) {
    const std::size_t i = canvas_.at(x_, y);
    canvas_.pixels[i] = pack(color);
    canvas_.depths[i] = depth;
  }

  // Floor, or the top of something lower than the eye, between two depths.
  void paint_flat(const SceneCell& ground, double from, double to) {
    if (ground.height >= lens_.eye || to <= from) return;
    const int top = std::max(0, static_cast<int>(std::ceil(lens_.row(to, ground.height) - 0.5)));
    const bool floor = ground.height <= 0.0f;
    for (int y = bottom_ - 1; y >= top; --y) {
      const Row& row = rows_[static_cast<std::size_t>(y)];
      const double below = y + 0.5 - lens_.horizon;
      const double depth = floor ? row.floor : std::min(far_plane, lens_.focal * (lens_.eye - ground.height) / below);
      const Point p = place(depth);
      const Color color = floor ? floor_color(scene_, ground, p, depth) : top_color(scene_, ground, p);
      put(y, static_cast<float>(depth), mix(color, haze_color, floor ? row.floor_haze : haze(depth)));
    }
    bottom_ = std::min(bottom_, std::max(top, 0));
  }

  void paint_side(const SceneCell& cell, double depth, Point p) {
    const int top = std::max(0, static_cast<int>(std::ceil(lens_.row(depth, cell.height) - 0.5)));
    if (top >= bottom_) return;
    const SidePainter side(scene_, cell, p, depth * stretch_ / lens_.focal);
    const float lost = haze(depth);
    const double metres_a_row = depth / lens_.focal;
    for (int y = bottom_ - 1; y >= top; --y) {
      const double z = lens_.eye - (y + 0.5 - lens_.horizon) * metres_a_row;
      put(y, static_cast<float>(depth), mix(side.color(z), haze_color, lost));
    }
    bottom_ = top;
  }

  void paint_ceiling(double end) {
    const int wall_top = std::clamp(static_cast<int>(std::ceil(lens_.row(end, scene_.ceiling) - 0.5)), 0, bottom_);
    for (int y = bottom_ - 1; y >= 0; --y) {
      const Row& row = rows_[static_cast<std::size_t>(y)];
      const bool above = y < wall_top && y + 0.5 < lens_.horizon;
      const double depth = above ? row.ceiling : end;
      const Color color = above ? mix(ceiling_color(place(depth), depth), haze_color, row.ceiling_haze) : haze_color;
      put(y, static_cast<float>(depth), color);
    }
  }

  void paint_glass(double depth) {
    const int top = std::max(0, static_cast<int>(lens_.row(depth, glass_height)));
    const int low = std::min(canvas_.height - 1, static_cast<int>(lens_.row(depth, 0.0)));
    const int rail = static_cast<int>(lens_.row(depth, 0.10));
    for (int y = top; y <= low; ++y) {
      const std::size_t i = canvas_.at(x_, y);
      if (canvas_.depths[i] < depth) continue;
      const bool edge = y < top + 2;
      const float share = y >= rail ? 0.75f : edge ? 0.6f : 0.14f;
      const Color color = y >= rail ? hex(0x6E7F78) : edge ? hex(0xF4FBFA) : hex(0xCFE6E8);
      canvas_.pixels[i] = pack(mix(hex(canvas_.pixels[i]), color, share));
    }
  }

  const Scene& scene_;
  const Lens& lens_;
  Canvas& canvas_;
  std::vector<Row> rows_;
  std::vector<double> glass_;
  Point way_;             // map metres a metre of depth
  double stretch_ = 1.0;  // its length
  int x_ = 0, bottom_ = 0;
};

// Rows from the top, with a little less light towards the corners. In blocks, because rows and columns cross here.
Image finish(const Canvas& canvas) {
  constexpr int block = 16;
  Image image{canvas.width, canvas.height, {}};
  image.rgb.resize(canvas.pixels.size() * 3);
  const float cx = 0.5f * static_cast<float>(canvas.width), cy = 0.45f * static_cast<float>(canvas.height);
  const auto squared = [](float v) { return v * v; };
  for (int y0 = 0; y0 < canvas.height; y0 += block) {
    for (int x = 0; x < canvas.width; ++x) {
      const float dx = squared((static_cast<float>(x) - cx) / cx) - 0.45f;
      for (int y = y0; y < std::min(y0 + block, canvas.height); ++y) {
        const float dark = dx + squared((static_cast<float>(y) - cy) / (static_cast<float>(canvas.height) - cy));
        const auto light = static_cast<std::uint32_t>(256.0f - 44.0f * std::max(0.0f, dark));
        const std::uint32_t pixel = canvas.pixels[canvas.at(x, y)];
        std::uint8_t* out =
            image.rgb.data() +
            3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(canvas.width) + static_cast<std::size_t>(x));
        out[0] = static_cast<std::uint8_t>((pixel >> 16 & 255) * light >> 8);
        out[1] = static_cast<std::uint8_t>((pixel >> 8 & 255) * light >> 8);
        out[2] = static_cast<std::uint8_t>((pixel & 255) * light >> 8);
      }
    }
  }
  return image;
}

}  // namespace

CameraView onboard_view(const Pose& map_from_base, double pan, double tilt) {
  CameraView view;
  view.pose = map_from_base * Pose{0.15, 0.0, pan};
  view.tilt = tilt;
  view.field_of_view = 1.35;
  view.robot = false;
  return view;
}

CameraView wall_view(const WallCamera& camera) {
  CameraView view;
  view.pose = camera.pose * Pose{0.35, 0.0, 0.0};  // on an arm, clear of its wall
  view.height = camera.height;
  view.tilt = camera.tilt;
  view.field_of_view = camera.field_of_view;
  return view;
}

Image Painter::render(const CameraView& view, const Snapshot& moment) const {
  Canvas canvas(view.width, view.height_px);
  Lens lens;
  lens.pose = view.pose;
  lens.eye = view.height;
  lens.middle = 0.5 * view.width;
  lens.focal = lens.middle / std::tan(0.5 * view.field_of_view);
  lens.horizon = 0.5 * view.height_px + lens.focal * std::tan(view.tilt);
  ColumnPainter columns(scene_, lens, canvas);
  for (int x = 0; x < canvas.width; ++x) columns.paint(x);
  paint_figures(canvas, lens, scene_, moment, view.robot);
  return finish(canvas);
}

}  // namespace robot::simulation
