#include "server/api/view.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <set>

#include "protocols/web/encode.hpp"
#include "protocols/web/frames.hpp"
#include "robot/interaction/words.hpp"

namespace server {
namespace {

using protocols::web::Json;
using protocols::web::number;

constexpr std::size_t ended_kept = 200;
constexpr std::size_t ended_listed = 20;
constexpr std::size_t notes_kept = 50;

bool is_open(const robot::Request& request) {
  return request.state == robot::RequestState::pending || request.state == robot::RequestState::active;
}

// Whether a viewer should hear of it at once, and not with the next regular message.
bool differs(const robot::Status& a, const robot::Status& b) {
  return a.activity != b.activity || a.why != b.why || a.mode != b.mode || a.exhibit != b.exhibit || a.tour != b.tour ||
         a.requester != b.requester || a.stop_number != b.stop_number || a.lost != b.lost || a.point != b.point;
}

bool due(Clock::time_point& last, std::chrono::milliseconds interval) {
  const auto now = Clock::now();
  if (now - last < interval) return false;
  last = now;
  return true;
}

std::string iso_time(WallSeconds seconds) {
  const auto whole = static_cast<std::time_t>(seconds);
  std::tm parts{};
  gmtime_r(&whole, &parts);
  char text[32];
  return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

}  // namespace

WallSeconds wall_now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

View::View(const robot::Museum& museum, Hub& hub, Journal& journal, StoredStatistics past,
           const std::vector<StoredRequest>& requests)
    : museum_(museum), hub_(hub), journal_(journal), statistics_(std::move(past)) {
  const WallSeconds wall = wall_now();
  for (const StoredRequest& stored : requests) {
    robot::Request request = stored.request;
    request.asked = robot::Time{} - robot::Seconds(wall - stored.asked);  // before this run began
    if (!is_open(request)) ended_.push_back(request.id);
    requests_[request.id] = std::move(request);
  }
}

void View::take(const std::vector<robot::Output>& outputs, robot::Time now) {
  now_ = now;
  for (const robot::Output& output : outputs) {
    std::visit([this](const auto& said) { tell(said); }, output);
  }
  publish();
}

// Tells what changed, each topic at its own pace; what is held back goes out with a later batch.
void View::publish() {
  if (pose_dirty_ && due(pose_told_, std::chrono::milliseconds(30))) {
    pose_dirty_ = false;
    hub_.state(index(Topic::pose), protocols::web::pose_message(*pose_));
  }
  if (people_dirty_ && due(people_told_, std::chrono::milliseconds(90))) {
    people_dirty_ = false;
    hub_.state(index(Topic::people), protocols::web::people_message(people_));
  }
  if (status_dirty_ && due(status_told_, std::chrono::milliseconds(status_urgent_ ? 0 : 250))) {
    status_dirty_ = status_urgent_ = false;
    Json message = {{"type", "status"}};
    message.update(status_json());
    hub_.state(index(Topic::status), message);
  }
  if (queue_dirty_ && due(queue_told_, std::chrono::milliseconds(queue_urgent_ ? 0 : 500))) publish_queue();
}

void View::tell(const robot::PoseEstimate& pose) {
  count_travel(pose);
  pose_ = pose;
  pose_dirty_ = true;
}

void View::tell(const robot::Belief& belief) {
  if (hub_.wanted(Topic::belief)) hub_.state(index(Topic::belief), protocols::web::belief_message(belief));
}

void View::tell(const robot::ScanView& scan) {
  const Topic topic = scan.laser == robot::LaserId::front ? Topic::scan_front : Topic::scan_rear;
  if (hub_.wanted(topic)) hub_.state_binary(index(topic), protocols::web::encode_scan(scan));
}

void View::tell(const robot::People& people) {
  people_ = people;
  people_dirty_ = true;
}

void View::tell(const robot::Path& path) { hub_.state(index(Topic::path), protocols::web::path_message(path)); }

void View::tell(const robot::Status& status) {
  status_urgent_ = status_urgent_ || differs(status, status_);
  status_dirty_ = true;
  status_ = status;
}

void View::tell(const robot::VelocitySpace& space) {
  if (hub_.wanted(Topic::velocity_space)) {
    hub_.state(index(Topic::velocity_space), protocols::web::velocity_space_message(space));
  }
}

void View::tell(const robot::RequestChanged& changed) {
  robot::Request request = changed.request;
  const auto known = requests_.find(request.id);
  const bool is_new = known == requests_.end();
  const bool state_changed = is_new || known->second.state != request.state || known->second.reason != request.reason;
  if (!is_new) request.asked = known->second.asked;  // of the run in which it was asked
  if (is_new) ++statistics_.requests;
  if (!is_open(request) && (is_new || is_open(known->second))) {
    ended_.push_back(request.id);
    if (request.state == robot::RequestState::fulfilled) ++statistics_.fulfilled;
    if (request.state == robot::RequestState::failed) ++statistics_.failed;
  }
  if (is_open(request)) std::erase(ended_, request.id);
  requests_[request.id] = request;
  while (ended_.size() > ended_kept) {
    requests_.erase(ended_.front());
    ended_.pop_front();
  }
  queue_dirty_ = true;
  if (!state_changed) return;
  queue_urgent_ = true;
  keep(request);
  Json message = {{"type", "request"}, {"request", protocols::web::encode_request(request, false)}};
  Json own = {{"type", "request"}, {"request", protocols::web::encode_request(request, true)}};
  hub_.event(Topic::request, std::move(message), request.requester.session, std::move(own));
}

void View::tell(const robot::Speech& speech) {
  hub_.event(Topic::speech, protocols::web::speech_message(speech, now_));
}

void View::tell(const robot::VisitEnded& visit) {
  const StoredVisit stored{visit.exhibit, robot::Seconds(visit.left - visit.arrived).count(), visit.complete,
                           wall_now()};
  journal_.write([stored](Store& store) { store.add_visit(stored); });
  if (!visit.exhibit.empty()) {
    auto& exhibits = statistics_.exhibits;
    auto it = std::find_if(exhibits.begin(), exhibits.end(), [&](const auto& e) { return e.exhibit == visit.exhibit; });
    if (it == exhibits.end()) it = exhibits.insert(exhibits.end(), ExhibitVisits{visit.exhibit, 0, 0.0});
    ++it->visits;
    it->seconds += stored.seconds;
  }
  hub_.event(Topic::visit, protocols::web::visit_message(visit));
}

void View::tell(const robot::Note& note) {
  const WallSeconds wall = wall_now();
  journal_.write([note, wall](Store& store) { store.add_note(note, wall); });
  Json message = protocols::web::note_message(note, now_);
  notes_.push_back(message);
  notes_.back().erase("type");
  if (notes_.size() > notes_kept) notes_.pop_front();
  hub_.event(Topic::note, std::move(message));
}

void View::keep(const robot::Request& request) {
  const WallSeconds wall = wall_now();
  journal_.write([request, wall](Store& store) { store.put_request(request, wall); });
}

void View::count_travel(const robot::PoseEstimate& pose) {
  if (!pose_) return;
  const double seconds = robot::Seconds(pose.time - pose_->time).count();
  if (!(seconds > 0.0) || seconds > 1.0) return;
  unsaved_seconds_ += seconds;
  unsaved_distance_ += std::abs(pose.twist.linear) * seconds;
}

void View::save_travel() {
  if (unsaved_seconds_ <= 0.0) return;
  const double metres = std::exchange(unsaved_distance_, 0.0), seconds = std::exchange(unsaved_seconds_, 0.0);
  statistics_.distance += metres;
  statistics_.seconds += seconds;
  journal_.write([metres, seconds](Store& store) { store.add_travel(metres, seconds); });
}

const robot::Request* View::request(robot::RequestId id) const {
  const auto it = requests_.find(id);
  return it == requests_.end() ? nullptr : &it->second;
}

std::size_t View::open_requests() const { return requests_.size() - ended_.size(); }

bool View::takes_part(const std::string& session) const {
  return std::any_of(requests_.begin(), requests_.end(), [&](const auto& entry) {
    const robot::Request& request = entry.second;
    return is_open(request) && !session.empty() && request.requester.session == session &&
           (request.state == robot::RequestState::active || (!request.tour.empty() && request.tour == status_.tour));
  });
}

std::vector<const robot::Request*> View::listed() const {
  std::vector<const robot::Request*> list;
  for (const auto& [id, request] : requests_) {
    if (is_open(request)) list.push_back(&request);
  }
  std::stable_sort(list.begin(), list.end(), [](const auto* a, const auto* b) {
    const bool first = a->state == robot::RequestState::active, second = b->state == robot::RequestState::active;
    return first != second ? first : a->position < b->position;
  });
  std::size_t count = 0;
  for (auto id = ended_.rbegin(); id != ended_.rend() && count < ended_listed; ++id, ++count) {
    list.push_back(&requests_.at(*id));
  }
  return list;
}

void View::publish_queue() {
  queue_dirty_ = queue_urgent_ = false;
  std::set<std::string> sessions{""};
  for (const auto* request : listed()) sessions.insert(request->requester.session);
  std::map<std::string, Json> messages;
  for (const auto& session : sessions) messages[session] = {{"type", "queue"}, {"requests", queue_json(session)}};
  const Json shared = messages.extract("").mapped();
  hub_.state(index(Topic::queue), shared, messages);
}

Json View::status_json() const {
  return protocols::web::encode_status(
      {now_, status_, pose_, robot::status_sentence(status_, museum_), robot::status_detail(status_, museum_)});
}

Json View::queue_json(const std::string& session) const {
  Json list = Json::array();
  for (const auto* request : listed()) {
    list.push_back(protocols::web::encode_request(*request, !session.empty() && request->requester.session == session));
  }
  return list;
}

Json View::statistics_json(std::size_t viewers) const {
  const auto ended = statistics_.fulfilled + statistics_.failed;
  Json exhibits = Json::array();
  for (const auto& exhibit : statistics_.exhibits) {
    exhibits.push_back({{"id", exhibit.exhibit}, {"visits", exhibit.visits}, {"seconds", number(exhibit.seconds, 1)}});
  }
  return {
      {"since", iso_time(statistics_.since)},
      {"distance_m", number(statistics_.distance + unsaved_distance_, 1)},
      {"hours", number((statistics_.seconds + unsaved_seconds_) / 3600.0, 4)},
      {"requests", statistics_.requests},
      {"fulfilled", statistics_.fulfilled},
      {"success_rate",
       ended == 0 ? Json(nullptr) : number(static_cast<double>(statistics_.fulfilled) / static_cast<double>(ended))},
      {"exhibits", exhibits},
      {"viewers", viewers}};
}

Json View::notes_json() const {
  Json list = Json::array();
  for (auto note = notes_.rbegin(); note != notes_.rend(); ++note) list.push_back(*note);
  return list;
}

Json View::localization_json() const {
  if (!pose_) return {{"localized", false}, {"sigma_position", nullptr}, {"sigma_theta", nullptr}, {"particles", 0}};
  return {{"localized", pose_->localized},
          {"sigma_position", number(pose_->sigma_position)},
          {"sigma_theta", number(pose_->sigma_theta)},
          {"particles", pose_->particles}};
}

}  // namespace server
