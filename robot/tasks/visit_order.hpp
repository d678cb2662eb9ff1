// The order of visits with the least travel from here: an open path through all stops (RHINO 4.3; MINERVA 5.4).
#pragma once

#include <functional>
#include <vector>

namespace robot {

// Travel between two stops, metres; symmetric, infinite where there is no way. Index 0 is "here".
using TravelCost = std::function<double(int from, int to)>;

// Order in which to visit stops 1..count. Exact by dynamic programming over subsets up to `exact_limit` stops, beyond
// it nearest neighbour improved by 2-opt. Unreachable stops come last, in their given order.
std::vector<int> visit_order(int count, const TravelCost& cost);

inline constexpr int exact_visit_limit = 12;

}  // namespace robot
