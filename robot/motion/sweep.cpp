#include "robot/motion/sweep.hpp"

#include <algorithm>
#include <cmath>

namespace robot::sweep {
namespace {

// A measure of the angle from u to v, turning counter-clockwise, that grows with it from 0 to 4, a unit a quadrant: no
// trigonometry, and exact for the small angles of wide arcs. Both vectors have the length 1 / sqrt(inverse_radius2).
inline float pseudo_angle(float ux, float uy, float vx, float vy, float inverse_radius2) {
  const float c = (ux * vx + uy * vy) * inverse_radius2, s = (ux * vy - uy * vx) * inverse_radius2;
  const float left = c > 0.0f ? s : 1.0f - c, right = c > 0.0f ? 3.0f + c : 2.0f - s;
  return s >= 0.0f ? left : right;
}

}  // namespace

float straight(const Box& box, float sign, const float* x, const float* y, std::size_t count) {
  const float edge = sign > 0.0f ? box.front : box.rear;
  float nearest = far_away;
  for (std::size_t i = 0; i < count; ++i) {
    const float way = sign * x[i] - edge;
    const bool meets = (std::abs(y[i]) < box.half_width) & (way >= 0.0f);
    nearest = std::min(nearest, meets ? way : far_away);
  }
  return nearest;
}

// In the box's frame every point turns about the centre, by minus the box's own turn. Where its circle crosses the
// lines of the four edges, between their ends, are the candidates.
float turning(const Box& box, float radius, float sign, const float* x, const float* y, std::size_t count) {
  const float front = box.front, rear = -box.rear, left = box.half_width, right = -box.half_width;
  const float low = right - radius, high = left - radius;
  float nearest = far_away;
  for (std::size_t i = 0; i < count; ++i) {
    const float px = x[i], py = y[i] - radius, r2 = px * px + py * py, inverse = 1.0f / std::max(r2, 1e-12f);
    const auto meet = [&](float mx, float my, bool valid) {
      const float turned = pseudo_angle(mx, sign * my, px, sign * py, inverse);
      return valid ? turned : far_away;
    };
    const auto on_x = [&](float edge) {  // front or rear
      const float y2 = r2 - edge * edge, my = std::sqrt(std::max(y2, 0.0f));
      const float a = meet(edge, my, (y2 >= 0.0f) & (my >= low) & (my <= high));
      const float b = meet(edge, -my, (y2 >= 0.0f) & (-my >= low) & (-my <= high));
      return std::min(a, b);
    };
    const auto on_y = [&](float edge) {  // left or right
      const float x2 = r2 - edge * edge, mx = std::sqrt(std::max(x2, 0.0f));
      const float a = meet(mx, edge, (x2 >= 0.0f) & (mx >= rear) & (mx <= front));
      const float b = meet(-mx, edge, (x2 >= 0.0f) & (-mx >= rear) & (-mx <= front));
      return std::min(a, b);
    };
    const float first = std::min(std::min(on_x(front), on_x(rear)), std::min(on_y(low), on_y(high)));
    const bool inside = (px > rear) & (px < front) & (y[i] > right) & (y[i] < left);
    nearest = std::min(nearest, inside ? far_away : first);
  }
  return nearest;
}

namespace {

inline float box_distance(const Box& box, float dx, float dy, float cosine, float sine) {
  const float bx = cosine * dx + sine * dy, by = cosine * dy - sine * dx;
  const float ox = std::max(bx - box.front, -box.rear - bx), oy = std::abs(by) - box.half_width;
  const float ux = std::max(ox, 0.0f), uy = std::max(oy, 0.0f);
  return std::sqrt(ux * ux + uy * uy) + std::min(std::max(ox, oy), 0.0f);
}

}  // namespace

float least_distance(const Box& box, float px, float py, float cosine, float sine, const float* x, const float* y,
                     const float* allowance, std::size_t count) {
  float least = far_away;
  const auto distance = [&](std::size_t i) { return box_distance(box, x[i] - px, y[i] - py, cosine, sine); };
  if (allowance) {
    for (std::size_t i = 0; i < count; ++i) least = std::min(least, distance(i) - allowance[i]);
  } else {
    for (std::size_t i = 0; i < count; ++i) least = std::min(least, distance(i));
  }
  return least;
}

float least_distance_moving(const Box& box, float px, float py, float cosine, float sine, const float* x,
                            const float* y, const float* vx, const float* vy, float seconds, std::size_t count) {
  float least = far_away;
  for (std::size_t i = 0; i < count; ++i) {
    const float dx = x[i] + seconds * vx[i] - px, dy = y[i] + seconds * vy[i] - py;
    least = std::min(least, box_distance(box, dx, dy, cosine, sine));
  }
  return least;
}

}  // namespace robot::sweep
