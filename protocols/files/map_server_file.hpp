// Maps as ROS's map_server keeps them: a small YAML file beside a PGM picture (http://wiki.ros.org/map_server).
// The picture's row 0 is the top; grids here run from the bottom up.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "robot/geometry/grid.hpp"

namespace files {

// A grey picture, rows from the top, values 0 (black) .. 255 (white).
struct GreyImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;
};

// PGM, text (P2) or binary (P5), 8 or 16 bits; deeper values are scaled to 0..255. At most 64 million pixels.
// Throws FileError with `name` as the file.
GreyImage parse_pgm(std::string_view bytes, const std::string& name);
std::string to_pgm(const GreyImage& image);

// How grey means occupancy.
struct MapServerRules {
  enum class Mode { trinary, scale, raw };
  bool negate = false;            // false: black is occupied
  double occupied_thresh = 0.65;  // above: occupied
  double free_thresh = 0.196;     // below: free
  Mode mode = Mode::trinary;
};

// origin: metres, the lower-left corner of the picture.
robot::OccupancyGrid to_grid(const GreyImage& image, const MapServerRules& rules, double resolution,
                             robot::Point origin);

// Reads `map.yaml` and the picture it names (relative to it, .pgm or .pgm.gz). Throws FileError; a turned origin (yaw
// other than 0) is refused, because grids here are not turned.
robot::OccupancyGrid read_map_server(const std::filesystem::path& yaml);

// A picture without its YAML file.
robot::OccupancyGrid read_pgm_map(const std::filesystem::path& pgm, double resolution, robot::Point origin,
                                  const MapServerRules& rules = {});

// Writes `map.yaml` and, beside it, the same name with .pgm: free white, occupied black, everything else grey.
// Throws FileError.
void write_map_server(const std::filesystem::path& yaml, const robot::OccupancyGrid& map);

}  // namespace files
