// The guide: turns the queue of requests into one goal at a time, and tells what it does. A task program in the lineage
// of RHINO's GOLOG layer (RHINO 4.3), with execution monitoring: whoever stands in the way is asked, a visit that
// cannot be made now is tried again later, and then given up.
//
//              a request            arrived             told               answer or time
//     idle ───────────────► driving ─────────► telling ─────────► asking ─────────────────► next visit
//      ▲  ▲                  │   ▲                ▲                  │
//      │  └── homing ◄───────┘   └── postponed    └───── more ───────┘
//      └──────────┘  nothing to do
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "robot/museum.hpp"
#include "robot/outputs.hpp"
#include "robot/tasks/request_queue.hpp"

namespace robot {

struct GuideConfig {
  QueueConfig queue;
  Seconds waiting_after{1.5};       // without progress for this long: "waiting"
  Seconds polite_after{2.5};        // then a polite word
  Seconds horn_after{9.0};          // then the horn (RHINO 5.3)
  Seconds word_again_after{12.0};   // between two words
  Seconds postpone_after{90.0};     // then another visit first, if there is one
  Seconds fail_after{420.0};        // then the visit is given up
  Seconds unreachable_after{20.0};  // no way at all for this long counts like postpone_after
  double near_enough = 1.3;         // m; a crowded exhibit is explained from here,
  Seconds near_enough_after{5.0};   // when the rest of the way is blocked for this long
  Seconds ask{8.0};                 // "more, or move on?"
  Seconds stay_at_point{6.0};       // at a place picked on the map
  Seconds idle_before_homing{15.0};
};

// Where to drive: any of these places, the nearest that can be had.
struct Goal {
  std::vector<Pose> places;  // map frame
  bool heading = false;      // turn to the place's heading on arrival
};

// What localization and motion know, once a tick.
struct Progress {
  Pose map_from_base;
  bool arrived = false;         // at one of the goal's places, heading included
  bool blocked = false;         // wants to move but cannot
  bool reachable = true;        // there is a way, as the map is now
  double distance_to_go = 0.0;  // m along the way
  double goal_distance = 0.0;   // m straight to the nearest of the goal's places
  int people_near = 0;          // within 3 m
  int people_ahead = 0;         // in the way
};

class Guide {
 public:
  // refuse: why a place on the map cannot be a goal, Refusal::none when it can. travel: see RequestQueue.
  Guide(const Museum& museum, GuideConfig config, std::function<Refusal(Point)> refuse, Travel travel);

  void handle(const RequestVisit& wish, Time now, std::vector<Output>& out);
  void handle(const CancelRequest& wish, Time now, std::vector<Output>& out);
  void handle(const StartTour& wish, Time now, std::vector<Output>& out);
  void handle(const AnswerTour& wish, Time now, std::vector<Output>& out);
  void handle(const Remember& memory, Time now, std::vector<Output>& out);

  void tick(const Progress& progress, Time now, std::vector<Output>& out);

  // Where to drive now; none: stand. The version changes with the goal.
  const std::optional<Goal>& goal() const { return goal_; }
  int goal_version() const { return goal_version_; }

  // Fills in what the guide knows of the status: activity, why, exhibit, requester, tour, times.
  void describe(Status& status, Time now) const;

 private:
  enum class State { idle, homing, driving, telling, asking };

  Refusal refuse_target(const Target& target) const;
  std::vector<Pose> places(const Target& target) const;
  void set_goal(std::optional<Goal> goal);
  void enter(State state, Time now);
  void choose_next(const Progress& progress, Time now);
  void drive_on(const Progress& progress, Time now, std::vector<Output>& out);
  void ask_to_make_way(const Progress& progress, Time now, std::vector<Output>& out);
  void put_off(const Progress& progress, Time now);
  void arrive(Time now, std::vector<Output>& out);
  void tell(int narration, Time now, std::vector<Output>& out);
  void leave(Time now, std::vector<Output>& out);
  void reorder(const Pose& here, Time now);
  double metres_to_front(const Progress& progress) const;
  void report(const Progress& progress, std::vector<Output>& out);
  const Exhibit* exhibit_here() const;

  const Museum* museum_;
  GuideConfig config_;
  std::function<Refusal(Point)> refuse_;
  Travel travel_;

  RequestQueue queue_;
  State state_ = State::idle;
  Time since_;  // of the state
  std::optional<Goal> goal_;
  int goal_version_ = 0;
  Pose here_;  // last known
  bool reorder_due_ = false;
  std::uint64_t tour_run_ = 0;  // running tour, 0: none
  std::optional<Time> blocked_since_;
  std::optional<Time> unreachable_since_;
  std::optional<Time> last_word_;
  int words_said_ = 0;
  VisitEnded visit_;  // at the exhibit now, as it will be told when it ends
  int narration_ = 0;
  Time until_;                      // end of telling or asking
  std::vector<RequestId> told_to_;  // requests of the visit under way, also after they were fulfilled
  Progress last_;
};

}  // namespace robot
