#include "robot/perception/people.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace robot {
namespace {

constexpr std::size_t max_tracks = 400;

// Bodies side by side: a wide cluster is cut into as many as fit.
void split_cluster(const ScanView& scan, std::size_t first, std::size_t last, const PeopleConfig& config,
                   std::vector<PersonBody>& bodies) {
  const auto end_of = [&](std::size_t i) {
    const double bearing = scan.angle_min + static_cast<double>(i) * scan.angle_step;
    return scan.map_from_laser * Point{scan.ranges[i] * std::cos(bearing), scan.ranges[i] * std::sin(bearing)};
  };
  const int beams = static_cast<int>(last - first + 1);
  double nearest = scan.ranges[first];
  for (std::size_t i = first; i <= last; ++i) nearest = std::min(nearest, static_cast<double>(scan.ranges[i]));
  if (beams < config.min_beams && nearest < 3.0) return;
  const double width = distance(end_of(first), end_of(last));
  const int parts = std::max(1, std::min(beams, static_cast<int>(std::ceil(width / config.max_width))));
  for (int part = 0; part < parts; ++part) {
    const std::size_t from = first + static_cast<std::size_t>(beams * part / parts);
    const std::size_t to = first + static_cast<std::size_t>(beams * (part + 1) / parts);
    Point sum;
    for (std::size_t i = from; i < to; ++i) sum = sum + end_of(i);
    const Point middle = (1.0 / static_cast<double>(to - from)) * sum;
    // Beams end on the near side: the body's middle lies behind it.
    const Point out = middle - scan.map_from_laser.position();
    const double far = norm(out);
    bodies.push_back(
        {far > 1e-6 ? middle + (0.5 * config.body_radius / far) * out : middle, static_cast<int>(to - from)});
  }
}

}  // namespace

std::vector<PersonBody> find_bodies(const ScanView& scan, const PeopleConfig& config) {
  std::vector<PersonBody> bodies;
  const std::size_t beams = std::min(scan.ranges.size(), scan.kinds.size());
  const auto meets_person = [&](std::size_t i) {
    return scan.kinds[i] == BeamKind::person && std::isfinite(scan.ranges[i]) && scan.ranges[i] < config.max_range;
  };
  for (std::size_t i = 0; i < beams;) {
    if (!meets_person(i)) {
      ++i;
      continue;
    }
    std::size_t last = i;
    for (std::size_t next = i + 1; next < beams && next <= last + 2; ++next) {
      if (!meets_person(next)) continue;
      const double angle = static_cast<double>(next - last) * scan.angle_step;
      const double a = scan.ranges[last], b = scan.ranges[next];
      const double apart = std::sqrt(std::max(0.0, a * a + b * b - 2.0 * a * b * std::cos(angle)));
      if (apart > config.gap + 0.02 * a) break;
      last = next;
    }
    split_cluster(scan, i, last, config, bodies);
    i = last + 1;
  }
  return bodies;
}

void PeopleTracker::predict(Track& track, Time to) const {
  const double dt = Seconds(to - track.time).count();
  if (dt <= 0.0) return;
  track.position = track.position + dt * track.velocity;
  const double q = config_.acceleration * config_.acceleration * dt;
  track.var_position += 2.0 * dt * track.var_cross + dt * dt * track.var_velocity + q * dt * dt / 3.0;
  track.var_cross += dt * track.var_velocity + q * dt / 2.0;
  track.var_velocity += q;
  track.time = to;
}

void PeopleTracker::correct(Track& track, Point measured) const {
  const double innovation = track.var_position + config_.position_noise * config_.position_noise;
  const double gain = track.var_position / innovation, gain_velocity = track.var_cross / innovation;
  const Point off = measured - track.position;
  track.position = track.position + gain * off;
  track.velocity = track.velocity + gain_velocity * off;
  if (const double speed = norm(track.velocity); speed > 2.5) track.velocity = (2.5 / speed) * track.velocity;
  track.var_velocity -= gain_velocity * track.var_cross;
  track.var_cross *= 1.0 - gain;
  track.var_position *= 1.0 - gain;
}

void PeopleTracker::add(const ScanView& scan) {
  for (Track& track : tracks_) predict(track, scan.time);
  // Nearest pairs first: each body belongs to at most one track.
  struct Pair {
    double apart;
    std::size_t track, body;
  };
  const std::vector<PersonBody> bodies = find_bodies(scan, config_);
  std::vector<Pair> pairs;
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const double apart = distance(tracks_[t].position, bodies[b].position);
      if (apart < config_.gate) pairs.push_back({apart, t, b});
    }
  }
  std::ranges::sort(pairs, {}, [](const Pair& p) { return std::tuple(p.apart, p.track, p.body); });
  std::vector<bool> followed(tracks_.size(), false), taken(bodies.size(), false);
  for (const Pair& pair : pairs) {
    // A second body beside a followed track is that person's other leg, not somebody new.
    if (followed[pair.track] && !taken[pair.body] && pair.apart < 0.5 * config_.gate) taken[pair.body] = true;
    if (followed[pair.track] || taken[pair.body]) continue;
    followed[pair.track] = taken[pair.body] = true;
    Track& track = tracks_[pair.track];
    correct(track, bodies[pair.body].position);
    track.seen = scan.time;
    ++track.sightings;
  }
  for (std::size_t b = 0; b < bodies.size() && tracks_.size() < max_tracks; ++b) {
    if (taken[b]) continue;
    tracks_.push_back({.id = next_id_++,
                       .time = scan.time,
                       .seen = scan.time,
                       .position = bodies[b].position,
                       .velocity = {},
                       .var_position = config_.position_noise * config_.position_noise,
                       .var_cross = 0.0,
                       .var_velocity = 0.5,
                       .sightings = 1});
  }
  std::erase_if(tracks_, [&](const Track& track) { return scan.time - track.seen > config_.lost_after; });
}

People PeopleTracker::people(Time now) const {
  People all{.time = now, .people = {}};
  for (const Track& track : tracks_) {
    if (track.sightings < config_.confirm_after || now - track.seen > config_.lost_after) continue;
    Track ahead = track;
    predict(ahead, now);
    all.people.push_back({.position = ahead.position, .velocity = ahead.velocity, .id = track.id});
  }
  return all;
}

int people_within(const People& people, Point center, double radius) {
  return static_cast<int>(std::ranges::count_if(
      people.people, [&](const PersonSeen& p) { return distance(p.position, center) <= radius; }));
}

int people_on_path(const People& people, const std::vector<Point>& path, double ahead, double half_width) {
  const auto on_leg = [&](Point p, Point a, Point b) {
    const Point leg = b - a;
    const double length2 = dot(leg, leg);
    const double share = length2 > 0.0 ? std::clamp(dot(p - a, leg) / length2, 0.0, 1.0) : 0.0;
    return distance(p, a + share * leg) <= half_width;
  };
  int count = 0;
  for (const PersonSeen& person : people.people) {
    double left = ahead;
    for (std::size_t i = 0; i + 1 < path.size() && left > 0.0; ++i) {
      const double length = distance(path[i], path[i + 1]);
      const Point end = length > left ? path[i] + (left / length) * (path[i + 1] - path[i]) : path[i + 1];
      left -= length;
      if (!on_leg(person.position, path[i], end)) continue;
      ++count;
      break;
    }
  }
  return count;
}

}  // namespace robot
