#include "protocols/web/encode.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "protocols/web/names.hpp"

namespace protocols::web {
namespace {

Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

double seconds_of(robot::Time time) { return robot::to_seconds(time); }

// Minutes that a tour takes: what is said, and the way at an ordinary pace between the first viewpoints.
double tour_minutes(const robot::Tour& tour, const robot::Museum& museum) {
  constexpr double pace = 0.4;  // m/s, among people
  double seconds = 0.0;
  robot::Point here = museum.home.position();
  for (const auto& id : tour.exhibits) {
    const robot::Exhibit* exhibit = robot::find_exhibit(museum, id);
    if (!exhibit) continue;
    if (!exhibit->viewpoints.empty()) {
      const robot::Point there = exhibit->viewpoints.front().pose.position();
      seconds += robot::distance(here, there) / pace;
      here = there;
    }
    if (!exhibit->narrations.empty()) seconds += exhibit->narrations.front().duration.count();
  }
  return std::ceil(seconds / 60.0);
}

std::set<std::string> languages_of(const robot::Museum& museum) {
  std::set<std::string> languages{"en"};
  for (const auto& [language, text] : museum.title) languages.insert(language);
  for (const auto& exhibit : museum.exhibits) {
    for (const auto& [language, text] : exhibit.title) languages.insert(language);
  }
  return languages;
}

}  // namespace

Json number(double value, int digits) {
  if (!std::isfinite(value)) return nullptr;
  const double scale = std::pow(10.0, digits);
  const double rounded = std::round(value * scale) / scale;
  return std::isfinite(rounded) ? Json(rounded) : Json(value);
}

const std::string& in_language(const robot::Text& text, const std::string& language) {
  static const std::string nothing;
  if (const auto it = text.find(language); it != text.end()) return it->second;
  if (const auto it = text.find("en"); it != text.end()) return it->second;
  return text.empty() ? nothing : text.begin()->second;
}

Json encode(const robot::Text& text) {
  Json json = Json::object();
  for (const auto& [language, words] : text) json[language] = words;
  return json;
}

Json encode(const robot::Pose& pose) {
  return {{"x", number(pose.x)}, {"y", number(pose.y)}, {"theta", number(pose.theta)}};
}

Json encode(robot::Point point) { return Json::array({number(point.x, 3), number(point.y, 3)}); }

Json encode(const std::vector<robot::Point>& points) {
  Json json = Json::array();
  for (const robot::Point point : points) json.push_back(encode(point));
  return json;
}

Json encode_site(const robot::Museum& museum, const robot::Footprint& footprint) {
  Json hazards = Json::array(), areas = Json::array();
  for (const auto& hazard : museum.hazards) {
    hazards.push_back({{"id", hazard.id},
                       {"kind", name_of(hazard.kind)},
                       {"title", in_language(hazard.title, "en")},
                       {"titles", encode(hazard.title)},
                       {"polygon", encode(hazard.polygon)}});
  }
  for (const auto& area : museum.areas) {
    areas.push_back({{"title", in_language(area.title, "en")},
                     {"titles", encode(area.title)},
                     {"x", number(area.label.x)},
                     {"y", number(area.label.y)}});
  }
  const auto& map = museum.map;
  return {
      {"id", museum.id},
      {"title", in_language(museum.title, "en")},
      {"titles", encode(museum.title)},
      {"width", map.width()},
      {"height", map.height()},
      {"resolution", number(map.resolution(), 6)},
      {"origin", {{"x", number(map.origin().x)}, {"y", number(map.origin().y)}}},
      {"boundary", encode(museum.boundary)},
      {"home", encode(museum.home)},
      {"hazards", hazards},
      {"areas", areas},
      {"speed",
       {{"open", museum.speed.open_mps}, {"web_only", museum.speed.web_only_mps}, {"staff", museum.speed.staff_mps}}},
      {"footprint", {{"front", footprint.front}, {"rear", footprint.rear}, {"half_width", footprint.half_width}}},
      {"languages", languages_of(museum)}};
}

Json encode_exhibit(const robot::Exhibit& exhibit, const std::string& language) {
  robot::Point middle;
  for (const robot::Point corner : exhibit.outline) middle = middle + corner;
  if (!exhibit.outline.empty()) {
    middle = (1.0 / static_cast<double>(exhibit.outline.size())) * middle;
  } else if (!exhibit.viewpoints.empty()) {
    middle = exhibit.viewpoints.front().pose.position();
  }
  Json viewpoints = Json::array(), narrations = Json::array();
  for (const auto& viewpoint : exhibit.viewpoints) viewpoints.push_back(encode(viewpoint.pose));
  for (const auto& narration : exhibit.narrations) {
    narrations.push_back({{"text", in_language(narration.text, language)},
                          {"texts", encode(narration.text)},
                          {"picture", text_or_null(narration.picture)},
                          {"duration", number(narration.duration.count(), 1)}});
  }
  return {{"id", exhibit.id},
          {"number", exhibit.number},
          {"title", in_language(exhibit.title, language)},
          {"titles", encode(exhibit.title)},
          {"x", number(middle.x)},
          {"y", number(middle.y)},
          {"summary", in_language(exhibit.summary, language)},
          {"summaries", encode(exhibit.summary)},
          {"outline", encode(exhibit.outline)},
          {"icon", text_or_null(exhibit.icon)},
          {"picture", text_or_null(exhibit.picture)},
          {"viewpoints", viewpoints},
          {"narrations", narrations}};
}

Json encode_tour(const robot::Tour& tour, const robot::Museum& museum, const std::string& language) {
  return {{"id", tour.id},
          {"title", in_language(tour.title, language)},
          {"titles", encode(tour.title)},
          {"summary", in_language(tour.summary, language)},
          {"summaries", encode(tour.summary)},
          {"exhibits", tour.exhibits},
          {"minutes", tour_minutes(tour, museum)}};
}

Json encode_map(const robot::OccupancyGrid& map, const std::string& url) {
  return {{"width", map.width()},
          {"height", map.height()},
          {"resolution", number(map.resolution(), 6)},
          {"origin", {{"x", number(map.origin().x)}, {"y", number(map.origin().y)}}},
          {"url", url}};
}

Json encode_status(const StatusView& view) {
  const robot::Status& status = view.status;
  Json pose = nullptr, sigma = nullptr, tour = nullptr;
  if (view.pose) {
    pose = encode(view.pose->map_from_base);
    sigma = {{"position", number(view.pose->sigma_position)}, {"theta", number(view.pose->sigma_theta)}};
  }
  if (!status.tour.empty()) {
    tour = {{"id", status.tour}, {"stop", status.stop_number}, {"stops", status.stop_count}};
  }
  const std::string& sentence = in_language(view.sentence, "en");
  const std::string& detail = in_language(view.detail, "en");
  return {
      {"time", number(seconds_of(view.time), 3)},
      {"pose", pose},
      {"pose_sigma", sigma},
      {"mode", name_of(status.mode)},
      {"activity", name_of(status.activity)},
      {"why", name_of(status.why)},
      {"reason", detail.empty() ? sentence : sentence + " " + detail},
      {"sentence", encode(view.sentence)},
      {"detail", encode(view.detail)},
      {"exhibit", text_or_null(status.exhibit)},
      {"point", status.point ? Json{{"x", number(status.point->x)}, {"y", number(status.point->y)}} : Json(nullptr)},
      {"requester", text_or_null(status.requester)},
      {"tour", tour},
      {"distance_to_go", number(status.distance_to_go, 2)},
      {"seconds_to_go", number(status.seconds_to_go, 1)},
      {"people_near", status.people_near},
      {"battery", status.battery_fraction < 0.0 ? Json(nullptr) : number(status.battery_fraction, 3)},
      {"speed_limit", number(status.speed_limit, 3)},
      {"lost", status.lost},
      {"stopped", status.activity == robot::Activity::stopped}};
}

Json encode_request(const robot::Request& request, bool yours) {
  Json exhibit = nullptr, viewpoint = nullptr, point = nullptr;
  if (const auto* target = std::get_if<robot::ExhibitTarget>(&request.target)) {
    exhibit = target->exhibit;
    if (target->viewpoint) viewpoint = *target->viewpoint;
  } else if (const auto* place = std::get_if<robot::PointTarget>(&request.target)) {
    point = {{"x", number(place->point.x)},
             {"y", number(place->point.y)},
             {"theta", place->theta ? number(*place->theta) : Json(nullptr)}};
  }
  return {{"id", request.id},
          {"state", name_of(request.state)},
          {"name", text_or_null(request.requester.name)},
          {"channel", name_of(request.requester.channel)},
          {"exhibit", exhibit},
          {"viewpoint", viewpoint},
          {"point", point},
          {"reason", text_or_null(request.reason)},
          {"position", request.position},
          {"eta_seconds", number(request.eta_seconds, 0)},
          {"tour", text_or_null(request.tour)},
          {"asked", number(seconds_of(request.asked), 3)},
          {"yours", yours}};
}

Json pose_message(const robot::PoseEstimate& pose) {
  return {{"type", "pose"},
          {"time", number(seconds_of(pose.time), 3)},
          {"x", number(pose.map_from_base.x)},
          {"y", number(pose.map_from_base.y)},
          {"theta", number(pose.map_from_base.theta)},
          {"sigma_position", number(pose.sigma_position)},
          {"sigma_theta", number(pose.sigma_theta)},
          {"localized", pose.localized},
          {"linear", number(pose.twist.linear, 3)},
          {"angular", number(pose.twist.angular, 3)}};
}

Json path_message(const robot::Path& path) {
  return {{"type", "path"}, {"points", encode(path.points)}, {"length", number(path.length, 2)}};
}

Json people_message(const robot::People& people) {
  Json seen = Json::array();
  for (const auto& person : people.people) seen.push_back(encode(person.position));
  return {{"type", "people"}, {"time", number(seconds_of(people.time), 3)}, {"people", seen}};
}

Json belief_message(const robot::Belief& belief) {
  Json samples = Json::array();
  for (const auto& pose : belief.samples) {
    samples.push_back(Json::array({number(pose.x, 3), number(pose.y, 3), number(pose.theta, 3)}));
  }
  return {{"type", "belief"}, {"time", number(seconds_of(belief.time), 3)}, {"samples", samples}};
}

Json velocity_space_message(const robot::VelocitySpace& space) {
  Json linear = Json::array(), angular = Json::array(), score = Json::array();
  for (const double v : space.linear) linear.push_back(number(v, 3));
  for (const double w : space.angular) angular.push_back(number(w, 3));
  for (const float s : space.score) score.push_back(number(s, 3));
  return {{"type", "velocity_space"},
          {"linear", linear},
          {"angular", angular},
          {"score", score},
          {"chosen", {{"linear", number(space.chosen.linear, 3)}, {"angular", number(space.chosen.angular, 3)}}}};
}

Json speech_message(const robot::Speech& speech, robot::Time time) {
  return {{"type", "speech"},
          {"cue", name_of(speech.cue)},
          {"exhibit", text_or_null(speech.exhibit)},
          {"narration", speech.narration},
          {"text", encode(speech.text)},
          {"duration", number(speech.duration.count(), 1)},
          {"time", number(seconds_of(time), 3)}};
}

Json note_message(const robot::Note& note, robot::Time time) {
  return {{"type", "note"},
          {"severity", name_of(note.severity)},
          {"code", note.code},
          {"text", note.text},
          {"time", number(seconds_of(time), 3)}};
}

Json visit_message(const robot::VisitEnded& visit) {
  return {{"type", "visit"},
          {"exhibit", text_or_null(visit.exhibit)},
          {"requests", visit.requests},
          {"arrived", number(seconds_of(visit.arrived), 3)},
          {"left", number(seconds_of(visit.left), 3)},
          {"complete", visit.complete}};
}

}  // namespace protocols::web
