// A museum of 10 by 5 metres with two exhibits, one hazard and one tour.
#pragma once

#include <string>
#include <utility>

#include "robot/museum.hpp"

namespace testing_support {

inline robot::Museum small_museum() {
  robot::Museum museum;
  museum.id = "test-hall";
  museum.title = {{"en", "Test hall"}, {"de", "Prüfhalle"}};
  museum.map = robot::OccupancyGrid(200, 100, 0.05, {-1.0, -1.0}, robot::free_cell);
  for (int x = 0; x < 200; ++x) museum.map[{x, 0}] = robot::occupied_cell;
  museum.map[{100, 99}] = robot::unknown_cell;
  museum.hazards.push_back({"plate", robot::HazardKind::low_obstacle, {{5, 1}, {6, 1}, {6, 2}}, {{"en", "Plate"}}});
  museum.boundary = {{-1, -1}, {9, -1}, {9, 4}, {-1, 4}};
  for (const auto& [id, x] : {std::pair{"beam-engine", 2.0}, std::pair{"orrery", 4.0}}) {
    robot::Exhibit exhibit;
    exhibit.id = id;
    exhibit.number = static_cast<int>(museum.exhibits.size()) + 1;
    exhibit.title = {{"en", std::string("The ") + id}, {"de", std::string("Das ") + id}};
    exhibit.summary = {{"en", "Something to look at."}};
    exhibit.outline = {{x, 1}, {x + 1, 1}, {x + 1, 2}, {x, 2}};
    exhibit.viewpoints = {{{x, 0.0, 1.57}}, {{x + 0.5, 0.0, 1.57}}};
    exhibit.narrations = {{{{"en", "Look."}, {"de", "Schau."}}, "pictures/it.svg", robot::Seconds(20)}};
    museum.exhibits.push_back(exhibit);
  }
  museum.tours.push_back({"short", {{"en", "Short tour"}}, {{"en", "Both."}}, {"beam-engine", "orrery"}});
  museum.areas.push_back({{{"en", "Hall"}}, {3.0, 2.0}});
  museum.home = {0.0, 0.0, 0.0};
  return museum;
}

}  // namespace testing_support
