#include "server/tools/windows.hpp"

#include <algorithm>
#include <stdexcept>

namespace tools {

std::vector<Window> windows_of(const std::vector<double>& from, const std::vector<double>& to) {
  std::vector<Window> windows(std::max({from.size(), to.size(), std::size_t{1}}));
  for (std::size_t i = 0; i < windows.size(); ++i) {
    if (i < from.size()) windows[i].from = from[i];
    if (i < to.size()) windows[i].to = to[i];
    if (!(windows[i].from < windows[i].to)) throw std::invalid_argument("--from must lie before its --to");
  }
  return windows;
}

Window hull_of(const std::vector<Window>& windows) {
  if (windows.empty()) return {};
  Window hull = windows.front();
  for (const auto& window : windows) hull = {std::min(hull.from, window.from), std::max(hull.to, window.to)};
  return hull;
}

bool in_any(const std::vector<Window>& windows, double time) {
  return std::any_of(windows.begin(), windows.end(), [&](const Window& w) { return w.contains(time); });
}

}  // namespace tools
