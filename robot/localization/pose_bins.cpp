#include "robot/localization/pose_bins.hpp"

#include <algorithm>
#include <cmath>

namespace robot {

PoseBins::PoseBins(double metres, double radians)
    : metres_(metres), around_(std::max(1, static_cast<int>(std::lround(2.0 * pi / radians)))), slots_(1024, 0) {}

std::uint64_t PoseBins::hash(const Box& box) {
  std::uint64_t h = static_cast<std::uint32_t>(box.x) * 0x9E3779B97F4A7C15ull;
  h = (h ^ (h >> 29) ^ static_cast<std::uint32_t>(box.y)) * 0xBF58476D1CE4E5B9ull;
  h = (h ^ (h >> 29) ^ static_cast<std::uint32_t>(box.theta)) * 0x94D049BB133111EBull;
  return h ^ (h >> 32);
}

std::size_t PoseBins::slot_of(const Box& box) const {
  std::size_t slot = hash(box) & (slots_.size() - 1);
  while (slots_[slot] != 0 && boxes_[static_cast<std::size_t>(slots_[slot] - 1)] != box) {
    slot = (slot + 1) & (slots_.size() - 1);
  }
  return slot;
}

int PoseBins::find(const Box& box) const { return slots_[slot_of(box)] - 1; }

int PoseBins::add(const Pose& pose) {
  const int theta = static_cast<int>(std::floor((wrap_angle(pose.theta) + pi) / (2.0 * pi) * around_)) % around_;
  const auto box_of = [&](double v) {
    return static_cast<std::int32_t>(std::clamp(std::floor(v / metres_), -1e9, 1e9));
  };
  const Box box{box_of(pose.x), box_of(pose.y), theta};
  const std::size_t slot = slot_of(box);
  if (slots_[slot] != 0) return slots_[slot] - 1;
  boxes_.push_back(box);
  slots_[slot] = size();
  if (boxes_.size() * 2 > slots_.size()) grow();
  return size() - 1;
}

void PoseBins::grow() {
  slots_.assign(slots_.size() * 4, 0);
  for (std::size_t i = 0; i < boxes_.size(); ++i) slots_[slot_of(boxes_[i])] = static_cast<std::int32_t>(i + 1);
}

void PoseBins::clear() {
  boxes_.clear();
  std::fill(slots_.begin(), slots_.end(), 0);
}

std::vector<int> PoseBins::groups() const {
  std::vector<int> group(boxes_.size(), -1);
  std::vector<int> open;
  int next = 0;
  for (std::size_t first = 0; first < boxes_.size(); ++first) {
    if (group[first] >= 0) continue;
    group[first] = next;
    open.assign(1, static_cast<int>(first));
    while (!open.empty()) {
      const Box box = boxes_[static_cast<std::size_t>(open.back())];
      open.pop_back();
      for (int k = 0; k < 27; ++k) {
        const int i = find({box.x + k % 3 - 1, box.y + k / 3 % 3 - 1, (box.theta + k / 9 - 1 + around_) % around_});
        if (i < 0 || group[static_cast<std::size_t>(i)] >= 0) continue;
        group[static_cast<std::size_t>(i)] = next;
        open.push_back(i);
      }
    }
    ++next;
  }
  return group;
}

}  // namespace robot
