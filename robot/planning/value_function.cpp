#include "robot/planning/value_function.hpp"

#include <algorithm>

namespace robot {
namespace {

// East, north, west, south, then the diagonals; the opposite of direction d is opposite(d).
constexpr int step_x[8] = {1, 0, -1, 0, 1, -1, -1, 1};
constexpr int step_y[8] = {0, 1, 0, -1, 1, 1, -1, -1};
constexpr std::uint8_t no_parent = 8;

constexpr int opposite(int d) { return d < 4 ? (d + 2) % 4 : 4 + (d + 2) % 4; }
constexpr std::uint32_t step(int d) { return d < 4 ? ValueFunction::straight_step : ValueFunction::diagonal_step; }
// As wide as the shortest edge: no cell of a bucket can improve another one of the same bucket.
constexpr std::uint32_t bucket_of(std::uint32_t value) { return value / ValueFunction::straight_step; }

}  // namespace

ValueFunction::ValueFunction(const CostGrid& costs)
    : width_(costs.width()), height_(costs.height()), stride_(static_cast<Index>(costs.width()) + 2) {
  const auto size = static_cast<std::size_t>(stride_) * (static_cast<std::size_t>(height_) + 2);
  costs_.assign(size, 0);
  values_.assign(size, 0);
  parents_.assign(size, no_parent);
  for (int d = 0; d < 8; ++d) offset_[d] = static_cast<Index>(step_y[d]) * stride_ + static_cast<Index>(step_x[d]);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const Cell c{x, y};
      costs_[index(c)] = std::min<std::uint8_t>(costs[c], max_cost);
      values_[index(c)] = costs[c] ? unreached : 0;
    }
  }
}

void ValueFunction::set_goal(Cell goal) {
  for (auto& bucket : buckets_) bucket.clear();
  queued_ = 0;
  seeds_.clear();
  for (std::size_t i = 0; i < values_.size(); ++i) values_[i] = costs_[i] ? unreached : 0;
  std::fill(parents_.begin(), parents_.end(), no_parent);
  current_ = 0;
  goal_ = inside(goal) ? index(goal) : 0;
  if (costs_.empty() || costs_[goal_] == 0) return;
  values_[goal_] = 0;
  push(goal_, 0);
}

void ValueFunction::push(Index cell, std::uint32_t value) {
  buckets_[bucket_of(value) % bucket_count].push_back(cell);
  ++queued_;
}

void ValueFunction::expand(Index cell) {
  const std::uint32_t value = values_[cell];
  for (int d = 0; d < 8; ++d) {
    const Index next = cell + offset_[d];
    const std::uint32_t candidate = value + step(d) * costs_[next];
    if (candidate >= values_[next]) continue;
    values_[next] = candidate;
    parents_[next] = static_cast<std::uint8_t>(opposite(d));
    push(next, candidate);
  }
}

// Seeds whose turn has come join the wave.
void ValueFunction::admit_seeds() {
  while (!seeds_.empty() && bucket_of(seeds_.back().value) <= current_) {
    const Seed seed = seeds_.back();
    seeds_.pop_back();
    if (values_[seed.cell] == seed.value) push(seed.cell, seed.value);
  }
}

bool ValueFunction::work(int cells) {
  while (cells > 0 && !finished()) {
    if (queued_ == 0) current_ = bucket_of(seeds_.back().value);
    admit_seeds();
    auto& bucket = buckets_[current_ % bucket_count];
    while (!bucket.empty() && cells > 0) {
      const Index cell = bucket.back();
      bucket.pop_back();
      --queued_;
      if (bucket_of(values_[cell]) != current_ || costs_[cell] == 0) continue;  // improved or blocked since
      expand(cell);
      --cells;
    }
    if (bucket.empty()) ++current_;
  }
  return finished();
}

void ValueFunction::finish() {
  while (!work(1 << 20)) {
  }
}

// Resets a cell and all cells whose best way leads through it.
void ValueFunction::invalidate_from(Index cell, std::vector<Index>& reset) {
  const std::size_t first = reset.size();
  const auto take = [&](Index i) {
    values_[i] = costs_[i] ? unreached : 0;
    parents_[i] = no_parent;
    reset.push_back(i);
  };
  take(cell);
  for (std::size_t i = first; i < reset.size(); ++i) {
    for (int d = 0; d < 8; ++d) {
      const Index next = reset[i] + offset_[d];
      if (parents_[next] == opposite(d)) take(next);
    }
  }
}

// Takes the best that the neighbours offer.
void ValueFunction::refill(Index cell) {
  if (costs_[cell] == 0 || cell == goal_) return;
  for (int d = 0; d < 8; ++d) {
    const Index next = cell + offset_[d];
    if (costs_[next] == 0 || values_[next] == unreached) continue;
    const std::uint32_t candidate = values_[next] + step(d) * costs_[cell];
    if (candidate >= values_[cell]) continue;
    values_[cell] = candidate;
    parents_[cell] = static_cast<std::uint8_t>(d);
  }
  if (values_[cell] != unreached) seeds_.push_back({values_[cell], cell});
}

// What the running wave still has before it goes back among the seeds, so that a wave may start at smaller values.
void ValueFunction::collect_queue() {
  for (auto& bucket : buckets_) {
    for (const Index cell : bucket) {
      if (costs_[cell] != 0 && values_[cell] != unreached) seeds_.push_back({values_[cell], cell});
    }
    bucket.clear();
  }
  queued_ = 0;
}

void ValueFunction::change(std::span<const CostChange> changes) {
  std::vector<Index> risen, fallen;
  for (const auto& [cell, wanted] : changes) {
    if (!inside(cell)) continue;
    const Index i = index(cell);
    const std::uint8_t cost = std::min<std::uint8_t>(wanted, max_cost), old = costs_[i];
    if (cost == old) continue;
    costs_[i] = cost;
    const bool rises = cost == 0 || (old != 0 && cost > old);
    if (i == goal_ && old != 0 && cost != 0) continue;  // nobody leaves the goal
    (rises ? risen : fallen).push_back(i);
  }
  if (risen.empty() && fallen.empty()) return;
  std::vector<Index> reset;
  for (const Index i : risen) invalidate_from(i, reset);
  for (const Index i : fallen) {
    if (costs_[i] != 0 && values_[i] == 0 && i != goal_) values_[i] = unreached;  // it was blocked
  }
  collect_queue();
  for (const Index i : reset) refill(i);
  for (const Index i : fallen) {
    if (costs_[i] == 0) continue;
    if (i == goal_) {
      values_[i] = 0;
      seeds_.push_back({0, i});
    } else {
      refill(i);
    }
  }
  std::sort(seeds_.begin(), seeds_.end(),
            [](const Seed& a, const Seed& b) { return a.value != b.value ? a.value > b.value : a.cell > b.cell; });
  if (!seeds_.empty()) current_ = bucket_of(seeds_.back().value);
}

std::uint32_t ValueFunction::value(Cell cell) const {
  if (!inside(cell)) return unreached;
  const Index i = index(cell);
  return costs_[i] ? values_[i] : unreached;
}

bool ValueFunction::settled(Cell cell) const {
  if (finished() || !inside(cell) || costs_[index(cell)] == 0) return true;
  const std::uint32_t value = values_[index(cell)];
  return value != unreached && bucket_of(value) <= current_;
}

std::uint8_t ValueFunction::cost(Cell cell) const { return inside(cell) ? costs_[index(cell)] : std::uint8_t{0}; }

Cell ValueFunction::downhill(Cell cell) const {
  if (!inside(cell)) return cell;
  const std::uint8_t d = parents_[index(cell)];
  return d == no_parent ? cell : Cell{cell.x + step_x[d], cell.y + step_y[d]};
}

std::vector<Cell> ValueFunction::descend(Cell from) const {
  std::vector<Cell> way;
  if (value(from) == unreached) return way;
  way.push_back(from);
  for (Cell next = downhill(from); next != way.back(); next = downhill(next)) way.push_back(next);
  return way;
}

}  // namespace robot
