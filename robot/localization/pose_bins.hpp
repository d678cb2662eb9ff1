// Boxes of poses: which of them a belief occupies (for KLD-sampling) and which hang together (for its modes).
#pragma once

#include <cstdint>
#include <vector>

#include "robot/geometry/pose.hpp"

namespace robot {

// Numbers boxes 0, 1, 2.. in the order in which poses first fall into them: the same poses give the same numbers.
class PoseBins {
 public:
  // metres: edge in x and y; radians: edge in heading, rounded so that a whole number fills the circle.
  PoseBins(double metres, double radians);

  // The number of the box that holds the pose; a new one when it is the first there.
  int add(const Pose& pose);
  int size() const { return static_cast<int>(boxes_.size()); }
  void clear();

  // For each box the number of its connected group (26-neighbourhood, heading wraps round), from 0; groups are numbered
  // in the order of their first box.
  std::vector<int> groups() const;

 private:
  struct Box {
    std::int32_t x, y, theta;
    friend bool operator==(const Box&, const Box&) = default;
  };
  static std::uint64_t hash(const Box& box);
  int find(const Box& box) const;  // -1: none
  std::size_t slot_of(const Box& box) const;
  void grow();

  double metres_;
  int around_;  // boxes in the full circle
  std::vector<Box> boxes_;
  std::vector<std::int32_t> slots_;  // open addressing: number + 1; 0: empty
};

}  // namespace robot
