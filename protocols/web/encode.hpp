// Robot values as the JSON that REST and /ws send. SI units, radians, map frame, seconds of the run's time line; a
// number that is missing or not finite is null.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "protocols/web/problem.hpp"
#include "robot/body.hpp"
#include "robot/museum.hpp"
#include "robot/outputs.hpp"

namespace protocols::web {

// The value rounded to `digits` decimals (messages stay short), or null when it is not finite.
Json number(double value, int digits = 4);

// The text in a language; English, or anything there is, when that language is missing.
const std::string& in_language(const robot::Text& text, const std::string& language);

Json encode(const robot::Text& text);
Json encode(const robot::Pose& pose);
Json encode(robot::Point point);                       // [x, y]
Json encode(const std::vector<robot::Point>& points);  // [[x, y]...]

// ---- The museum (REST) ----------------------------------------------------------------------------------------

Json encode_site(const robot::Museum& museum, const robot::Footprint& footprint);
// `number` is the exhibit's own; texts in `language` and, beside them, in all languages.
Json encode_exhibit(const robot::Exhibit& exhibit, const std::string& language);
Json encode_tour(const robot::Tour& tour, const robot::Museum& museum, const std::string& language);
Json encode_map(const robot::OccupancyGrid& map, const std::string& url);

// ---- The robot -------------------------------------------------------------------------------------------------

// What GET status and the topic `status` say. `pose` none: nothing is known yet.
struct StatusView {
  robot::Time time;
  const robot::Status& status;
  std::optional<robot::PoseEstimate> pose;
  robot::Text sentence;
  robot::Text detail;
};
Json encode_status(const StatusView& view);

// `yours`: whether it is the viewer's own. Never carries the session.
Json encode_request(const robot::Request& request, bool yours);

// ---- Messages of /ws: each has its `type` ------------------------------------------------------------------------

Json pose_message(const robot::PoseEstimate& pose);
Json path_message(const robot::Path& path);
Json people_message(const robot::People& people);
Json belief_message(const robot::Belief& belief);
Json velocity_space_message(const robot::VelocitySpace& space);
Json speech_message(const robot::Speech& speech, robot::Time time);
Json note_message(const robot::Note& note, robot::Time time);
Json visit_message(const robot::VisitEnded& visit);

}  // namespace protocols::web
