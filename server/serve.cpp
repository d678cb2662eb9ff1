#include "server/serve.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/signal_set.hpp>
#include <boost/asio/thread_pool.hpp>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <sstream>
#include <thread>
#include <utility>

#include "protocols/files/site_file.hpp"
#include "server/api/web.hpp"
#include "server/cameras_room.hpp"
#include "server/devices/simulated_hardware.hpp"
#include "server/recording_desk.hpp"
#include "server/runner.hpp"
#include "server/tools/report.hpp"
#include "server/wires.hpp"

namespace server {
namespace {

std::optional<robot::Pose> start_pose(const std::string& text, const robot::Museum& museum) {
  if (text == "global") return std::nullopt;
  if (text == "home") return museum.home;
  robot::Pose pose;
  char comma1 = 0, comma2 = 0;
  std::istringstream in(text);
  if (!(in >> pose.x >> comma1 >> pose.y >> comma2 >> pose.theta) || comma1 != ',' || comma2 != ',' ||
      !robot::is_finite(pose)) {
    throw std::runtime_error("--start takes global, home, or x,y,degrees, not '" + text + "'");
  }
  pose.theta = robot::radians(pose.theta);
  return pose;
}

// A thread of its own for an io_context, ended by its owner.
class LoopThread {
 public:
  explicit LoopThread(net::io_context& io) : io_(io), guard_(io.get_executor()), thread_([&io] { io.run(); }) {}
  ~LoopThread() {
    guard_.reset();
    io_.stop();
    thread_.join();
  }
  LoopThread(const LoopThread&) = delete;
  LoopThread& operator=(const LoopThread&) = delete;

 private:
  net::io_context& io_;
  net::executor_work_guard<net::io_context::executor_type> guard_;
  std::thread thread_;
};

// Everything that one run of the server consists of.
class Server {
 public:
  explicit Server(const ServeOptions& options) : options_(options), museum_(files::load_site(options.site)) {
    const bool simulated = options.base.empty();
    if (simulated) {
      const robot::simulation::WorldConfig world{
          .visitors = options.visitors.value_or(museum_.visitors), .start = {}, .drive = {}, .sensors = {}};
      hardware_ =
          std::make_unique<devices::SimulatedHardware>(world_io_.get_executor(), museum_, body_, world, options.seed);
    }
    web_ = std::make_unique<Web>(web_io_, museum_, web_options(),
                                 [this](robot::Event event) { runner_->submit(std::move(event)); });
    robot::Config config{
        .body = body_, .localizer = {}, .start = start_pose(options.start, museum_), .seed = options.seed};
    if (options.record) desk_ = std::make_unique<RecordingDesk>(*options.record, museum_.id, config);
    runner_ = std::make_unique<Runner>(robot_io_, robot::Robot(museum_, config), sinks(), zero_);
    wires_ = std::make_unique<Wires>(
        robot_io_, paths(), body_, [this] { return runner_->now(); },
        [this](robot::Event event) { runner_->handle(std::move(event)); });
    if (hardware_) {
      cameras_ = std::make_unique<CamerasRoom>(*hardware_, *web_, museum_, web_io_, pool_);
    }
  }

  void run() {
    runner_->handle(web_->remember());
    listen();
    net::post(robot_io_, [this] {
      wires_->start();
      runner_->start();
    });
    if (cameras_) cameras_->start();
    watch_health();
    net::signal_set signals(web_io_, SIGINT, SIGTERM);
    signals.async_wait([this](error_code, int) { finish(); });
    std::cout << "Docent serves " << museum_.title.at("en") << " on http://localhost:" << web_->port() << std::endl;
    spdlog::info("serving {} on port {}", museum_.id, web_->port());

    std::unique_ptr<LoopThread> world;
    if (hardware_) world = std::make_unique<LoopThread>(world_io_);
    LoopThread robot(robot_io_);
    web_io_.run();
    pool_.join();
  }

 private:
  WebOptions web_options() const {
    WebOptions web;
    web.address = options_.bind;
    web.port = options_.port;
    web.pages = std::filesystem::exists(options_.pages) ? options_.pages.string() : "";
    web.site = options_.site.string();
    web.database = options_.database.string();
    web.staff_password = options_.staff_password;
    web.footprint = body_.footprint;
    if (hardware_) web.cameras = CamerasRoom::infos(museum_);
    return web;
  }

  LinePaths paths() const {
    if (!hardware_) return {options_.base, options_.laser_front, options_.laser_rear};
    return {hardware_->path(robot::Device::base), hardware_->path(robot::Device::laser_front),
            hardware_->path(robot::Device::laser_rear)};
  }

  Runner::Sinks sinks() {
    Runner::Sinks sinks;
    sinks.wheels = [this](const robot::WheelCommand& command) { wires_->drive(command); };
    sinks.motors = [this](const robot::EnableMotors& motors) { wires_->enable(motors); };
    sinks.viewers = [this](std::vector<robot::Output> outputs, robot::Time now) {
      for (const robot::Output& output : outputs) hear(output);
      net::post(web_io_, [this, outputs = std::move(outputs), now] { web_->take(outputs, now); });
    };
    if (desk_) {
      sinks.input = [this](const robot::Input& input) { desk_->input(input); };
      sinks.output = [this](const robot::Output& output, robot::Time now) { desk_->output(output, now); };
    }
    return sinks;
  }

  void listen() {
    try {
      web_->start();
    } catch (const boost::system::system_error& error) {
      throw std::runtime_error("cannot listen on " + options_.bind + ":" + std::to_string(options_.port) + ": " +
                               error.code().message() + "; choose another port with --port");
    }
  }

  // What the simulated visitors hear, and what staff should find in the log.
  void hear(const robot::Output& output) {
    if (const auto* speech = std::get_if<robot::Speech>(&output); speech && hardware_) {
      hardware_->with_world([said = *speech](robot::simulation::World& world) { world.hear(said); });
    }
    if (const auto* note = std::get_if<robot::Note>(&output)) {
      const auto level = note->severity == robot::Severity::info ? spdlog::level::info : spdlog::level::warn;
      spdlog::log(level, "{}: {}", note->code, note->text);
    }
  }

  void watch_health() {
    health_timer_.expires_after(std::chrono::seconds(1));
    health_timer_.async_wait([this](error_code error) {
      if (error) return;
      net::post(robot_io_, [this] {
        net::post(web_io_, [this, health = wires_->health()]() mutable { web_->devices(std::move(health)); });
      });
      watch_health();
    });
  }

  // Stops the wheels first, then says farewell to viewers, then lets the loops run dry.
  void finish() {
    spdlog::info("stopping");
    health_timer_.cancel();
    if (cameras_) cameras_->stop();
    net::post(robot_io_, [this] {
      runner_->stop();
      wires_->stop();
      net::post(web_io_, [this] {
        web_->stop();
        farewell_.expires_after(std::chrono::milliseconds(300));
        farewell_.async_wait([this](error_code) { web_io_.stop(); });
      });
    });
  }

  ServeOptions options_;
  robot::Museum museum_;
  robot::Body body_ = robot::standard_body();
  Clock::time_point zero_ = Clock::now();
  net::io_context web_io_{1};
  net::io_context robot_io_{1};
  net::io_context world_io_{1};
  net::thread_pool pool_{1};
  net::steady_timer health_timer_{web_io_};
  net::steady_timer farewell_{web_io_};
  std::unique_ptr<devices::SimulatedHardware> hardware_;
  std::unique_ptr<Web> web_;
  std::unique_ptr<RecordingDesk> desk_;
  std::unique_ptr<Wires> wires_;
  std::unique_ptr<Runner> runner_;
  std::unique_ptr<CamerasRoom> cameras_;
};

}  // namespace

int serve(const ServeOptions& options) {
  const int real = !options.base.empty() + !options.laser_front.empty() + !options.laser_rear.empty();
  if (real != 0 && real != 3) {
    throw std::runtime_error(
        "--base, --laser-front and --laser-rear go together: name all three lines, or none for the simulation");
  }
  if (const auto folder = options.database.parent_path(); !folder.empty()) std::filesystem::create_directories(folder);
  Server server(options);
  server.run();
  return 0;
}

void add_serve_command(CLI::App& app) {
  auto options = std::make_shared<ServeOptions>();
  if (const char* password = std::getenv("DOCENT_STAFF_PASSWORD")) options->staff_password = password;
  auto* command = app.add_subcommand("serve", "the server: drives the robot, serves the pages and the API");
  command->add_option("--site", options->site, "folder of the museum")->capture_default_str();
  command->add_option("--port", options->port, "0: any free one")->capture_default_str();
  command->add_option("--bind", options->bind, "address to listen on")->capture_default_str();
  command->add_option("--pages", options->pages, "folder of the built pages")->capture_default_str();
  command->add_option("--database", options->database, "SQLite file")->capture_default_str();
  command
      ->add_option("--start", options->start, "where the robot is: global (it looks for itself), home, or x,y,degrees")
      ->capture_default_str();
  command->add_option("--record", options->record, "write everything the robot hears and says into this MCAP file");
  command->add_option("--base", options->base, "serial line of a Pioneer base; with the two lasers: a real robot");
  command->add_option("--laser-front", options->laser_front, "serial line of the front SICK LMS");
  command->add_option("--laser-rear", options->laser_rear, "serial line of the rear SICK LMS");
  command->add_option("--visitors", options->visitors, "people in the simulated museum")->check(CLI::Range(0, 2000));
  command->add_option("--seed", options->seed, "of the simulation and the robot's dice")->capture_default_str();
  command->set_config("--config", "", "TOML file with these options");
  command->footer(
      "DOCENT_STAFF_PASSWORD in the environment is what staff sign in with; without it, clients on this machine are "
      "staff.");
  command->callback([options] { tools::run_command("serve", [&] { return serve(*options); }); });
}

}  // namespace server
