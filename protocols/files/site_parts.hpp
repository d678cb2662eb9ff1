// Inside of the site reader: a museum together with the lines that its parts came from.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "protocols/files/problem.hpp"
#include "robot/body.hpp"
#include "robot/museum.hpp"

namespace files {

struct SiteLines {
  int home = 0;
  int boundary = 0;
  std::vector<int> hazards, cameras, areas, exhibits;
  std::vector<std::vector<int>> viewpoints;  // by exhibit
};

struct Site {
  robot::Museum museum;
  SiteLines lines;
  std::vector<Problem> problems;
};

// Reads site.toml and the map; problems are collected, not thrown.
Site read_site(const std::filesystem::path& dir);

// Adds problems of places: home and viewpoints on the map, with room for the body, outside hazards, reachable from
// home.
void check_places(Site& site, const std::string& file, const robot::Footprint& footprint);

}  // namespace files
