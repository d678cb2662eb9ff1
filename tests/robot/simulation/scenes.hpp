// Small museums, drawn as text, that the tests of the simulated world share.
#pragma once

#include <string>
#include <vector>

#include "robot/museum.hpp"
#include "tests/support/ascii_world.hpp"

namespace robot::simulation::testing {

// `resolution` metres a character. The robot's home is at 'H' or, without one, in the middle.
inline Museum museum_of(double resolution, const std::vector<std::string>& rows) {
  const auto drawn = robot::testing::draw_world(resolution, rows);
  Museum museum;
  museum.id = "drawn";
  museum.map = drawn.map;
  const auto home = drawn.marks.find('H');
  const Point middle{0.5 * museum.map.width() * resolution, 0.5 * museum.map.height() * resolution};
  const Point at = home == drawn.marks.end() ? middle : home->second;
  museum.home = {at.x, at.y, 0.0};
  return museum;
}

// An empty hall with walls all round, metres.
inline Museum hall(double width, double height, double resolution = 0.1) {
  const int columns = static_cast<int>(width / resolution), lines = static_cast<int>(height / resolution);
  std::vector<std::string> rows(static_cast<std::size_t>(lines), "#" + std::string(columns - 2, ' ') + "#");
  rows.front() = rows.back() = std::string(columns, '#');
  return museum_of(resolution, rows);
}

inline Polygon box(double left, double low, double right, double high) {
  return {{left, low}, {right, low}, {right, high}, {left, high}};
}

inline Exhibit exhibit(const std::string& id, int number, Polygon outline) {
  Exhibit made;
  made.id = id;
  made.number = number;
  made.outline = std::move(outline);
  return made;
}

// Fills a box of the map.
inline void build(Museum& museum, double left, double low, double right, double high) {
  for (std::size_t i = 0; i < museum.map.size(); ++i) {
    const Point p = museum.map.center(museum.map.cell_at(i));
    if (p.x > left && p.x < right && p.y > low && p.y < high) museum.map.cells()[i] = occupied_cell;
  }
}

}  // namespace robot::simulation::testing
