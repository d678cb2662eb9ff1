// Where on the whole map can the robot be, from one look? Exhaustive correlation of the scan with a coarse map (every
// free position at 20 cm, every heading at 2 degrees), then the best places, far enough apart, are aligned finely and
// judged by a beam model, which knows that nobody looks through walls and that people shorten beams.
// Any-time: advances by counted slices of work.
#pragma once

#include <cstdint>
#include <vector>

#include "robot/geometry/grid.hpp"
#include "robot/geometry/pose.hpp"
#include "robot/geometry/ray_cast.hpp"
#include "robot/localization/beams.hpp"
#include "robot/localization/likelihood_field.hpp"

namespace robot {

struct GlobalSearchConfig {
  double cell = 0.2;            // m
  double heading = radians(2);  // rad
  double max_range = 20.0;      // m: longer beams are too sensitive to heading for the coarse look
  int coarse_beams = 60;        // at most, over all scans; their scores fit a byte
  int beams = 120;              // at most, for the fine look
  int kept = 8000;              // coarse states kept
  int candidates = 150;         // places aligned finely
  double apart_metres = 0.5;
  double apart_radians = radians(8);
  double margin = 25.0;  // nats below the best place that still count as possible
};

// One look round: the beams of one or more lasers at one pose of the base.
struct Look {
  std::vector<Beams> lasers;
};

struct Peak {
  Pose pose;           // map_from_base
  double score = 0.0;  // nats of the beam model, tempered; only differences mean something
  double share = 0.0;  // of the beams that ended where the map says
};

// Log-likelihood of the beams at a pose under a beam model with a hit, a short and a random part (Thrun et al.,
// "Probabilistic Robotics", 6.3), relative; neighbouring beams are tempered like in the likelihood field.
Peak judge_place(const RayCaster& caster, const LikelihoodField& field, const Look& look, const Pose& map_from_base);

class GlobalSearch {
 public:
  // Keeps references to the caster and the field.
  GlobalSearch(const OccupancyGrid& map, const RayCaster& caster, const LikelihoodField& field,
               GlobalSearchConfig config = {});

  void start(Look look);
  // Goes on for `units` of about 0.1 ms. True while there is more to do.
  bool step(int units);
  void cancel() { stage_ = Stage::idle; }
  bool running() const { return stage_ != Stage::idle; }
  const Look& look() const { return look_; }
  // The possible places, best first; complete when step() has returned false.
  const std::vector<Peak>& peaks() const { return peaks_; }

 private:
  struct State {
    std::uint8_t score;
    std::uint32_t place;  // heading-major index
  };
  // A total order, so that the same look finds the same places.
  static bool better(const State& a, const State& b) {
    return a.score != b.score ? a.score > b.score : a.place < b.place;
  }
  enum class Stage { idle, coarse, picking, fine };

  void set_heading(int heading);
  void score_row(int row);
  void keep(std::uint8_t score, int heading, int row, int column);
  void trim();
  void pick_candidates();
  void align(const Pose& start);
  void finish();
  Pose pose_of(const State& state) const;

  GlobalSearchConfig config_;
  const RayCaster& caster_;
  const LikelihoodField& field_;
  // The coarse map with a rim as wide as a beam, rows padded to whole blocks.
  int width_ = 0, height_ = 0, rim_ = 0, stride_ = 0, headings_ = 0;
  Point origin_;
  std::vector<std::uint8_t> values_;  // 0..4: how near the cell's surfaces are
  std::vector<std::uint8_t> free_;    // 255: the base can be here

  Stage stage_ = Stage::idle;
  Look look_;
  std::vector<Point> coarse_ends_;
  std::vector<Point> ends_;
  std::vector<Beam> beams_;
  std::vector<std::ptrdiff_t> offsets_;
  int heading_ = 0, row_ = 0;
  std::uint8_t floor_ = 0;
  std::vector<State> states_;
  std::vector<Pose> candidates_;
  std::size_t picked_ = 0, next_ = 0;
  std::vector<Peak> peaks_;
};

}  // namespace robot
