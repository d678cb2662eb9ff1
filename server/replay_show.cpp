#include "server/replay_show.hpp"

#include <boost/asio/signal_set.hpp>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "robot/body.hpp"
#include "robot/perception/people.hpp"
#include "server/api/web.hpp"

namespace server {
namespace {

std::string name_of(const tools::ReplaySetup& setup) {
  return std::filesystem::path(setup.log.name).filename().string();
}

// A museum of nothing but the log's map. Home is where the drive begins.
robot::Museum museum_of(const tools::ReplaySetup& setup) {
  robot::Museum museum;
  museum.id = "recording";
  const std::string log = name_of(setup);
  museum.title = {{"en", "Recording: " + log}, {"de", "Aufzeichnung: " + log}};
  museum.map = setup.map;
  if (setup.start) museum.home = *setup.start;
  return museum;
}

WebOptions web_options(const ShowOptions& options) {
  WebOptions web;
  web.address = options.bind;
  web.port = options.port;
  web.pages = std::filesystem::exists(options.pages) ? options.pages.string() : "";
  web.footprint = robot::standard_body().footprint;
  return web;
}

class ReplayShow {
 public:
  ReplayShow(tools::ReplaySetup setup, const ShowOptions& options)
      : setup_(std::move(setup)),
        speed_(options.speed),
        web_(io_, museum_of(setup_), web_options(options), [this](const robot::Event& event) { refuse(event); }),
        replay_(setup_) {
    if (!replay_.next()) throw std::invalid_argument("the log has no scans between --from and --to");
  }

  void run() {
    web_.start();
    begin();
    breathe();
    net::signal_set signals(io_, SIGINT, SIGTERM);
    signals.async_wait([this](error_code, int) { finish(); });
    std::cout << "Docent shows " << name_of(setup_) << " on http://localhost:" << web_.port() << std::endl;
    io_.run();
  }

 private:
  // Time as the web hears it: since the show began, and never backwards when the log begins again.
  robot::Time now() const { return robot::Time{} + robot::Seconds(Clock::now() - zero_); }

  void begin() {
    first_ = replay_.step().time;
    path_m_ = replay_.step().path_m;
    began_ = Clock::now();
    await_step();
  }

  // Holds a step back until its time has come.
  void await_step() {
    const auto after = std::chrono::duration<double>((replay_.step().time - first_) / speed_);
    next_.expires_at(began_ + std::chrono::duration_cast<Clock::duration>(after));
    next_.async_wait([this](error_code error) {
      if (error) return;
      tell(replay_.step());
      if (replay_.next()) return await_step();
      again();
    });
  }

  void again() {
    next_.expires_after(std::chrono::seconds(3));
    next_.async_wait([this](error_code error) {
      if (error) return;
      replay_ = tools::Replay(setup_);
      people_ = robot::PeopleTracker();
      if (replay_.next()) begin();
    });
  }

  void tell(const tools::ReplayStep& step) {
    const robot::Time time = now();
    robot::PoseEstimate pose = step.pose;
    robot::ScanView scan = step.scan;
    robot::Belief belief = replay_.belief();
    people_.add(scan);
    robot::People people = people_.people(scan.time);
    pose.time = scan.time = belief.time = people.time = time;
    const bool moved = step.path_m > path_m_ + 0.005;
    path_m_ = step.path_m;
    status_.activity = !pose.localized ? robot::Activity::localizing
                       : moved         ? robot::Activity::driving
                                       : robot::Activity::idle;
    status_.why = robot::Why::recording;
    status_.lost = step.lost;
    status_.people_near = robot::people_within(people, pose.map_from_base.position(), 3.0);
    web_.take({pose, scan, belief, people, status_}, time);
  }

  // The web holds a robot that says nothing for unhealthy; between scans this one still lives.
  void breathe() {
    breath_.expires_after(std::chrono::milliseconds(250));
    breath_.async_wait([this](error_code error) {
      if (error) return;
      web_.take({}, now());
      breathe();
    });
  }

  void refuse(const robot::Event& event) {
    net::post(io_, [this, event] {
      std::visit(
          [this](const auto& asked) {
            if constexpr (requires { asked.ticket; }) {
              web_.take({robot::Answer{asked.ticket, robot::Refusal::recording, {}}}, now());
            }
          },
          event);
    });
  }

  void finish() {
    breath_.cancel();
    next_.cancel();
    web_.stop();
    next_.expires_after(std::chrono::milliseconds(300));  // farewells go out
    next_.async_wait([this](error_code) { io_.stop(); });
  }

  net::io_context io_{1};
  tools::ReplaySetup setup_;
  double speed_;
  Clock::time_point zero_ = Clock::now();
  Web web_;
  tools::Replay replay_;
  robot::PeopleTracker people_;
  robot::Status status_;
  double path_m_ = 0.0;  // of odometry, at the last step
  double first_ = 0.0;   // s on the logger's clock
  Clock::time_point began_;
  net::steady_timer next_{io_};
  net::steady_timer breath_{io_};
};

}  // namespace

int show_replay(const tools::ReplayOptions& replay, const ShowOptions& options) {
  try {
    ReplayShow(tools::prepare_replay(replay), options).run();
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error("cannot listen on " + options.bind + ":" + std::to_string(options.port) + ": " +
                             error.code().message() + "; choose another port with --port");
  }
  return 0;
}

void add_replay_command(CLI::App& app) {
  auto options = std::make_shared<ShowOptions>();
  auto* command = tools::add_replay_command(app, [options](const tools::ReplayOptions& replay) {
    if (options->serve) show_replay(replay, *options);
    return options->serve;
  });
  command->add_flag("--serve", options->serve, "show the replay on the page instead of reporting");
  command->add_option("--port", options->port, "with --serve; 0: any free one")->capture_default_str();
  command->add_option("--bind", options->bind, "with --serve: address to listen on")->capture_default_str();
  command->add_option("--pages", options->pages, "with --serve: folder of the built pages")->capture_default_str();
  command->add_option("--speed", options->speed, "with --serve: times as fast as it was recorded")
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
}

}  // namespace server
