// Maps of CARMEN (binary chunks) and of the Wean Hall course (text), as occupancy grids with the lower-left corner at
// the file's own origin.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "robot/geometry/grid.hpp"

namespace files {

// A place that the map's makers named.
struct NamedPlace {
  std::string name;
  robot::Point point;
  std::optional<double> theta;  // rad
};

struct CarmenMap {
  robot::OccupancyGrid grid;
  std::vector<NamedPlace> places;
};

// Plain or gzipped. Throws FileError.
CarmenMap read_carmen_map(const std::filesystem::path& path);
CarmenMap parse_carmen_map(std::string_view bytes, const std::string& name);

// wean.dat: 800 rows of 800 values, x-major, probability of *free*, -1 unknown; 10 cm. What lies between wall and floor
// is unknown too. Throws FileError.
robot::OccupancyGrid read_wean_map(const std::filesystem::path& path);
robot::OccupancyGrid parse_wean_map(std::string_view text, const std::string& name);

// Any map that is known here, told apart by name and content: map_server YAML, CARMEN .map, wean.dat. Throws FileError.
robot::OccupancyGrid read_map(const std::filesystem::path& path);

}  // namespace files
