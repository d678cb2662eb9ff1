// People from laser beams: the beams that the localizer cannot explain by the map are gathered into bodies, and bodies
// are followed through time with constant velocity, so that each person has a place, a motion and an id that stays.
#pragma once

#include <cstddef>
#include <vector>

#include "robot/outputs.hpp"
#include "robot/time.hpp"

namespace robot {

struct PeopleConfig {
  double max_range = 8.0;         // m; farther away too few beams meet a person
  double gap = 0.3;               // m between the ends of beams within which they belong together: legs in a stride
  double leg_radius = 0.06;       // m; beams meet the near side of the legs
  double max_width = 0.6;         // m; wider clusters are several people side by side
  int min_beams = 2;              // a single beam within 3 m is noise
  double gate = 0.6;              // m between a track's prediction and a body
  double acceleration = 1.0;      // m/s2, one standard deviation of how people change their mind
  double position_noise = 0.1;    // m, one standard deviation of a body's place: legs swing
  Seconds lost_after{1.0};        // a track unseen for so long is dropped,
  Seconds gone_after{0.15};       // or for so long, when beams pass where it should be
  double same_person = 0.3;       // m; of two tracks nearer than this the younger one is dropped
  std::size_t most_people = 100;  // tracks at a time
  int confirm_after = 4;          // sightings before a track counts as a person
};

// A body in one scan, map frame.
struct PersonBody {
  Point position;
  int beams = 0;
};

// Gathers the beams classified as person into bodies.
std::vector<PersonBody> find_bodies(const ScanView& scan, const PeopleConfig& config = {});

class PeopleTracker {
 public:
  explicit PeopleTracker(const PeopleConfig& config = {}) : config_(config) {}

  // Scans of all lasers, in order of time.
  void add(const ScanView& scan);
  // Confirmed people at a time not before the last scan, in order of id.
  People people(Time now) const;

 private:
  struct Track {
    int id = 0;
    Time time;  // of the state
    Time seen;
    Point position, velocity;
    double var_position = 0.0, var_cross = 0.0, var_velocity = 0.0;  // the same for x and y
    int sightings = 0;
  };
  void predict(Track& track, Time to) const;
  void correct(Track& track, Point measured) const;
  void match(const std::vector<PersonBody>& bodies, Time time);
  void drop_gone(const ScanView& scan);

  PeopleConfig config_;
  std::vector<Track> tracks_;
  int next_id_ = 1;
};

// People within a radius (m) of a point.
int people_within(const People& people, Point center, double radius);
// People closer than half_width (m) to the next `ahead` metres of the path.
int people_on_path(const People& people, const std::vector<Point>& path, double ahead, double half_width);

}  // namespace robot
