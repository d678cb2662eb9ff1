// An occupancy grid from laser scans at known poses: log-odds with an inverse sensor model that clears what a beam
// passed and marks where it ended (Thrun et al., "Probabilistic Robotics", chapter 9). The grid grows as the robot sees
// more.
#pragma once

#include <cstdint>
#include <vector>

#include "robot/geometry/grid.hpp"
#include "robot/geometry/pose.hpp"
#include "robot/inputs.hpp"

namespace robot {

struct OccupancyMapperConfig {
  double resolution = 0.05;  // m a cell
  double hit = 0.70;         // probability that the cell in which a beam ended is occupied ...
  double miss = 0.42;        // ... and one that it passed
  double least = 0.03;       // bounds of certainty, so that a map can still change its mind
  double most = 0.97;
  double max_range = 40.0;     // m; ends farther away are not marked, their beams clear up to here
  double max_extent = 1000.0;  // m from the first scan; whatever lies outside is left out
};

class OccupancyMapper {
 public:
  // Throws std::invalid_argument when a probability does not lie in (0, 1) on its side of one half.
  explicit OccupancyMapper(OccupancyMapperConfig config = {});

  // Beams without a return are left out: nobody knows whether nothing or black velvet was there. Scans at poses
  // that are not finite or beyond max_extent are ignored.
  void insert(const LaserScan& scan, const Pose& map_from_laser);
  int scans() const { return scans_; }

  // Per cent, -1 where no beam has been. Empty before the first scan.
  OccupancyGrid map() const;

 private:
  struct Reach {
    double left, bottom, right, top;  // m
  };
  void make_room(const Reach& reach);
  void trace(Point from, Point to, bool ends_there);
  void touch(Cell cell, std::int16_t change);

  OccupancyMapperConfig config_;
  std::int16_t hit_ = 0, miss_ = 0, least_ = 0, most_ = 0;  // log-odds in units of 1/1000
  Point first_;
  int scans_ = 0;
  Grid<std::int16_t> log_odds_;
  // The last scan that touched the cell: each scan counts once a cell, and a hit before a miss. 0: never.
  Grid<std::int32_t> stamp_;
};

}  // namespace robot
