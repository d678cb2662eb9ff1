// Travel in metres between the places that people ask for, computed once and kept: all exhibits among each other, and
// places picked on the map as they come.
#pragma once

#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "robot/inputs.hpp"
#include "robot/museum.hpp"
#include "robot/planning/planner.hpp"

namespace robot {

class TravelTable {
 public:
  // The museum and the planner must outlive the table.
  TravelTable(const Museum& museum, const Planner& planner);

  // Infinite where there is no way, and for exhibits that do not exist.
  double between(const Target& from, const Target& to);

 private:
  struct Row {
    Point from;
    std::vector<double> to_exhibits;
  };
  const Row& row(Point from);

  const Museum* museum_;
  const Planner* planner_;
  std::vector<Point> exhibits_;               // one standing place each
  std::map<std::string, std::size_t> index_;  // by exhibit id
  std::vector<std::vector<double>> among_exhibits_;
  std::deque<Row> rows_;  // of places on the map, newest last
};

}  // namespace robot
