#include "robot/museum.hpp"

#include <algorithm>

namespace robot {

const Exhibit* find_exhibit(const Museum& museum, const std::string& id) {
  const auto it = std::ranges::find(museum.exhibits, id, &Exhibit::id);
  return it == museum.exhibits.end() ? nullptr : &*it;
}

const Tour* find_tour(const Museum& museum, const std::string& id) {
  const auto it = std::ranges::find(museum.tours, id, &Tour::id);
  return it == museum.tours.end() ? nullptr : &*it;
}

}  // namespace robot
