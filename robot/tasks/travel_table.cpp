#include "robot/tasks/travel_table.hpp"

#include <algorithm>
#include <limits>

namespace robot {
namespace {

constexpr std::size_t kept_rows = 64;
constexpr double nowhere = std::numeric_limits<double>::infinity();

}  // namespace

TravelTable::TravelTable(const Museum& museum, const Planner& planner) : museum_(&museum), planner_(&planner) {
  for (const Exhibit& exhibit : museum.exhibits) {
    if (exhibit.viewpoints.empty()) continue;
    index_.emplace(exhibit.id, exhibits_.size());
    exhibits_.push_back(exhibit.viewpoints.front().pose.position());
  }
  among_exhibits_ = planner.travel_distances(exhibits_);
}

const TravelTable::Row& TravelTable::row(Point from) {
  const auto known = std::ranges::find(rows_, from, &Row::from);
  if (known != rows_.end()) return *known;
  if (rows_.size() >= kept_rows) rows_.pop_front();
  rows_.push_back({from, planner_->travel_from(from, exhibits_)});
  return rows_.back();
}

double TravelTable::between(const Target& from, const Target& to) {
  const auto index_of = [&](const Target& target) {
    const auto* at = std::get_if<ExhibitTarget>(&target);
    const auto it = at ? index_.find(at->exhibit) : index_.end();
    return it == index_.end() ? exhibits_.size() : it->second;
  };
  const std::size_t a = index_of(from), b = index_of(to);
  const auto *p = std::get_if<PointTarget>(&from), *q = std::get_if<PointTarget>(&to);
  if ((!p && a == exhibits_.size()) || (!q && b == exhibits_.size())) return nowhere;
  if (!p && !q) return among_exhibits_[a][b];
  if (!p) return row(q->point).to_exhibits[a];
  if (!q) return row(p->point).to_exhibits[b];
  const double direct = distance(p->point, q->point);
  double around = nowhere;  // two places on the map: over the exhibit that makes the shortest way, or straight
  const std::vector<double> from_p = row(p->point).to_exhibits, from_q = row(q->point).to_exhibits;
  for (std::size_t i = 0; i < exhibits_.size(); ++i) around = std::min(around, from_p[i] + from_q[i]);
  return exhibits_.empty() ? direct : std::max(direct, around == nowhere ? nowhere : std::min(around, direct * 1.5));
}

}  // namespace robot
