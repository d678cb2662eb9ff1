// What is in the way now and not on the map: a laser layer and a sonar layer beside the static map, joined by the
// conservative rule of RHINO 3.2.3, eq. (19): a place is as occupied as the most pessimistic of its layers says.
// Hits add evidence, beams that pass take it away at once, and time takes the rest: people move on.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "robot/body.hpp"
#include "robot/geometry/grid.hpp"
#include "robot/geometry/pose.hpp"
#include "robot/inputs.hpp"
#include "robot/outputs.hpp"
#include "robot/time.hpp"

namespace robot {

struct ObstacleLayersConfig {
  Seconds half_life{10.0};     // of evidence that no sensor looks at any more
  double laser_reach = 8.0;    // m; farther hits are left to the next look
  double sonar_reach = 1.5;    // m; farther echoes are too wide to say where
  double clear_margin = 0.15;  // m; a beam must pass a cell by this much to clear it
  int laser_gain = 3;          // per cent a hit; blocked from 50 on, after 0.7 s: walkers leave no trace
  int sonar_gain = 20;         // per cent an echo that nothing known explains
};

// One layer of evidence over the map's grid, 0..100 per cent a cell, with a list of the few cells that hold any.
class EvidenceLayer {
 public:
  EvidenceLayer() = default;
  EvidenceLayer(int width, int height, double resolution, Point origin) : grid_(width, height, resolution, origin, 0) {}
  static constexpr int blocked_from = 50;  // per cent
  // Adds (or takes) evidence; remembers the cell when it becomes blocked or open by it.
  void change(Cell cell, int by);
  void scale(double factor);
  bool blocked(Cell cell) const { return grid_.at_or(cell, 0) >= blocked_from; }
  int evidence(Cell cell) const { return grid_.at_or(cell, 0); }
  const Grid<std::uint8_t>& grid() const { return grid_; }
  // Cells with any evidence, in the order in which they got it.
  const std::vector<Cell>& active() const { return active_; }
  // Sets every active cell to f(cell, evidence).
  template <typename F>
  void revise(F f);
  std::vector<Cell> take_flipped();

 private:
  void set(Cell cell, int value);
  Grid<std::uint8_t> grid_;
  std::vector<Cell> active_;   // evidence > 0
  std::vector<Cell> flipped_;  // changed between open and blocked since the last take
};

class ObstacleLayers {
 public:
  // The map is copied: it is the static layer.
  explicit ObstacleLayers(const OccupancyGrid& map, const ObstacleLayersConfig& config = {});

  // A scan as the localizer understood it: beams that met the map mark nothing, all others that returned mark and
  // clear.
  void add(const ScanView& scan);
  // Sonars see what the lasers pass over. An echo that the map or the laser explains marks nothing.
  void add(const SonarScan& scan, const Pose& map_from_base, std::span<const SonarMount> mounts);
  // Lets evidence fade. Call at any rate with non-decreasing times.
  void decay(Time now);
  // Forgets temporary obstacles, all or round a point (m).
  void forget();
  void forget_near(Point center, double radius);

  // Blocked by something that is not on the map.
  bool blocked(Cell cell) const { return laser_.blocked(cell) || sonar_.blocked(cell); }
  // All temporarily blocked cells.
  std::vector<Cell> blocked_cells() const;
  // Cells that became blocked or open since the last call, for the planner. A cell may come twice.
  std::vector<Cell> take_changes();
  // Centres of the sonar layer's blocked cells within reach (m): what motion must avoid though no laser sees it.
  std::vector<Point> sonar_obstacles_near(Point center, double reach) const;

  // Eq. (19): the static map with all layers, per cent; unknown stays unknown unless a layer says occupied.
  OccupancyGrid integrated() const;
  const OccupancyGrid& map() const { return map_; }
  const EvidenceLayer& laser() const { return laser_; }
  const EvidenceLayer& sonar() const { return sonar_; }

 private:
  bool explained(const Pose& map_from_sonar, double range, double half_angle) const;

  ObstacleLayersConfig config_;
  OccupancyGrid map_;
  EvidenceLayer laser_;
  EvidenceLayer sonar_;
  Time faded_;  // when evidence last faded
};

}  // namespace robot
