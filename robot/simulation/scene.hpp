// The museum as cameras see it: a field of heights over the map's cells with materials, made once per museum. Outer
// walls get tall windows, exhibits a plinth and a body of their own colour, glass cases stand over what they protect.
#pragma once

#include <optional>
#include <vector>

#include "robot/geometry/distance_field.hpp"
#include "robot/museum.hpp"
#include "robot/simulation/color.hpp"

namespace robot::simulation {

enum class Material : std::uint8_t { floor, wall, outer_wall, column, furniture, plinth, exhibit, plate, steps };

struct SceneCell {
  float height = 0.0f;  // m
  Material material = Material::floor;
  bool glass = false;                      // a glass case stands over this cell
  std::uint8_t exhibit = 0;                // index into exhibits
  std::int8_t normal_x = 0, normal_y = 0;  // outward, unit times 100; of the sides
  std::uint8_t light = 255;                // of the floor: corners are darker
};

enum class Ornament : std::uint8_t { flywheel, globe, chimney, propeller, hanging };

struct SceneExhibit {
  int number = 0;
  Point center;
  double radius = 0.5;  // m, of the body, seen from above
  double height = 1.4;  // m, of the body
  Color color;
  Ornament ornament = Ornament::flywheel;
};

struct Scene {
  explicit Scene(const Museum& museum);

  Grid<SceneCell> cells;
  DistanceField free_way;  // m from a cell to the nearest one that is not plain floor
  std::vector<SceneExhibit> exhibits;
  double ceiling = 5.6;  // m, as high as the walls
};

inline constexpr double glass_height = 1.7;  // m

}  // namespace robot::simulation
