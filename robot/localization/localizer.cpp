#include "robot/localization/localizer.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <optional>
#include <span>

#include "robot/geometry/ray_cast.hpp"
#include "robot/localization/beams.hpp"

namespace robot {
namespace {

constexpr double seed_sigma_position = 0.08, seed_sigma_theta = 0.03;  // of a place that a search found, m and rad

// What no scan tells: how far a map is off from the building. From recorded logs against their references.
constexpr double map_sigma_position = 0.02, map_sigma_theta = 0.008;  // m, rad

double larger_axis(const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix2d block = covariance.topLeftCorner<2, 2>();
  const auto values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(block, Eigen::EigenvaluesOnly).eigenvalues();
  return std::sqrt(std::max(0.0, values[1]));
}

double heading_sigma(const Eigen::Matrix3d& covariance) { return std::sqrt(std::max(0.0, covariance(2, 2))); }

// What is left unsaid by samples that are few and by a map that is not perfect.
Eigen::Matrix3d with_floor(Eigen::Matrix3d covariance, double metres, double angle) {
  covariance.diagonal() += Eigen::Vector3d(metres * metres, metres * metres, angle * angle);
  return covariance;
}

}  // namespace

double Estimate::sigma_position() const { return larger_axis(covariance); }
double Estimate::sigma_theta() const { return heading_sigma(covariance); }

struct Localizer::Parts {
  Parts(const OccupancyGrid& grid, const LocalizerConfig& c, std::uint64_t seed)
      : config(c),
        map(grid),
        field(map, c.likelihood, c.surface_offset),
        caster(map),
        reader(caster, field, c.reading),
        search(map, caster, field, c.search),
        judge(c.lost),
        random(seed),
        filter(c.particles, random.split()) {}
  Parts(const Parts&) = delete;  // parts refer to each other

  enum class Phase { blind, tracking };
  // What each laser said last: what a search looks at, and when the samples were last weighed by it.
  struct Glance {
    LaserId laser = LaserId::front;
    Beams beams;
    Pose odom_from_base;
    Time time;
    Pose weighed_odom;
    Time weighed_at;
    bool weighed = false;
  };

  // A place that a search found better than the one believed, and the odometry there.
  struct Rival {
    Pose map_from_base;
    Pose odom_from_base;
    int times = 1;  // found at this place
  };

  LocalizerConfig config;
  OccupancyGrid map;
  LikelihoodField field;
  RayCaster caster;
  BeamReader reader;
  GlobalSearch search;
  LostJudge judge;
  Random random;
  MonteCarlo filter;

  Phase phase = Phase::blind;
  std::optional<Pose> odom_now;   // newest odometry
  std::optional<Pose> odom_then;  // odometry at the samples' time
  MotionStep since;               // way and turns since then
  int weighed = 0;
  Cluster best;                                                    // heaviest lump at the samples' time
  Eigen::Matrix3d predicted_covariance = Eigen::Matrix3d::Zero();  // of its belief before the last scan was weighed
  int modes = 0;
  bool localized = false;
  bool settled = false;  // was localized since the belief was last set up: where the wheels lead deserves trust

  Pose pose;       // refined estimate ...
  Pose pose_odom;  // ... and the odometry it belongs to
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double offset = 0.0;  // m, learned so far
  int offsets_learned = 0;
  double explained = 1.0;   // share of the beams that met the map, moving average
  double usual_far = 0.05;  // share of impossible beams, slow average

  std::vector<Glance> glances;
  int scans_since_wish = 0;  // scans since a search has been wanted
  bool search_wanted = false;
  Pose search_odom;
  Time searched_at;
  std::optional<Rival> rival;

  void forget_motion(const Pose& odom) {
    odom_then = odom;
    since = {};
  }
  void advance(const Pose& odom);
  void summarize();
  Beams comb(const LaserScan& scan, const Pose& base_from_laser) const;
  std::vector<Point> trusted_ends(const Beams& beams);
  void weigh(const Beams& beams, double temper);
  void take_in(const LaserScan& scan, const Pose& base_from_laser, const Pose& odom, double temper);
  ScanReading read(const LaserScan& scan, const Pose& map_from_laser) const;
  bool refine(const LaserScan& scan, const Pose& base_from_laser, const Pose& odom);
  void doubt(const Beams& beams, const ScanReading& reading);
  void learn_offset(const ScanMatch& match);
  void judge_state(const ScanReading& reading);
  Glance& glance(const LaserScan& scan, const Pose& base_from_laser, const Pose& odom);
  Look look_from(const Pose& odom) const;
  bool convincing(const Peak& found, const Peak& current);
  void adopt_search();
  ScanReading read_blindly(const LaserScan& scan, const Pose& map_from_laser) const;
};

// Brings the samples up to an odometry.
void Localizer::Parts::advance(const Pose& odom) {
  since.moved = relative(*odom_then, odom);
  filter.predict(since, config.motion);
  forget_motion(odom);
}

void Localizer::Parts::summarize() {
  const auto clusters = filter.clusters();
  modes =
      static_cast<int>(std::count_if(clusters.begin(), clusters.end(), [](const auto& c) { return c.mass > 0.05; }));
  best = clusters.empty() ? Cluster{} : clusters.front();
  pose = best.mean;
  pose_odom = odom_then.value_or(Pose{});
  covariance = best.covariance;
  predicted_covariance = best.covariance;
}

// A thinned scan, a different comb of beams each time.
Beams Localizer::Parts::comb(const LaserScan& scan, const Pose& base_from_laser) const {
  const int stride = std::max(1, (static_cast<int>(scan.ranges.size()) + config.beams - 1) / config.beams);
  return beams_of(scan, base_from_laser, weighed % stride, stride);
}

// The beams to weigh the samples by: those that did not surely meet somebody, and some that nobody asks about.
std::vector<Point> Localizer::Parts::trusted_ends(const Beams& beams) {
  const std::vector<Pose> belief = filter.draw(config.filter_samples, random.uniform());
  std::vector<Point> result;
  for (const Beam& beam : beams.beams) {
    const bool untested = random.chance(config.unfiltered_share);
    if (untested || !reader.is_short(beam, beams.origin, belief)) result.push_back(beam.end);
  }
  return result;
}

void Localizer::Parts::weigh(const Beams& beams, double temper) {
  const std::vector<Point> ends = trusted_ends(beams);
  const Cluster before = filter.clusters().front();
  // Beyond the map's rim chance hits would pull the belief back: there the wheels know better.
  const auto telling = std::count_if(ends.begin(), ends.end(), [&](Point e) { return field.tells(before.mean * e); });
  const double known = ends.empty() ? 0.0 : static_cast<double>(telling) / static_cast<double>(ends.size());
  if (larger_axis(before.covariance) < 1.0) temper *= known * known;
  const bool searching = !localized || larger_axis(best.covariance) > 0.3;
  field.set_hit_sigma(config.likelihood.hit_sigma * (searching ? 2.0 : 1.0));
  const Particles& particles = filter.particles();
  std::vector<float> log_likelihood(particles.size());
  field.weigh(particles.x, particles.y, particles.theta, ends, log_likelihood);
  for (auto& value : log_likelihood) value *= static_cast<float>(temper);
  filter.weigh(log_likelihood);
  summarize();
  if (modes <= 1) predicted_covariance = before.covariance;
  filter.resample_when_uneven();
  ++weighed;
}

// All that a scan does to the belief.
void Localizer::Parts::take_in(const LaserScan& scan, const Pose& base_from_laser, const Pose& odom, double temper) {
  const Beams beams = comb(scan, base_from_laser);
  advance(odom);
  weigh(beams, temper);
  const bool agrees = refine(scan, base_from_laser, odom);
  if (agrees && larger_axis(covariance) < 0.3) {
    filter.infuse({pose, larger_axis(covariance), heading_sigma(covariance), 1.0}, config.match_share);
  }
  doubt(beams, read(scan, pose * base_from_laser));
}

ScanReading Localizer::Parts::read(const LaserScan& scan, const Pose& map_from_laser) const {
  return reader.read(scan, map_from_laser, larger_axis(covariance), heading_sigma(covariance));
}

// The estimate between the samples: the scan aligned with the map, held by the belief. False when the scan fits well
// only where the belief is not.
bool Localizer::Parts::refine(const LaserScan& scan, const Pose& base_from_laser, const Pose& odom) {
  const Pose predicted = best.mean * relative(*odom_then, odom);
  const Eigen::Matrix3d prior = with_floor(predicted_covariance, 0.01, 0.005);
  pose = predicted;
  pose_odom = odom;
  covariance = with_floor(best.covariance, map_sigma_position, map_sigma_theta);
  if (larger_axis(best.covariance) > 0.5) return true;
  const int stride = std::max(1, (static_cast<int>(scan.ranges.size()) + 180) / 181);
  Beams beams = beams_of(scan, base_from_laser, 0, stride);
  // Only ends near a surface can say where it is; no ray needs to be cast for that.
  const double slack = config.reading.tolerance + 2.0 * larger_axis(covariance);
  std::erase_if(beams.beams, [&](const Beam& beam) {
    const Point end = predicted * beam.end;
    return !field.tells(end) || interpolate(field.distances(), end).value > slack;
  });
  if (beams.beams.size() < 10) return true;
  const ScanMatch match =
      match_scan(field.distances(), field.surface_offset(), beams.beams, predicted, prior, config.match);
  const Eigen::Vector3d off(match.pose.x - predicted.x, match.pose.y - predicted.y,
                            wrap_angle(match.pose.theta - predicted.theta));
  if (match.fit < 0.3 || off.dot(prior.inverse() * off) > 16.0) return false;
  pose = match.pose;
  covariance = with_floor(match.covariance, map_sigma_position, map_sigma_theta);
  learn_offset(match);
  return true;
}

// Augmented MCL (Thrun et al., "Probabilistic Robotics", table 8.3) with a local proposal: when more beams than usual
// are longer than the map allows, which people cannot cause, some samples are drawn where the scan would fit. They stay
// if the next scans agree.
void Localizer::Parts::doubt(const Beams& beams, const ScanReading& reading) {
  const double far = count_beams(reading).far_share();
  if (larger_axis(best.covariance) > 0.5 || beams.beams.size() < 10) return;
  if (far < usual_far + config.doubt_above) {
    usual_far += 0.02 * (far - usual_far);
    return;
  }
  const Pose nearby = search_nearby(field, beams.beams, best.mean, config.match).pose;
  const Look look{{beams}};
  // The end points alone would look through walls to find a place; the beam model does not.
  const double gain =
      judge_place(caster, field, look, nearby).score - judge_place(caster, field, look, best.mean).score;
  if (gain > config.doubt_gain) filter.infuse({nearby, 0.05, 0.02, 1.0}, config.doubt_share);
}

void Localizer::Parts::learn_offset(const ScanMatch& match) {
  if (!config.learn_surface_offset || !localized || match.fit < 0.6 || match.beams < 30.0) return;
  const double gain = std::max(0.02, 1.0 / (10.0 + offsets_learned++));
  offset = std::clamp(offset + gain * match.residual, 0.0, map.resolution());
  if (std::abs(offset - field.surface_offset()) > 0.001) field.set_surface_offset(offset);
}

void Localizer::Parts::judge_state(const ScanReading& reading) {
  const BeamCounts counts = count_beams(reading);
  judge.observe(counts);
  const int all = counts.map + counts.person + counts.far;
  if (all > 0) explained += 0.1 * (static_cast<double>(counts.map) / all - explained);
  const double metres = larger_axis(best.covariance), angle = heading_sigma(best.covariance);
  if (localized) {
    localized = !judge.lost() && best.mass > 0.7 && metres < 0.8;
  } else {
    localized = judge.confirmed() && best.mass > 0.95 && metres < 0.4 && angle < radians(15);
  }
  settled |= localized;
}

Localizer::Parts::Glance& Localizer::Parts::glance(const LaserScan& scan, const Pose& base_from_laser,
                                                   const Pose& odom) {
  auto it = std::find_if(glances.begin(), glances.end(), [&](const Glance& g) { return g.laser == scan.laser; });
  if (it == glances.end()) it = glances.insert(glances.end(), Glance());
  it->laser = scan.laser;
  it->beams = beams_of(scan, base_from_laser);
  it->odom_from_base = odom;
  it->time = scan.time;
  // Hardly anything of the map in sight is a dense crowd, or another place: a look over the whole map tells them apart.
  const bool doubtful = !localized || explained < config.suspicious_below;
  const bool due = phase == Phase::blind || scan.time - searched_at >= config.search_again;
  if (doubtful && due && !search.running()) search_wanted = true;
  scans_since_wish = search_wanted ? scans_since_wish + 1 : 0;
  return *it;
}

// All lasers' last scans as one look round from the given odometry; those too far back in way are left out.
Look Localizer::Parts::look_from(const Pose& odom) const {
  Look look;
  for (const Glance& g : glances) {
    const Pose base_from_then = relative(odom, g.odom_from_base);
    if (norm(base_from_then.position()) > 0.5 || std::abs(base_from_then.theta) > 0.5) continue;
    Beams beams = g.beams;
    beams.origin = base_from_then * beams.origin;
    for (Beam& beam : beams.beams) {
      beam.end = base_from_then * beam.end;
      beam.direction = (base_from_then * beam.direction) - base_from_then.position();
    }
    look.lasers.push_back(std::move(beams));
  }
  return look;
}

// Whether what a search found is reason enough to give up where the robot is believed to be.
bool Localizer::Parts::convincing(const Peak& found, const Peak& current) {
  if (best.mass <= 0.5) return true;
  const double margin = settled ? config.adopting_margin : 1.0;
  const bool better = found.score > current.score + margin && found.share > config.worth_adopting;
  if (!better || !settled) return better;
  // Among people, or in a room that the map does not know, a scan may fit somewhere by chance, but not at the same
  // place again from another point of view. A lost robot that stands still gets no other one: there it must fit for
  // longer.
  const Pose seen_from_rival = rival ? relative(rival->odom_from_base, search_odom) : Pose{};
  const Pose expected = rival ? rival->map_from_base * seen_from_rival : Pose{};
  const bool same = rival && distance(expected.position(), found.pose.position()) < 0.5 &&
                    std::abs(wrap_angle(expected.theta - found.pose.theta)) < radians(10);
  if (!same) rival = Rival{found.pose, search_odom};
  const bool elsewhere = norm(seen_from_rival.position()) > 0.3 || std::abs(seen_from_rival.theta) > 0.3;
  return same && (elsewhere || (!localized && ++rival->times >= config.looks_at_rest));
}

// A search has ended: its places become hypotheses beside what is still believed (mixture MCL: Thrun et al. 2001).
void Localizer::Parts::adopt_search() {
  const auto& peaks = search.peaks();
  if (peaks.empty() || !odom_now) return;
  const Pose since_look = relative(search_odom, *odom_now);
  std::vector<Seed> seeds;
  double best_score = peaks.front().score;
  if (phase == Phase::tracking) {
    const Peak current = judge_place(caster, field, search.look(), pose * relative(pose_odom, search_odom));
    if (!convincing(peaks.front(), current)) return;
    best_score = std::max(best_score, current.score);
    seeds.push_back({current.pose * since_look, std::min(0.3, larger_axis(best.covariance) + 0.02),
                     heading_sigma(best.covariance) + 0.01, std::max(0.02, std::exp(current.score - best_score))});
  }
  for (const Peak& peak : peaks) {
    if (seeds.size() >= 40) break;
    seeds.push_back({peak.pose * since_look, seed_sigma_position, seed_sigma_theta,
                     std::max(1e-3, std::exp(peak.score - best_score))});
  }
  filter.start(seeds);
  forget_motion(*odom_now);
  summarize();
  judge.reset(1.0);
  explained = 1.0;
  rival.reset();
  localized = settled = false;
  phase = Phase::tracking;
}

// Where nothing is known nothing is surprising.
ScanReading Localizer::Parts::read_blindly(const LaserScan& scan, const Pose& map_from_laser) const {
  ScanReading reading{map_from_laser, {}, {}, false};
  for (const float range : scan.ranges) {
    const bool met = is_return(range, scan.max_range);
    reading.kinds.push_back(met ? BeamKind::map : BeamKind::no_return);
    reading.expected.push_back(met ? range : scan.max_range);
  }
  return reading;
}

Localizer::Localizer(const OccupancyGrid& map, LocalizerConfig config, std::uint64_t seed)
    : parts_(std::make_unique<Parts>(map, config, seed)) {
  parts_->offset = config.surface_offset;
}
Localizer::~Localizer() = default;
Localizer::Localizer(Localizer&&) noexcept = default;
Localizer& Localizer::operator=(Localizer&&) noexcept = default;

void Localizer::start_at(const Pose& map_from_base, double sigma_position, double sigma_theta) {
  if (!is_finite(map_from_base)) return;
  Parts& p = *parts_;
  const Seed seed{map_from_base, sigma_position, sigma_theta, 1.0};
  p.filter.start({&seed, 1});
  if (p.odom_now) p.forget_motion(*p.odom_now);
  p.phase = Parts::Phase::tracking;
  p.judge.reset(p.config.lost.found_below);
  p.explained = 1.0;
  p.localized = p.settled = sigma_position < 0.8;
  p.search_wanted = false;
  p.rival.reset();
  p.glances.clear();
  p.summarize();
}

void Localizer::start_globally() {
  Parts& p = *parts_;
  std::vector<Pose> everywhere;
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < p.map.size(); ++i) {
    if (is_free(p.map.cells()[i])) open.push_back(i);
  }
  for (int i = 0; i < p.config.particles.max_particles && !open.empty(); ++i) {
    const Point at = p.map.center(p.map.cell_at(open[p.random.index(open.size())]));
    everywhere.push_back({at.x, at.y, p.random.uniform(-pi, pi)});
  }
  p.filter.start_from(everywhere);
  if (p.odom_now) p.forget_motion(*p.odom_now);
  p.phase = Parts::Phase::blind;
  p.localized = p.settled = false;
  p.glances.clear();
  p.summarize();
}

void Localizer::move(const Pose& odom_from_base, Time) {
  if (!is_finite(odom_from_base)) return;
  Parts& p = *parts_;
  if (p.odom_now) {
    const Pose step = relative(*p.odom_now, odom_from_base);
    p.since.path += norm(step.position());
    p.since.turned += std::abs(step.theta);
  }
  p.odom_now = odom_from_base;
  if (!p.odom_then) {
    p.odom_then = odom_from_base;
    p.pose_odom = odom_from_base;
  }
}

ScanReading Localizer::update(const LaserScan& scan, const Pose& base_from_laser, const Pose& odom_from_base) {
  Parts& p = *parts_;
  const Pose odom = is_finite(odom_from_base) ? odom_from_base : p.odom_now.value_or(Pose{});
  if (!p.odom_then) move(odom, scan.time);
  Parts::Glance& glance = p.glance(scan, base_from_laser, odom);
  if (p.phase == Parts::Phase::blind) {
    return p.read_blindly(scan, p.pose * relative(p.pose_odom, odom) * base_from_laser);
  }
  const Pose moved = relative(glance.weighed_odom, odom);
  const bool resting = glance.weighed && norm(moved.position()) < p.config.update_after_metres &&
                       std::abs(moved.theta) < p.config.update_after_turn;
  // While the place is in doubt, patience at rest would only cost time.
  const Seconds patience = p.localized ? p.config.update_after_rest : 0.2 * p.config.update_after_rest;
  bool due = !resting || scan.time - glance.weighed_at >= patience;
  // A scan that does not fit where the robot should be by now is not put off: the wheels may have slipped.
  if (!due) due = !p.refine(scan, base_from_laser, odom);
  if (due) {
    p.take_in(scan, base_from_laser, odom, resting ? p.config.rest_temper : 1.0);
    glance.weighed = true;
    glance.weighed_odom = odom;
    glance.weighed_at = scan.time;
  }
  ScanReading reading = p.read(scan, p.pose * base_from_laser);
  reading.weighed = due;
  if (due) p.judge_state(reading);
  return reading;
}

bool Localizer::work(int units) {
  Parts& p = *parts_;
  if (!p.search.running()) {
    // The second scan is the other laser's, or the same one's when there is only one.
    if (!p.search_wanted || p.scans_since_wish < 2 || !p.odom_now) return false;
    p.search_wanted = false;
    p.searched_at = p.glances.back().time;
    p.search_odom = p.glances.back().odom_from_base;
    p.search.start(p.look_from(p.search_odom));
  }
  if (p.search.step(units)) return true;
  p.adopt_search();
  return false;
}

Estimate Localizer::estimate() const {
  const Parts& p = *parts_;
  Estimate e;
  e.map_from_base = p.odom_now ? p.pose * relative(p.pose_odom, *p.odom_now) : p.pose;
  e.covariance = p.covariance;
  e.localized = p.localized;
  e.lost = p.judge.lost();
  e.particles = static_cast<int>(p.filter.particles().size());
  e.modes = p.modes;
  return e;
}

std::vector<Pose> Localizer::samples(int at_most) const {
  const Parts& p = *parts_;
  const int count = std::min(at_most, static_cast<int>(p.filter.particles().size()));
  std::vector<Pose> poses = p.filter.draw(count);
  if (p.odom_now && p.odom_then) {
    const Pose step = relative(*p.odom_then, *p.odom_now);
    for (Pose& pose : poses) pose = pose * step;
  }
  return poses;
}

}  // namespace robot
