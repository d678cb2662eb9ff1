#include "robot/perception/people.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "robot/geometry/polygon.hpp"

namespace robot {
namespace {

constexpr double first_speed = 1.0;   // m/s, one standard deviation of somebody just seen
constexpr double fastest = 2.0;       // m/s; faster is a mistaken match
constexpr double close_range = 3.0;   // m within which a person meets several beams
constexpr double pass_margin = 0.35;  // m by which beams must pass a track that has gone
constexpr double sure_motion = 1.5;   // standard deviations above which a velocity is told

struct Cluster {
  std::vector<Point> ends;  // laser frame
  double range_sum = 0.0;   // m
};

// Beams in order that end near one of the last few ends of a cluster: two legs, and what shows between them.
std::vector<Cluster> clusters_of(const ScanView& scan, const PeopleConfig& config) {
  std::vector<Cluster> clusters;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range = scan.ranges[i];
    if (scan.kinds[i] != BeamKind::person || !(range > 0.0) || !(range <= config.max_range)) continue;
    const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_step;
    const Point end{range * std::cos(angle), range * std::sin(angle)};
    const double gap = std::max(config.gap, 3.0 * range * scan.angle_step);
    const auto joins = [&](const Cluster& c) { return distance(c.ends.back(), end) <= gap; };
    // Somebody nearer may stand between the legs of somebody behind.
    auto cluster = std::find_if(clusters.rbegin(), clusters.rend(), joins);
    if (cluster == clusters.rend()) {
      clusters.emplace_back();
      cluster = clusters.rbegin();
    }
    cluster->ends.push_back(end);
    cluster->range_sum += range;
  }
  return clusters;
}

// Whether the beams on both sides of a place in the laser's sight fly past it.
bool seen_through(const ScanView& scan, Point in_laser) {
  const double beam = (std::atan2(in_laser.y, in_laser.x) - scan.angle_min) / scan.angle_step;
  if (!(beam >= 1.0) || !(beam + 2.0 < static_cast<double>(scan.ranges.size()))) return false;
  const auto i = static_cast<std::size_t>(beam);
  const double needed = norm(in_laser) + pass_margin;
  return scan.ranges[i] > needed && scan.ranges[i + 1] > needed;  // false for NaN
}

}  // namespace

std::vector<PersonBody> find_bodies(const ScanView& scan, const PeopleConfig& config) {
  std::vector<PersonBody> bodies;
  if (scan.kinds.size() != scan.ranges.size() || !is_finite(scan.map_from_laser)) return bodies;
  for (const Cluster& cluster : clusters_of(scan, config)) {
    const int beams = static_cast<int>(cluster.ends.size());
    const double range = cluster.range_sum / beams;
    if (beams < config.min_beams && range < close_range) continue;
    // Wider than one body: several people side by side share it evenly.
    const double width = distance(cluster.ends.front(), cluster.ends.back());
    const int people = std::min(beams, 1 + static_cast<int>(width / config.max_width));
    for (int k = 0; k < people; ++k) {
      const int from = beams * k / people, to = beams * (k + 1) / people;
      Point sum;
      for (int i = from; i < to; ++i) sum = sum + cluster.ends[static_cast<std::size_t>(i)];
      const Point near_side = (1.0 / (to - from)) * sum;
      const Point center = ((norm(near_side) + config.leg_radius) / norm(near_side)) * near_side;
      bodies.push_back({scan.map_from_laser * center, to - from});
    }
  }
  return bodies;
}

// Constant velocity with random acceleration; x and y are alike and independent.
void PeopleTracker::predict(Track& track, Time to) const {
  const double dt = std::max(0.0, Seconds(to - track.time).count());
  const double q = config_.acceleration * config_.acceleration;
  track.position = track.position + dt * track.velocity;
  track.var_position += dt * (2.0 * track.var_cross + dt * track.var_velocity) + 0.25 * q * dt * dt * dt * dt;
  track.var_cross += dt * track.var_velocity + 0.5 * q * dt * dt * dt;
  track.var_velocity += q * dt * dt;
  track.time = std::max(track.time, to);
}

void PeopleTracker::correct(Track& track, Point measured) const {
  const double noise = config_.position_noise * config_.position_noise, total = track.var_position + noise;
  const double gain = track.var_position / total, gain_velocity = track.var_cross / total;
  const Point off = measured - track.position;
  track.position = track.position + gain * off;
  track.velocity = track.velocity + gain_velocity * off;
  const double speed = norm(track.velocity);
  if (speed > fastest) track.velocity = (fastest / speed) * track.velocity;
  track.var_velocity -= gain_velocity * track.var_cross;
  track.var_cross *= 1.0 - gain;
  track.var_position *= 1.0 - gain;
}

void PeopleTracker::add(const ScanView& scan) {
  for (Track& track : tracks_) predict(track, scan.time);
  const std::vector<PersonBody> bodies = find_bodies(scan, config_);
  match(bodies, scan.time);
  drop_gone(scan);
}

// Nearest pairs first, each track and body once; bodies that are left begin tracks.
void PeopleTracker::match(const std::vector<PersonBody>& bodies, Time time) {
  struct Pair {
    double away;
    std::size_t track, body;
  };
  std::vector<Pair> pairs;
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const double away = distance(tracks_[t].position, bodies[b].position);
      if (away <= config_.gate) pairs.push_back({away, t, b});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.away < b.away; });
  std::vector<bool> track_taken(tracks_.size()), body_taken(bodies.size());
  for (const Pair& pair : pairs) {
    if (track_taken[pair.track] || body_taken[pair.body]) continue;
    track_taken[pair.track] = body_taken[pair.body] = true;
    Track& track = tracks_[pair.track];
    correct(track, bodies[pair.body].position);
    track.seen = time;
    ++track.sightings;
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (body_taken[b] || tracks_.size() >= config_.most_people) continue;
    Track track{next_id_++, time, time, bodies[b].position, {}, 0.0, 0.0, 0.0, 1};
    track.var_position = config_.position_noise * config_.position_noise;
    track.var_velocity = first_speed * first_speed;
    tracks_.push_back(track);
  }
}

// Tracks that nobody has seen for long, that beams fly through, or that follow the same person as an older one.
void PeopleTracker::drop_gone(const ScanView& scan) {
  const Pose laser_from_map = inverse(scan.map_from_laser);
  std::vector<Track> kept;
  for (const Track& track : tracks_) {
    const Seconds unseen = scan.time - track.seen;
    if (unseen > config_.lost_after) continue;
    if (unseen > config_.gone_after && seen_through(scan, laser_from_map * track.position)) continue;
    const auto same = [&](const Track& older) {
      return distance(older.position, track.position) < config_.same_person;
    };
    if (std::any_of(kept.begin(), kept.end(), same)) continue;
    kept.push_back(track);
  }
  tracks_ = std::move(kept);
}

People PeopleTracker::people(Time now) const {
  People people{now, {}};
  for (const Track& track : tracks_) {
    if (track.sightings < config_.confirm_after || now - track.seen > config_.lost_after) continue;
    const double dt = std::clamp(Seconds(now - track.time).count(), 0.0, config_.lost_after.count());
    const bool sure = norm(track.velocity) > sure_motion * std::sqrt(track.var_velocity);
    const Point velocity = sure ? track.velocity : Point{};
    people.people.push_back({track.position + dt * velocity, velocity, track.id});
  }
  return people;
}

int people_within(const People& people, Point center, double radius) {
  return static_cast<int>(std::count_if(people.people.begin(), people.people.end(), [&](const PersonSeen& person) {
    return distance(person.position, center) <= radius;
  }));
}

int people_on_path(const People& people, const std::vector<Point>& path, double ahead, double half_width) {
  const auto blocks = [&](const PersonSeen& person) {
    double along = 0.0;
    for (std::size_t i = 0; i + 1 < path.size() && along < ahead; ++i) {
      const double length = distance(path[i], path[i + 1]);
      const double share = length > 0.0 ? std::min(1.0, (ahead - along) / length) : 1.0;
      const Point end = path[i] + share * (path[i + 1] - path[i]);
      if (distance_to_segment(person.position, path[i], end) <= half_width) return true;
      along += length;
    }
    return false;
  };
  return static_cast<int>(std::count_if(people.people.begin(), people.people.end(), blocks));
}

}  // namespace robot
