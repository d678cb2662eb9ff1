// Worlds drawn as text, so that a test is a picture:
//   const auto map = ascii_world(0.1, {"#######",
//                                      "#R   G#",
//                                      "#######"});
// '#' occupied, '?' unknown, anything else free. The first row is the top (largest y); the lower-left corner is the
// map's origin. Letters and digits name places: draw_world(...).at('R') is the centre of that cell.
#pragma once

#include <algorithm>
#include <cctype>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "robot/geometry/grid.hpp"

namespace robot::testing {

struct AsciiWorld {
  OccupancyGrid map;
  std::map<char, Point> marks;  // m, map frame
  Point at(char mark) const { return marks.at(mark); }
};

// resolution: metres a character. Rows shorter than the longest are filled with free cells.
inline AsciiWorld draw_world(double resolution, const std::vector<std::string>& rows, Point origin = {}) {
  std::size_t width = 0;
  for (const auto& row : rows) width = std::max(width, row.size());
  AsciiWorld world{OccupancyGrid(static_cast<int>(width), static_cast<int>(rows.size()), resolution, origin, free_cell),
                   {}};
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t x = 0; x < rows[r].size(); ++x) {
      const Cell cell{static_cast<int>(x), static_cast<int>(rows.size() - 1 - r)};
      const char c = rows[r][x];
      world.map[cell] = c == '#' ? occupied_cell : c == '?' ? unknown_cell : free_cell;
      if (!std::isalnum(static_cast<unsigned char>(c))) continue;
      if (!world.marks.emplace(c, world.map.center(cell)).second) {
        throw std::invalid_argument(std::string("ascii world: mark drawn twice: ") + c);
      }
    }
  }
  return world;
}

inline OccupancyGrid ascii_world(double resolution, const std::vector<std::string>& rows, Point origin = {}) {
  return draw_world(resolution, rows, origin).map;
}

}  // namespace robot::testing
