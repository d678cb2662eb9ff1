// A Web on a free port in a thread of its own, with a small museum and a robot that answers as it is told to.
#pragma once

#include <future>
#include <memory>
#include <thread>

#include "server/api/web.hpp"
#include "tests/support/http_client.hpp"
#include "tests/support/small_museum.hpp"
#include "tests/support/web_socket_client.hpp"

namespace testing_support {

// Answers requests by the museum, keeps them in order, forgets nothing. Only what the web needs of a robot.
class FakeRobot {
 public:
  std::vector<robot::Output> handle(const robot::Event& event) {
    std::vector<robot::Output> out;
    heard.push_back(event);
    if (silent) return out;
    if (const auto* ask = std::get_if<robot::RequestVisit>(&event)) visit(*ask, out);
    if (const auto* end = std::get_if<robot::CancelRequest>(&event)) cancel(*end, out);
    if (const auto* tour = std::get_if<robot::StartTour>(&event)) start(*tour, out);
    if (const auto* answer = std::get_if<robot::AnswerTour>(&event)) {
      out.push_back(robot::Answer{
          answer->ticket, status.tour.empty() ? robot::Refusal::nothing_to_answer : robot::Refusal::none, {}});
      if (answer->answer == robot::TourAnswer::end_tour) status.tour.clear();
    }
    if (std::get_if<robot::Stop>(&event)) status.activity = robot::Activity::stopped;
    if (std::get_if<robot::Resume>(&event)) status.activity = robot::Activity::idle;
    if (const auto* mode = std::get_if<robot::SetMode>(&event)) status.mode = mode->mode;
    out.push_back(status);
    return out;
  }

  robot::Museum museum = small_museum();
  robot::Status status;
  std::map<robot::RequestId, robot::Request> requests;
  robot::RequestId next_id = 1;
  std::vector<robot::Event> heard;
  bool silent = false;

 private:
  robot::Refusal judge(const robot::Target& target) const {
    if (const auto* exhibit = std::get_if<robot::ExhibitTarget>(&target)) {
      const robot::Exhibit* found = robot::find_exhibit(museum, exhibit->exhibit);
      if (!found) return robot::Refusal::unknown_exhibit;
      const auto views = static_cast<int>(found->viewpoints.size());
      return exhibit->viewpoint && *exhibit->viewpoint >= views ? robot::Refusal::unknown_viewpoint
                                                                : robot::Refusal::none;
    }
    const auto point = std::get<robot::PointTarget>(target).point;
    if (!museum.map.contains(point)) return robot::Refusal::off_the_map;
    return robot::is_free(museum.map[museum.map.cell(point)]) ? robot::Refusal::none : robot::Refusal::inside_obstacle;
  }
  void visit(const robot::RequestVisit& ask, std::vector<robot::Output>& out) {
    const robot::Refusal refusal = judge(ask.target);
    if (refusal != robot::Refusal::none) return out.push_back(robot::Answer{ask.ticket, refusal, {}});
    out.push_back(robot::Answer{ask.ticket, refusal, {add(ask.requester, ask.target, "", out)}});
  }
  robot::RequestId add(const robot::Requester& requester, const robot::Target& target, const std::string& tour,
                       std::vector<robot::Output>& out) {
    robot::Request request;
    request.id = next_id++;
    request.requester = requester;
    request.target = target;
    request.position = static_cast<int>(requests.size()) + 1;
    request.tour = tour;
    requests[request.id] = request;
    out.push_back(robot::RequestChanged{request});
    return request.id;
  }
  void start(const robot::StartTour& ask, std::vector<robot::Output>& out) {
    const robot::Tour* tour = robot::find_tour(museum, ask.tour);
    if (!tour) return out.push_back(robot::Answer{ask.ticket, robot::Refusal::unknown_tour, {}});
    std::vector<robot::RequestId> ids;
    for (const auto& id : tour->exhibits)
      ids.push_back(add(ask.requester, robot::ExhibitTarget{id, {}}, tour->id, out));
    status.tour = tour->id;
    status.stop_number = 1;
    status.stop_count = static_cast<int>(ids.size());
    out.push_back(robot::Answer{ask.ticket, robot::Refusal::none, ids});
  }
  void cancel(const robot::CancelRequest& end, std::vector<robot::Output>& out) {
    const auto it = requests.find(end.id);
    robot::Refusal refusal = robot::Refusal::none;
    if (it == requests.end()) {
      refusal = robot::Refusal::unknown_request;
    } else if (it->second.state == robot::RequestState::cancelled) {
      refusal = robot::Refusal::already_over;
    } else if (!end.staff && it->second.requester.session != end.session) {
      refusal = robot::Refusal::not_yours;
    } else {
      it->second.state = robot::RequestState::cancelled;
      out.push_back(robot::RequestChanged{it->second});
    }
    out.push_back(robot::Answer{end.ticket, refusal, {end.id}});
  }
};

class WebHouse {
 public:
  explicit WebHouse(server::WebOptions options = {}) {
    options.address = "127.0.0.1";
    options.port = 0;
    if (options.cameras.empty()) {
      options.cameras = {{"front", {{"en", "On board"}}, server::CameraKind::onboard, 320, 240},
                         {"hall", {{"en", "Hall"}, {"de", "Halle"}}, server::CameraKind::wall, 320, 240}};
    }
    web_ = std::make_unique<server::Web>(context_, small_museum(), options, [this](robot::Event event) {
      net::post(context_, [this, event = std::move(event)] {
        auto outputs = robot.handle(event);
        if (!robot.silent) web_->take(std::move(outputs), now_);
      });
    });
    web_->start();
    port = web_->port();
    thread_ = std::thread([this] { context_.run(); });
  }
  ~WebHouse() {
    on_web([this] { web_->stop(); });
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // farewells go out
    context_.stop();
    thread_.join();
    web_.reset();
  }

  // Runs on the web's thread and waits for it.
  void on_web(std::function<void()> work) {
    std::promise<void> done;
    net::post(context_, [&] {
      work();
      done.set_value();
    });
    done.get_future().wait();
  }
  void say(std::vector<robot::Output> outputs, double seconds = 1.0) {
    on_web([&] {
      now_ = robot::from_seconds(seconds);
      web_->take(std::move(outputs), now_);
    });
  }
  server::Web& web() { return *web_; }

  FakeRobot robot;  // touch it inside on_web only
  unsigned short port = 0;

 private:
  net::io_context context_;
  // A web that has stopped leaves nothing to run, and the thread must still take work.
  net::executor_work_guard<net::io_context::executor_type> working_ = net::make_work_guard(context_);
  robot::Time now_;
  std::unique_ptr<server::Web> web_;
  std::thread thread_;
};

}  // namespace testing_support
