// What the web knows of the robot: the newest of everything it said. Each batch is told to the viewers (encoded once,
// and only what somebody watches) and what must last goes to the journal. Belongs to the web thread.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "robot/museum.hpp"
#include "robot/outputs.hpp"
#include "server/api/journal.hpp"
#include "server/stream/hub.hpp"

namespace server {

WallSeconds wall_now();

class View {
 public:
  using Json = protocols::web::Json;

  // `past`: statistics of earlier runs; `requests`: those still open and the last that ended, newest last.
  View(const robot::Museum& museum, Hub& hub, Journal& journal, StoredStatistics past,
       const std::vector<StoredRequest>& requests);

  void take(const std::vector<robot::Output>& outputs, robot::Time now);
  // Writes the distance driven since the last time. Call every few seconds and at the end.
  void save_travel();

  robot::Time now() const { return now_; }
  const robot::Status& status() const { return status_; }
  const std::optional<robot::PoseEstimate>& pose() const { return pose_; }
  const robot::Request* request(robot::RequestId id) const;
  // Requests waiting or active.
  std::size_t open_requests() const;
  // Does this session have an open request of this tour, or the one that is being served now?
  bool takes_part(const std::string& session) const;

  Json status_json() const;
  // Active ones, then waiting ones in their order, then the last 20 that ended.
  Json queue_json(const std::string& session) const;
  Json statistics_json(std::size_t viewers) const;
  Json notes_json() const;
  Json localization_json() const;

 private:
  void tell(const robot::PoseEstimate& pose);
  void tell(const robot::Belief& belief);
  void tell(const robot::ScanView& scan);
  void tell(const robot::People& people);
  void tell(const robot::Path& path);
  void tell(const robot::Status& status);
  void tell(const robot::VelocitySpace& space);
  void tell(const robot::RequestChanged& changed);
  void tell(const robot::Speech& speech);
  void tell(const robot::VisitEnded& visit);
  void tell(const robot::Note& note);
  template <typename Other>
  void tell(const Other&) {}  // wheels and answers are not for viewers

  std::vector<const robot::Request*> listed() const;
  void publish();
  void publish_queue();
  void keep(const robot::Request& request);
  void count_travel(const robot::PoseEstimate& pose);

  const robot::Museum& museum_;
  Hub& hub_;
  Journal& journal_;

  robot::Time now_;
  robot::Status status_;
  std::optional<robot::PoseEstimate> pose_;
  std::map<robot::RequestId, robot::Request> requests_;  // open ones, and the last that ended
  std::deque<robot::RequestId> ended_;                   // in the order of their end
  std::deque<Json> notes_;
  StoredStatistics statistics_;
  double unsaved_distance_ = 0.0;  // m
  double unsaved_seconds_ = 0.0;

  robot::People people_;
  bool pose_dirty_ = false, people_dirty_ = false, status_dirty_ = false, queue_dirty_ = false;
  bool status_urgent_ = false, queue_urgent_ = false;  // more than a number changed
  Clock::time_point pose_told_, people_told_, status_told_, queue_told_;
};

}  // namespace server
