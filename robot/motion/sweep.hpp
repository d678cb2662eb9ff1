// The hot loops of motion: many points against one rectangle. Compiled for the vector unit with arithmetic that assumes
// finite numbers (see CMakeLists.txt); callers hand in finite points only. tests/bench/motion_bench.cpp shows why.
#pragma once

#include <cstddef>

namespace robot::sweep {

inline constexpr float far_away = 1e30f;

struct Box {
  float front, rear, half_width;  // m, all positive
};

// Least way (m) straight ahead (sign 1) or back (sign -1) until the box meets a point; far_away: none.
float straight(const Box& box, float sign, const float* x, const float* y, std::size_t count);

// Least turn about (0, radius) until the box meets a point that it does not cover yet, as a pseudo-angle of one unit a
// quadrant; sign: of the angular velocity. far_away: none.
float turning(const Box& box, float radius, float sign, const float* x, const float* y, std::size_t count);

// Least signed distance (m) between the box at a pose and the points, each less its own allowance when given (or null).
float least_distance(const Box& box, float px, float py, float cosine, float sine, const float* x, const float* y,
                     const float* allowance, std::size_t count);

// The same for points that have gone on for some seconds with their own velocities (vx, vy).
float least_distance_moving(const Box& box, float px, float py, float cosine, float sine, const float* x,
                            const float* y, const float* vx, const float* vy, float seconds, std::size_t count);

}  // namespace robot::sweep
