#include "robot/simulation/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "robot/geometry/polygon.hpp"
#include "robot/simulation/walls.hpp"

namespace robot::simulation {
namespace {

constexpr double plinth_height = 0.28, plinth_rim = 0.16;  // m
constexpr double furniture_height = 0.95;

// Iron red, brass, teal, steel, plum, moss, terracotta, slate: strong, none of them a wall's or the floor's.
constexpr std::array palette{hex(0xA3473B), hex(0xC28F3C), hex(0x2F7A74), hex(0x4F6FA0),
                             hex(0x7B4F86), hex(0x6F8A3F), hex(0xC46A43), hex(0x52616B)};

// Cells of one polygon, by their centres.
template <typename Visit>
void each_cell(const Grid<SceneCell>& cells, const Polygon& polygon, Visit&& visit) {
  if (polygon.size() < 3) return;
  Point low = polygon.front(), high = low;
  for (const Point p : polygon) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const double r = cells.resolution();
  for (double y = low.y; y <= high.y + r; y += r) {
    for (double x = low.x; x <= high.x + r; x += r) {
      const Cell cell = cells.cell({x, y});
      if (cells.contains(cell) && contains(polygon, cells.center(cell))) visit(cell);
    }
  }
}

Point middle_of(const Polygon& polygon) {
  Point middle;
  for (const Point p : polygon) middle = middle + (1.0 / static_cast<double>(polygon.size())) * p;
  return middle;
}

struct Island {
  int left, low, right, high;  // cells
};

// Connected walls (4-neighbours), as boxes; label 0 is no wall.
std::vector<Island> islands(const OccupancyGrid& map, Grid<int>& label) {
  std::vector<Island> found;
  std::vector<Cell> open;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (!is_occupied(map.cells()[i]) || label.cells()[i] != 0) continue;
    const Cell seed = map.cell_at(i);
    Island island{seed.x, seed.y, seed.x, seed.y};
    const int id = static_cast<int>(found.size()) + 1;
    label[seed] = id;
    open.assign(1, seed);
    while (!open.empty()) {
      const Cell c = open.back();
      open.pop_back();
      island = {std::min(island.left, c.x), std::min(island.low, c.y), std::max(island.right, c.x),
                std::max(island.high, c.y)};
      for (const Cell next : {Cell{c.x + 1, c.y}, Cell{c.x - 1, c.y}, Cell{c.x, c.y + 1}, Cell{c.x, c.y - 1}}) {
        if (!map.contains(next) || !is_occupied(map[next]) || label[next] != 0) continue;
        label[next] = id;
        open.push_back(next);
      }
    }
    found.push_back(island);
  }
  return found;
}

// Walls, columns and furniture, told apart by the size of the island they belong to.
void raise_walls(const OccupancyGrid& map, double ceiling, Grid<SceneCell>& cells) {
  Grid<int> label(map.width(), map.height(), map.resolution(), map.origin(), 0);
  const std::vector<Island> found = islands(map, label);
  Cell low{map.width(), map.height()}, high{0, 0};
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (!is_free(map.cells()[i])) continue;
    const Cell c = map.cell_at(i);
    low = {std::min(low.x, c.x), std::min(low.y, c.y)};
    high = {std::max(high.x, c.x), std::max(high.y, c.y)};
  }
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (label.cells()[i] == 0) continue;
    const Island& island = found[static_cast<std::size_t>(label.cells()[i]) - 1];
    const double wide = (island.right - island.left + 1) * map.resolution();
    const double deep = (island.high - island.low + 1) * map.resolution();
    SceneCell& cell = cells.cells()[i];
    cell.height = static_cast<float>(ceiling);
    const Cell c = map.cell_at(i);
    const bool rim = c.x <= low.x + 1 || c.y <= low.y + 1 || c.x >= high.x - 1 || c.y >= high.y - 1;
    if (std::max(wide, deep) <= 1.05) {
      cell.material = Material::column;
    } else if (std::max(wide, deep) < 4.0 && std::min(wide, deep) > 0.35) {
      cell.material = Material::furniture;
      cell.height = static_cast<float>(furniture_height);
    } else {
      cell.material = rim ? Material::outer_wall : Material::wall;
    }
  }
}

SceneExhibit describe(const Exhibit& exhibit) {
  SceneExhibit made;
  made.number = exhibit.number;
  made.center = middle_of(exhibit.outline);
  made.radius = 10.0;
  for (std::size_t i = 0; i < exhibit.outline.size(); ++i) {
    const Point a = exhibit.outline[i], b = exhibit.outline[(i + 1) % exhibit.outline.size()];
    made.radius = std::min(made.radius, distance_to_segment(made.center, a, b));
  }
  const auto dice = static_cast<unsigned>(exhibit.number);
  made.height = 0.75 + 0.13 * (dice * 7 % 5);
  made.color = palette[dice % palette.size()];
  made.ornament = static_cast<Ornament>(dice % 4);
  return made;
}

// Drawn walls spill over outlines by a cell or two: that is the plinth's edge and no furniture.
void adopt_rim(const OccupancyGrid& map, const Polygon& outline, std::size_t exhibit, Grid<SceneCell>& cells) {
  constexpr double spill = 0.12;  // m
  const Point middle = middle_of(outline);
  Polygon grown;
  for (const Point p : outline) {
    const Point out = p - middle;
    grown.push_back(p + (2.0 * spill / std::max(0.1, norm(out))) * out);
  }
  each_cell(cells, grown, [&](Cell c) {
    SceneCell& cell = cells[c];
    if (!is_occupied(map[c]) || distance_to_edge(outline, cells.center(c)) > spill) return;
    if (cell.material != Material::furniture && cell.material != Material::column) return;
    cell.material = Material::plinth;
    cell.height = static_cast<float>(plinth_height);
    cell.exhibit = static_cast<std::uint8_t>(std::min<std::size_t>(255, exhibit));
  });
}

void raise_exhibits(const Museum& museum, Scene& scene) {
  for (std::size_t e = 0; e < museum.exhibits.size(); ++e) {
    const Exhibit& exhibit = museum.exhibits[e];
    if (exhibit.outline.size() < 3) continue;
    SceneExhibit made = describe(exhibit);
    int inside = 0, solid = 0;
    each_cell(scene.cells, exhibit.outline, [&](Cell c) {
      ++inside;
      solid += is_occupied(museum.map.at_or(c, free_cell));
    });
    const bool kept = std::ranges::any_of(museum.hazards, [&](const Hazard& hazard) {
      return hazard.kind != HazardKind::keep_out && contains(hazard.polygon, made.center);
    });
    if (solid * 20 < inside && !kept) {  // nothing stands there: it hangs from the ceiling
      made.ornament = Ornament::hanging;
      made.height = 2.9;
      scene.exhibits.push_back(made);
      continue;
    }
    const double rim = std::min(plinth_rim, 0.4 * made.radius);
    adopt_rim(museum.map, exhibit.outline, scene.exhibits.size(), scene.cells);
    each_cell(scene.cells, exhibit.outline, [&](Cell c) {
      const bool body = distance_to_edge(exhibit.outline, scene.cells.center(c)) > rim;
      SceneCell& cell = scene.cells[c];
      cell.material = body ? Material::exhibit : Material::plinth;
      cell.height = static_cast<float>(body ? made.height : plinth_height);
      cell.exhibit = static_cast<std::uint8_t>(std::min<std::size_t>(255, scene.exhibits.size()));
    });
    scene.exhibits.push_back(made);
  }
}

void lay_hazards(const Museum& museum, Grid<SceneCell>& cells) {
  for (const auto& hazard : museum.hazards) {
    each_cell(cells, hazard.polygon, [&](Cell c) {
      SceneCell& cell = cells[c];
      if (hazard.kind == HazardKind::glass) cell.glass = true;
      if (cell.height > 0.0f) return;
      if (hazard.kind == HazardKind::staircase || hazard.kind == HazardKind::escalator) cell.material = Material::steps;
      if (hazard.kind == HazardKind::low_obstacle) cell.material = Material::plate, cell.height = 0.06f;
    });
  }
}

// Outward directions of the sides, from where the lower cells round about lie.
void find_normals(Grid<SceneCell>& cells) {
  for (int y = 0; y < cells.height(); ++y) {
    for (int x = 0; x < cells.width(); ++x) {
      SceneCell& cell = cells[{x, y}];
      if (cell.height <= 0.0f) continue;
      double nx = 0.0, ny = 0.0;
      for (int dy = -3; dy <= 3; ++dy) {
        for (int dx = -3; dx <= 3; ++dx) {
          if ((dx == 0 && dy == 0) || !cells.contains(Cell{x + dx, y + dy})) continue;
          if (cells[{x + dx, y + dy}].height >= cell.height) continue;
          const double d = std::hypot(dx, dy);
          nx += dx / (d * d), ny += dy / (d * d);
        }
      }
      const double length = std::hypot(nx, ny);
      if (length < 1e-6) continue;
      cell.normal_x = static_cast<std::int8_t>(std::lround(100.0 * nx / length));
      cell.normal_y = static_cast<std::int8_t>(std::lround(100.0 * ny / length));
    }
  }
}

}  // namespace

Scene::Scene(const Museum& museum)
    : cells(museum.map.width(), museum.map.height(), museum.map.resolution(), museum.map.origin()) {
  for (const auto& camera : museum.cameras) ceiling = std::max(ceiling, camera.height + 1.0);
  raise_walls(museum.map, ceiling, cells);
  raise_exhibits(museum, *this);
  lay_hazards(museum, cells);
  find_normals(cells);
  Mask objects(cells.width(), cells.height(), cells.resolution(), cells.origin(), 0);
  Mask raised = objects;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const SceneCell& cell = cells.cells()[i];
    raised.cells()[i] = cell.height > 0.1f ? 1 : 0;
    objects.cells()[i] = cell.height > 0.0f || cell.glass || cell.material != Material::floor ? 1 : 0;
  }
  free_way = distance_to(objects);
  const DistanceField corner = distance_to(raised);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double shade = 0.34 * std::exp(-corner.cells()[i] / 0.28);
    cells.cells()[i].light = static_cast<std::uint8_t>(255.0 * (1.0 - shade));
  }
}

}  // namespace robot::simulation
