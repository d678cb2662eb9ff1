// People's ways through the museum: where they can walk, and which direction leads to an exhibit or to the entrance.
// One distance field per destination (Dijkstra over a coarse grid), made once.
#pragma once

#include <optional>
#include <vector>

#include "robot/geometry/grid.hpp"
#include "robot/geometry/random.hpp"
#include "robot/museum.hpp"
#include "robot/simulation/walls.hpp"

namespace robot::simulation {

// The map as people walk it: glass, plates and stairs are as solid as walls, and so is the unknown.
OccupancyGrid walkable_map(const Museum& museum);

class Routes {
 public:
  // `walls` must be those of walkable_map(museum).
  Routes(const Museum& museum, const Walls& walls);

  // Destinations are the museum's exhibits in their order, then the entrance.
  int exhibits() const { return exhibits_; }
  int entrance() const { return exhibits_; }
  bool passable(Point p) const;
  // Metres of way to the destination, penalties for narrow places included; infinite where it cannot be reached.
  double way(int destination, Point p) const;
  // Unit vector along the shortest way; zero at the destination or where there is no way.
  Point direction(int destination, Point p) const;
  // A free place from which to look at the exhibit, or one at the entrance.
  Point spot(int destination, Random& random) const;
  // A place anywhere that people can reach.
  Point anywhere(Random& random) const;

 private:
  Grid<float> field(const std::vector<Cell>& sources) const;

  Grid<float> cost_;  // per metre; infinite: cannot be walked
  std::vector<Grid<float>> ways_;
  std::vector<std::vector<Point>> spots_;  // a destination
  int exhibits_ = 0;
};

}  // namespace robot::simulation
