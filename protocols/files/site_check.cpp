#include <cstdio>

#include "protocols/files/site_parts.hpp"
#include "robot/geometry/free_space.hpp"
#include "robot/geometry/polygon.hpp"

namespace files {
namespace {

std::string at(robot::Point p) {
  char text[64];
  std::snprintf(text, sizeof text, "(%.2f, %.2f)", p.x, p.y);
  return text;
}

// The first hazard that comes closer to the point than the radius.
const robot::Hazard* hazard_near(const robot::Museum& museum, robot::Point p, double radius) {
  for (const auto& hazard : museum.hazards) {
    if (robot::contains(hazard.polygon, p) || robot::distance_to_edge(hazard.polygon, p) < radius) return &hazard;
  }
  return nullptr;
}

// Says what is wrong with a place, most specific first.
class PlaceCheck {
 public:
  PlaceCheck(Site& site, const std::string& file, const robot::Footprint& footprint)
      : museum_(site.museum), problems_(site.problems), file_(file), turning_radius_(footprint.circumscribed()) {
    std::vector<robot::Polygon> hazards;
    for (const auto& hazard : museum_.hazards) hazards.push_back(hazard.polygon);
    const auto open = robot::open_cells(museum_.map, hazards, museum_.boundary);
    room_to_turn_ = robot::cells_clear_for(open, turning_radius_);
    const auto passable = robot::cells_clear_for(open, footprint.inscribed());
    reached_ = robot::reachable_cells(passable, museum_.home.position());
  }

  // The body turns on the spot there, whatever its heading. Returns whether it can stand.
  bool check(robot::Point p, int line, const std::string& what) {
    const auto complain = [&](const std::string& text, const std::string& mend) {
      problems_.push_back({file_, line, what + " at " + at(p) + " " + text, mend});
      return false;
    };
    if (!museum_.map.contains(p)) return complain("is off the map", "give a place on the map, in metres");
    if (!museum_.boundary.empty() && !robot::contains(museum_.boundary, p)) {
      return complain("is outside of the boundary", "move it in or widen the boundary");
    }
    if (robot::is_occupied(museum_.map[museum_.map.cell(p)])) {
      return complain("is inside of an obstacle", "move it to free floor");
    }
    if (const auto* hazard = hazard_near(museum_, p, turning_radius_)) {
      return complain("touches hazard \"" + hazard->id + "\" when the robot turns", "move it away from the hazard");
    }
    if (!room_to_turn_[room_to_turn_.cell(p)]) {
      return complain("leaves the robot no room to turn", "move it away from walls and the boundary");
    }
    return true;
  }

  void check_reached(robot::Point p, int line, const std::string& what) {
    if (reached_[reached_.cell(p)]) return;
    problems_.push_back({file_, line, what + " at " + at(p) + " cannot be reached from home",
                         "open a way that is wide enough or move it"});
  }

 private:
  const robot::Museum& museum_;
  std::vector<Problem>& problems_;
  std::string file_;
  double turning_radius_;
  robot::Mask room_to_turn_, reached_;
};

// Drawings that lie beside the map: a sign that map and texts do not belong together.
void check_drawings(Site& site, const std::string& file) {
  const auto& museum = site.museum;
  const auto on_map = [&](robot::Point p, int line, const std::string& what) {
    if (museum.map.contains(p)) return;
    site.problems.push_back(
        {file, line, what + " at " + at(p) + " is off the map", "check the map's origin and the place"});
  };
  const auto all_on_map = [&](const robot::Polygon& polygon, int line, const std::string& what) {
    for (const auto& corner : polygon) on_map(corner, line, what);
  };
  for (std::size_t i = 0; i < museum.hazards.size(); ++i) {
    all_on_map(museum.hazards[i].polygon, site.lines.hazards[i], "hazard \"" + museum.hazards[i].id + "\"");
  }
  for (std::size_t i = 0; i < museum.exhibits.size(); ++i) {
    all_on_map(museum.exhibits[i].outline, site.lines.exhibits[i], "outline of \"" + museum.exhibits[i].id + "\"");
  }
  for (std::size_t i = 0; i < museum.cameras.size(); ++i) {
    on_map(museum.cameras[i].pose.position(), site.lines.cameras[i], "camera \"" + museum.cameras[i].id + "\"");
  }
  for (std::size_t i = 0; i < museum.areas.size(); ++i) {
    on_map(museum.areas[i].label, site.lines.areas[i], "label of an area");
  }
}

}  // namespace

void check_places(Site& site, const std::string& file, const robot::Footprint& footprint) {
  const auto& museum = site.museum;
  if (museum.map.empty()) return;
  check_drawings(site, file);
  PlaceCheck place(site, file, footprint);
  const bool home_is_sound = place.check(museum.home.position(), site.lines.home, "home");
  for (std::size_t e = 0; e < museum.exhibits.size(); ++e) {
    for (std::size_t v = 0; v < museum.exhibits[e].viewpoints.size(); ++v) {
      const auto p = museum.exhibits[e].viewpoints[v].pose.position();
      const int line = site.lines.viewpoints[e][v];
      const std::string what = "viewpoint " + std::to_string(v) + " of \"" + museum.exhibits[e].id + "\"";
      if (place.check(p, line, what) && home_is_sound) place.check_reached(p, line, what);
    }
  }
}

}  // namespace files
