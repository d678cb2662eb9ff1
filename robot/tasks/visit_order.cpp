#include "robot/tasks/visit_order.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace robot {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// Held-Karp: best[set][last] is the least travel from here through `set`, ending at `last`.
std::vector<int> exact_order(const std::vector<int>& stops, const TravelCost& cost) {
  const std::size_t n = stops.size(), sets = std::size_t{1} << n;
  std::vector<double> best(sets * n, infinite);
  std::vector<std::int8_t> before(sets * n, -1);
  for (std::size_t i = 0; i < n; ++i) best[(std::size_t{1} << i) * n + i] = cost(0, stops[i]);
  for (std::size_t set = 1; set < sets; ++set) {
    for (std::size_t last = 0; last < n; ++last) {
      const double so_far = best[set * n + last];
      if (!(set >> last & 1) || !std::isfinite(so_far)) continue;
      for (std::size_t next = 0; next < n; ++next) {
        if (set >> next & 1) continue;
        const std::size_t bigger = set | std::size_t{1} << next;
        const double total = so_far + cost(stops[last], stops[next]);
        if (total < best[bigger * n + next]) {
          best[bigger * n + next] = total;
          before[bigger * n + next] = static_cast<std::int8_t>(last);
        }
      }
    }
  }
  std::size_t set = sets - 1, last = 0;
  for (std::size_t i = 1; i < n; ++i) {
    if (best[set * n + i] < best[set * n + last]) last = i;
  }
  std::vector<int> order(n);
  for (std::size_t i = n; i-- > 0;) {
    order[i] = stops[last];
    const auto previous = before[set * n + last];
    set &= ~(std::size_t{1} << last);
    last = previous < 0 ? 0 : static_cast<std::size_t>(previous);
  }
  return order;
}

std::vector<int> nearest_neighbour(std::vector<int> stops, const TravelCost& cost) {
  std::vector<int> order;
  int here = 0;
  while (!stops.empty()) {
    const auto next = std::ranges::min_element(stops, {}, [&](int stop) { return cost(here, stop); });
    here = *next;
    order.push_back(here);
    stops.erase(next);
  }
  return order;
}

// Reverses stretches while that shortens the open path.
void two_opt(std::vector<int>& order, const TravelCost& cost) {
  const std::size_t n = order.size();
  const auto leg = [&](std::size_t from, std::size_t to) {  // legs of the path; index 0 is here, i is order[i - 1]
    return to > n ? 0.0 : cost(from == 0 ? 0 : order[from - 1], order[to - 1]);
  };
  for (bool better = true; better;) {
    better = false;
    for (std::size_t i = 1; i < n; ++i) {
      for (std::size_t j = i + 1; j <= n; ++j) {
        const double now = leg(i - 1, i) + leg(j, j + 1);
        const int before = i == 1 ? 0 : order[i - 2];
        const double then = cost(before, order[j - 1]) + (j == n ? 0.0 : cost(order[i - 1], order[j]));
        if (then < now - 1e-9) {
          std::reverse(order.begin() + static_cast<std::ptrdiff_t>(i - 1),
                       order.begin() + static_cast<std::ptrdiff_t>(j));
          better = true;
        }
      }
    }
  }
}

}  // namespace

std::vector<int> visit_order(int count, const TravelCost& cost) {
  std::vector<int> reachable, unreachable;
  for (int stop = 1; stop <= count; ++stop) (std::isfinite(cost(0, stop)) ? reachable : unreachable).push_back(stop);
  std::vector<int> order;
  if (static_cast<int>(reachable.size()) <= exact_visit_limit) {
    if (!reachable.empty()) order = exact_order(reachable, cost);
  } else {
    order = nearest_neighbour(reachable, cost);
    two_opt(order, cost);
  }
  order.insert(order.end(), unreachable.begin(), unreachable.end());
  return order;
}

}  // namespace robot
