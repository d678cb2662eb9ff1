// All settings of the localizer, with their defaults.
#pragma once

#include "robot/localization/beam_reading.hpp"
#include "robot/localization/global_search.hpp"
#include "robot/localization/likelihood_field.hpp"
#include "robot/localization/lost.hpp"
#include "robot/localization/monte_carlo.hpp"
#include "robot/localization/motion_model.hpp"
#include "robot/localization/scan_match.hpp"
#include "robot/time.hpp"

namespace robot {

struct LocalizerConfig {
  MonteCarloConfig particles;
  MotionNoise motion;
  LikelihoodConfig likelihood;
  BeamReadingConfig reading;
  ScanMatchConfig match;
  GlobalSearchConfig search;
  LostConfig lost;
  int beams = 60;                    // a scan is thinned to this many for weighing
  double update_after_metres = 0.1;  // of way since the samples were last weighed ...
  double update_after_turn = 0.05;   // rad ... or of turning ...
  Seconds update_after_rest{1.0};    // ... or of standing still
  double rest_temper = 0.3;          // what a scan counts at rest: it repeats what the last one said
  double unfiltered_share = 0.1;     // of beams that pass the distance filter untested: evidence against a wrong belief
  int filter_samples = 16;           // of the belief, that the distance filter asks
  double match_share = 0.05;         // of the samples, drawn anew round each accepted scan match ...
  double match_fit = 0.85;           // ... once the place was found only where the scan fits the map this well; below
                                     // it what a scan says falls with the square of the fit, ...
  double least_trust = 0.2;          // ... at most to this share: a map that is wrong is wrong the same way next time
  double unknown_cost = 2.0;         // of an end in unknown space while tracking: times what other ends cost there
  double doubt_above = 0.1;          // share of impossible beams over the usual: worth a look round the belief
  double doubt_blind = 0.15;         // m: or the belief had spread as far as this before the scan
  double doubt_gain = 40.0;          // nats of the beam model that a place found there must be better ...
  double doubt_explains = 0.5;       // ... and share of the beams that it must explain
  double doubt_share = 0.2;          // of the samples, drawn at a better place found there
  double surface_offset = 0.0;       // m, see LikelihoodField; where tracking starts from ...
  bool learn_surface_offset = true;  // ... when it may be learned while localized
  Seconds search_again{3.0};         // while lost, not yet localized or suspicious
  double suspicious_below = 0.35;    // share of beams that meet the map, for a while: worth a search though localized
  double adopting_margin = 6.0;      // nats a place found must then be better than where the robot is believed to be
  int looks = 3;                     // that must find the same other place before a belief that was sure gives way
  int most_alike = 3;                // places that a look over the map may find as good for it to count against one
  double worth_adopting = 0.5;       // share of its beams that a place found must explain to replace a belief
};

}  // namespace robot
