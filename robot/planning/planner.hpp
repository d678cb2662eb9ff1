// The motion planner: a value function towards one goal, over the map with everything that is temporarily in the way,
// kept right while the map changes; paths from anywhere; and travel distances for the order of visits.
#pragma once

#include <optional>
#include <vector>

#include "robot/body.hpp"
#include "robot/mapping/obstacle_layers.hpp"
#include "robot/museum.hpp"
#include "robot/planning/cost_map.hpp"
#include "robot/planning/value_function.hpp"

namespace robot {

// What can be said of a place as a goal, whatever the way to it.
enum class PlaceKind { traversable, off_the_map, inside_obstacle, in_hazard, too_tight };

class Planner {
 public:
  Planner(const Museum& museum, const Footprint& footprint, const CostMapConfig& config = {});

  // Can the robot stand there (map frame, m)? Points that are not finite are off the map.
  PlaceKind place(Point point) const;
  // The nearest place where the robot can stand, by ways over the floor, at most `reach` metres away.
  std::optional<Point> nearest_traversable(Point point, double reach = 0.5) const;

  // Starts planning towards a goal; one that is too tight is replaced by the nearest place within 0.5 m. False, and no
  // goal, when there is none.
  bool set_goal(Point goal);
  void clear_goal();
  // The goal as planned for.
  std::optional<Point> goal() const { return goal_; }

  // Takes over what the layers saw change since the last call. Costs little when nothing did.
  void update(ObstacleLayers& layers);
  // Advances by up to `cells` cells (about 20 ns each); true when there is nothing left to plan.
  bool work(int cells);

  // Travel to the goal in metres of open floor: metres, each counted dearer where it is tight or crowded. Infinite
  // without a goal, and for places that cannot reach it or that the wave has not reached yet (see ready()).
  double value_at(Point from) const;
  // True when value_at(from) is final for the costs as they are: a number, or infinite because there is no way.
  bool ready(Point from) const;
  // The way to the goal in the map frame, starting at `from`; empty when there is none (yet). A robot that stands in a
  // place where it could not be planned to (too tight, or inside a hazard) is led out by the shortest way.
  std::vector<Point> path_from(Point from) const;
  // The part of the way's cost that is due to temporary obstacles, as metres of open floor: large means crowded.
  double crowding_from(Point from) const;

  // Metres of travel between all pairs of points over the static map, symmetric; infinite where there is no way.
  std::vector<std::vector<double>> travel_distances(const std::vector<Point>& points) const;
  // The same from one point to others.
  std::vector<double> travel_from(Point from, const std::vector<Point>& to) const;

  const CostMap& costs() const { return costs_; }
  const ValueFunction& values() const { return values_; }

 private:
  std::optional<Cell> way_out(Point from, double reach) const;

  CostMap costs_;
  OccupancyGrid map_;
  CostGrid coarse_;  // static costs at 4 times the cell size, for travel_distances
  ValueFunction values_;
  std::optional<Point> goal_;
};

}  // namespace robot
