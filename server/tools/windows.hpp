// Stretches of a log, seconds on the logger's clock.
#pragma once

#include <limits>
#include <vector>

namespace tools {

// Its end is left out.
struct Window {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
  bool contains(double time) const { return time >= from && time < to; }
};

// Pairs up --from and --to given any number of times; missing ends are open. No window at all: everything.
// Throws std::invalid_argument.
std::vector<Window> windows_of(const std::vector<double>& from, const std::vector<double>& to);
// From the earliest beginning to the latest end.
Window hull_of(const std::vector<Window>& windows);
bool in_any(const std::vector<Window>& windows, double time);

}  // namespace tools
