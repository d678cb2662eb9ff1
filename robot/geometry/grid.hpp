// Grids over the plane: x right, y up, the origin is the lower-left corner of cell (0, 0). Only this file converts
// between metres and cells.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "robot/geometry/pose.hpp"

namespace robot {

struct Cell {
  int x = 0;
  int y = 0;
  friend bool operator==(const Cell&, const Cell&) = default;
};

template <typename T>
class Grid {
 public:
  Grid() = default;
  // resolution: metres a cell; origin: metres, the lower-left corner. Throws std::invalid_argument on a bad shape.
  Grid(int width, int height, double resolution, Point origin, T value = T{})
      : width_(width), height_(height), resolution_(resolution), origin_(origin) {
    if (width < 0 || height < 0 || !(resolution > 0.0)) throw std::invalid_argument("grid: bad size or resolution");
    cells_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), value);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  double resolution() const { return resolution_; }  // m
  Point origin() const { return origin_; }           // m
  std::size_t size() const { return cells_.size(); }
  bool empty() const { return cells_.empty(); }

  bool contains(Cell c) const { return c.x >= 0 && c.y >= 0 && c.x < width_ && c.y < height_; }
  bool contains(Point p) const {
    return p.x >= origin_.x && p.y >= origin_.y && p.x < origin_.x + width_ * resolution_ &&
           p.y < origin_.y + height_ * resolution_;
  }

  // The cell that holds a point; a point outside (or not finite) gives a cell for which contains() is false.
  Cell cell(Point p) const {
    const double x = std::floor((p.x - origin_.x) / resolution_), y = std::floor((p.y - origin_.y) / resolution_);
    const bool inside = x >= 0.0 && y >= 0.0 && x < width_ && y < height_;
    return inside ? Cell{static_cast<int>(x), static_cast<int>(y)} : Cell{-1, -1};
  }
  Point center(Cell c) const { return {origin_.x + (c.x + 0.5) * resolution_, origin_.y + (c.y + 0.5) * resolution_}; }

  std::size_t index(Cell c) const {
    return static_cast<std::size_t>(c.y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(c.x);
  }
  Cell cell_at(std::size_t index) const {
    const auto w = static_cast<std::size_t>(width_);
    return {static_cast<int>(index % w), static_cast<int>(index / w)};
  }

  // Unchecked: the cell must be contained.
  T& operator[](Cell c) { return cells_[index(c)]; }
  const T& operator[](Cell c) const { return cells_[index(c)]; }
  T at_or(Cell c, T otherwise) const { return contains(c) ? cells_[index(c)] : otherwise; }

  // Rows from the bottom up, each from left to right.
  std::vector<T>& cells() { return cells_; }
  const std::vector<T>& cells() const { return cells_; }

  friend bool operator==(const Grid&, const Grid&) = default;

 private:
  int width_ = 0;
  int height_ = 0;
  double resolution_ = 0.05;
  Point origin_;
  std::vector<T> cells_;
};

// Occupancy in per cent as in ROS nav_msgs/OccupancyGrid: 0 free .. 100 occupied, -1 unknown.
using OccupancyGrid = Grid<std::int8_t>;
inline constexpr std::int8_t free_cell = 0;
inline constexpr std::int8_t occupied_cell = 100;
inline constexpr std::int8_t unknown_cell = -1;
inline constexpr bool is_occupied(std::int8_t value) { return value >= 65; }
inline constexpr bool is_free(std::int8_t value) { return value >= 0 && value < 25; }

}  // namespace robot
