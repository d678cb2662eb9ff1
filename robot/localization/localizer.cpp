#include "robot/localization/localizer.hpp"

#include <algorithm>
#include <optional>

#include "robot/localization/tracker.hpp"

namespace robot {
namespace {

constexpr double seed_sigma_position = 0.08, seed_sigma_theta = 0.03;  // of a place that a search found, m and rad
constexpr std::size_t most_seeds = 40;

// Where nothing is known nothing is surprising.
ScanReading read_blindly(const LaserScan& scan, const Pose& map_from_laser) {
  ScanReading reading{map_from_laser, {}, {}};
  for (const float range : scan.ranges) {
    const bool met = is_return(range, scan.max_range);
    reading.kinds.push_back(met ? BeamKind::map : BeamKind::no_return);
    reading.expected.push_back(met ? range : scan.max_range);
  }
  return reading;
}

}  // namespace

double Estimate::sigma_position() const { return position_sigma(covariance); }
double Estimate::sigma_theta() const { return heading_sigma(covariance); }

struct Localizer::Parts {
  Parts(const OccupancyGrid& map, const LocalizerConfig& c, std::uint64_t seed)
      : config(c),
        tracker(map, c, Random(seed)),
        search(map, tracker.caster(), tracker.field(), c.search),
        judge(c.lost) {}
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
    int times = 0;  // found at this place
  };

  LocalizerConfig config;
  Tracker tracker;
  GlobalSearch search;
  LostJudge judge;

  Phase phase = Phase::blind;
  bool localized = false;
  bool settled = false;    // was localized since the belief was last set up: where the wheels lead deserves trust
  double explained = 1.0;  // share of the beams that met the map, moving average
  std::vector<Glance> glances;
  int scans_since_wish = 0;  // scans since a search has been wanted
  bool search_wanted = false;
  Pose search_odom;
  Time searched_at;
  std::optional<Rival> rival;

  void restart(Phase new_phase, bool known, double lost_log_odds);
  void judge_state(const ScanReading& reading);
  void set_localized(bool is) {
    localized = is;
    tracker.set_sure(is);
  }
  Glance& glance(const LaserScan& scan, const Pose& base_from_laser, const Pose& odom);
  Look look_from(const Pose& odom) const;
  bool convincing(const Peak& found, const Peak& current);
  void adopt_search();
};

// Forgets all that was thought about the belief before this one.
void Localizer::Parts::restart(Phase new_phase, bool known, double lost_log_odds) {
  phase = new_phase;
  settled = known;
  set_localized(known);
  judge.reset(lost_log_odds);
  explained = 1.0;
  rival.reset();
  search.cancel();
  search_wanted = false;
}

void Localizer::Parts::judge_state(const ScanReading& reading) {
  const BeamCounts counts = count_beams(reading);
  judge.observe(counts);
  const int all = counts.map + counts.person + counts.far;
  // Off the map a few chance beams would else speak for the whole scan.
  if (all > 0) explained += 0.1 * (counts.map - all * explained) / (all + counts.unknown);
  const Cluster& best = tracker.best();
  const double metres = position_sigma(best.covariance), angle = heading_sigma(best.covariance);
  if (localized) {
    set_localized(!judge.lost() && best.mass > 0.7 && metres < 0.8);
  } else {
    set_localized(judge.confirmed() && best.mass > 0.95 && metres < 0.4 && angle < radians(15));
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
  if (tracker.best().mass <= 0.5) return true;
  const double margin = settled ? config.adopting_margin : 1.0;
  const bool better = found.score > current.score + margin && found.share > config.worth_adopting;
  if (!better || !settled) return better;
  // Where much looks alike, along corridors, something always fits better than a place that people or unknown walls
  // hide.
  if (localized && static_cast<int>(search.peaks().size()) > config.most_alike) return false;
  // Among people, or in a room that the map does not know, a scan may fit somewhere by chance, but not at the same
  // place again and again from other points of view. Only a lost robot that stands still gets no other one.
  const Pose seen_from_rival = rival ? relative(rival->odom_from_base, search_odom) : Pose{};
  const Pose expected = rival ? rival->map_from_base * seen_from_rival : Pose{};
  const bool same = rival && distance(expected.position(), found.pose.position()) < 0.5 &&
                    std::abs(wrap_angle(expected.theta - found.pose.theta)) < radians(10);
  if (!same) rival = Rival{found.pose, search_odom};
  const bool elsewhere = norm(seen_from_rival.position()) > 0.3 || std::abs(seen_from_rival.theta) > 0.3;
  return ++rival->times >= config.looks && (elsewhere || !localized);
}

// A search has ended: its places become hypotheses beside what is still believed (mixture MCL: Thrun et al. 2001).
void Localizer::Parts::adopt_search() {
  const auto& peaks = search.peaks();
  if (peaks.empty() || !tracker.has_odometry()) return;
  const Pose since_look = relative(search_odom, tracker.odometry());
  std::vector<Seed> seeds;
  double best_score = peaks.front().score;
  if (phase == Phase::tracking) {
    const Peak current = judge_place(tracker.caster(), tracker.field(), search.look(), tracker.pose_at(search_odom));
    if (!convincing(peaks.front(), current)) return;
    best_score = std::max(best_score, current.score);
    const Eigen::Matrix3d& spread = tracker.best().covariance;
    seeds.push_back({current.pose * since_look, std::min(0.3, position_sigma(spread) + 0.02),
                     heading_sigma(spread) + 0.01, std::max(0.02, std::exp(current.score - best_score))});
  }
  for (const Peak& peak : peaks) {
    if (seeds.size() >= most_seeds) break;
    seeds.push_back({peak.pose * since_look, seed_sigma_position, seed_sigma_theta,
                     std::max(1e-3, std::exp(peak.score - best_score))});
  }
  tracker.start(seeds);
  restart(Phase::tracking, false, 1.0);
}

Localizer::Localizer(const OccupancyGrid& map, LocalizerConfig config, std::uint64_t seed)
    : parts_(std::make_unique<Parts>(map, config, seed)) {}
Localizer::~Localizer() = default;
Localizer::Localizer(Localizer&&) noexcept = default;
Localizer& Localizer::operator=(Localizer&&) noexcept = default;

void Localizer::start_at(const Pose& map_from_base, double sigma_position, double sigma_theta) {
  if (!is_finite(map_from_base)) return;
  const Seed seed{map_from_base, sigma_position, sigma_theta, 1.0};
  parts_->tracker.start({&seed, 1});
  parts_->glances.clear();
  parts_->restart(Parts::Phase::tracking, sigma_position < 0.8, parts_->config.lost.found_below);
}

void Localizer::start_globally() {
  parts_->tracker.start_anywhere();
  parts_->glances.clear();
  parts_->restart(Parts::Phase::blind, false, 1.0);
}

void Localizer::move(const Pose& odom_from_base, Time) {
  if (is_finite(odom_from_base)) parts_->tracker.move(odom_from_base);
}

ScanReading Localizer::update(const LaserScan& scan, const Pose& base_from_laser, const Pose& odom_from_base) {
  Parts& p = *parts_;
  const Pose odom = is_finite(odom_from_base) ? odom_from_base : p.tracker.odometry();
  if (!p.tracker.has_odometry()) p.tracker.move(odom);
  Parts::Glance& glance = p.glance(scan, base_from_laser, odom);
  if (p.phase == Parts::Phase::blind) return read_blindly(scan, p.tracker.pose_at(odom) * base_from_laser);
  const Pose moved = relative(glance.weighed_odom, odom);
  const bool resting = glance.weighed && norm(moved.position()) < p.config.update_after_metres &&
                       std::abs(moved.theta) < p.config.update_after_turn;
  // While the place is in doubt, patience at rest would only cost time.
  const Seconds patience = p.localized ? p.config.update_after_rest : 0.2 * p.config.update_after_rest;
  bool due = !resting || scan.time - glance.weighed_at >= patience;
  // A scan that does not fit where the robot should be by now is not put off: the wheels may have slipped.
  if (!due) due = !p.tracker.refine(scan, base_from_laser, odom);
  ScanReading reading;
  if (!due) {
    reading = p.tracker.read(scan, p.tracker.pose_at(odom) * base_from_laser);
    due = p.tracker.surprising(reading);
  }
  if (due) {
    p.tracker.take_in(scan, base_from_laser, odom, resting ? p.config.rest_temper : 1.0);
    glance.weighed = true;
    glance.weighed_odom = odom;
    glance.weighed_at = scan.time;
    reading = p.tracker.read(scan, p.tracker.pose_at(odom) * base_from_laser);
  }
  reading.weighed = due;
  if (due) p.judge_state(reading);
  return reading;
}

bool Localizer::work(int units) {
  Parts& p = *parts_;
  if (!p.search.running()) {
    // The second scan is the other laser's, or the same one's when there is only one.
    if (!p.search_wanted || p.scans_since_wish < 2) return false;
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
  e.map_from_base = p.tracker.pose_at(p.tracker.odometry());
  e.covariance = p.tracker.covariance();
  e.localized = p.localized;
  e.lost = p.judge.lost();
  e.particles = p.tracker.particles();
  e.modes = p.tracker.modes();
  return e;
}

std::vector<Pose> Localizer::samples(int at_most) const { return parts_->tracker.samples(at_most); }

}  // namespace robot
