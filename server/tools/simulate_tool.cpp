#include "server/tools/simulate_tool.hpp"

#include <time.h>

#include <chrono>
#include <fstream>
#include <memory>
#include <optional>
#include <stdexcept>

#include "protocols/files/recording.hpp"
#include "protocols/files/site_file.hpp"
#include "robot/robot.hpp"
#include "robot/simulation/painter.hpp"
#include "robot/simulation/world.hpp"
#include "server/stream/jpeg.hpp"
#include "server/tools/report.hpp"
#include "server/tools/simulated_public.hpp"
#include "server/tools/simulation_statistics.hpp"

namespace tools {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto slice = 25ms;  // of simulated time; the control tick comes every second one
constexpr int slices_per_tick = 2;
constexpr int slices_per_frame = 8;              // 5 Hz
constexpr robot::Seconds open_for{30.0 * 60.0};  // a request that waits longer has not been fulfilled

// Processor time of this thread, s: tells what work costs even when others use the machine.
double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Processor time that goes into one part of the loop.
class Stopwatch {
 public:
  template <typename Work>
  auto time(Work&& work) {
    struct Stop {
      double start = processor_seconds();
      double& sum;
      ~Stop() { sum += processor_seconds() - start; }
    } stop{.sum = sum_};
    return work();
  }
  double seconds() const { return sum_; }

 private:
  double sum_ = 0.0;
};

class Deployment {
 public:
  Deployment(const robot::Museum& museum, const SimulateOptions& options)
      : world_(museum, robot::standard_body(), {.visitors = options.visitors}, options.seed),
        robot_(museum, config_for(museum, options)),
        public_(world_.museum(), {.requests_per_hour = options.requests_per_hour}, options.seed * 3 + 2) {
    if (options.cameras) painter_.emplace(world_.museum());
    if (options.record.empty()) return;
    file_.open(options.record, std::ios::binary);
    if (!file_) throw std::runtime_error(options.record.string() + ": cannot be written");
    recorder_.emplace(file_, files::RecordingInfo{museum.id, "docent simulate", config_for(museum, options)});
  }

  void run(robot::Time until) {
    feed({world_.now(), robot::SetMode{robot::Mode::open}});
    for (std::int64_t i = 1; world_.now() + slice <= until; ++i) {
      const auto events = world_time_.time([&] { return world_.advance(world_.now() + slice); });
      statistics_.see_truth(world_.now(), world_.truth(), world_.twist());
      for (const auto& event : events) feed(event);
      if (painter_ && i % slices_per_frame == 0) camera_time_.time([&] { take_pictures(); });
      if (i % slices_per_tick == 0) {
        for (auto& wish : public_.wishes(world_.now())) feed({world_.now(), std::move(wish)});
        feed({world_.now(), robot::Tick{}});
      }
    }
  }

  nlohmann::json report(double wall_seconds) const {
    nlohmann::json report = statistics_.report(world_, open_for);
    const double simulated = robot::to_seconds(world_.now());
    report["realtime_factor"] = simulated / wall_seconds;
    report["wall_s"] = wall_seconds;
    report["realtime_factor_of_processor"] = simulated / processor_seconds();
    report["cpu_s"] = {{"world", world_time_.seconds()}, {"robot", robot_time_.seconds()}};
    if (painter_) {
      report["cpu_s"]["cameras"] = camera_time_.seconds();
      report["pictures"] = {{"count", pictures_}, {"jpeg_bytes", jpeg_bytes_}};
    }
    return report;
  }

 private:
  static robot::Config config_for(const robot::Museum& museum, const SimulateOptions& options) {
    robot::Config config;
    if (!options.find_itself) config.start = museum.home;
    config.seed = options.seed;
    return config;
  }

  // What viewers would be sent: the robot's eyes and the first wall camera.
  void take_pictures() {
    const auto moment = world_.snapshot();
    const auto take = [&](const robot::simulation::CameraView& view) {
      const auto image = painter_->render(view, moment);
      jpeg_bytes_ += server::encode_jpeg(image.rgb, image.width, image.height).size();
      ++pictures_;
    };
    take(robot::simulation::onboard_view(moment.robot));
    if (!world_.museum().cameras.empty()) take(robot::simulation::wall_view(world_.museum().cameras.front()));
  }

  void feed(const robot::Input& input) {
    if (recorder_) recorder_->input(input);
    const auto outputs = robot_time_.time([&] { return robot_.handle(input); });
    for (const auto& output : outputs) {
      if (recorder_) recorder_->output(input.now, output);
      if (const auto* command = std::get_if<robot::WheelCommand>(&output)) world_.command(*command);
      if (const auto* motors = std::get_if<robot::EnableMotors>(&output)) world_.enable_motors(motors->on);
      if (const auto* speech = std::get_if<robot::Speech>(&output)) world_.hear(*speech);
      statistics_.see(output, input.now);
      public_.see(output, input.now);
    }
  }

  robot::simulation::World world_;
  robot::Robot robot_;
  SimulatedPublic public_;
  SimulationStatistics statistics_;
  std::optional<robot::simulation::Painter> painter_;
  std::size_t pictures_ = 0, jpeg_bytes_ = 0;
  std::ofstream file_;
  std::optional<files::Recorder> recorder_;
  Stopwatch world_time_, robot_time_, camera_time_;
};

}  // namespace

nlohmann::json simulate(const robot::Museum& museum, const SimulateOptions& options) {
  const auto start = Clock::now();
  Deployment deployment(museum, options);
  deployment.run(robot::from_seconds(options.hours * 3600.0));
  nlohmann::json report = deployment.report(std::chrono::duration<double>(Clock::now() - start).count());
  report["site"] = museum.id;
  report["visitors"] = options.visitors;
  report["seed"] = options.seed;
  return report;
}

void add_simulate_command(CLI::App& app) {
  auto* command = app.add_subcommand("simulate", "Run a museum without screens, faster than real time; statistics");
  auto options = std::make_shared<SimulateOptions>();
  command->add_option("--site", options->site, "the museum's folder, with site.toml")->required();
  command->add_option("--hours", options->hours, "simulated time")->check(CLI::Range(0.001, 1000.0));
  command->add_option("--visitors", options->visitors, "people in the museum")->check(CLI::Range(0, 2000));
  command->add_option("--seed", options->seed, "the same seed, the same day");
  command->add_option("--report", options->report, "file for the JSON report; - is standard output");
  command->add_option("--requests-per-hour", options->requests_per_hour, "wishes of web and kiosk visitors")
      ->check(CLI::Range(0.0, 3600.0));
  command->add_option("--record", options->record, "file for a recording (MCAP) of all that the robot hears and says");
  command->add_flag("--cameras", options->cameras, "paint and encode the pictures of two cameras five times a second");
  command->add_flag("--find-itself", options->find_itself, "the robot is not told where it starts");
  command->callback([options] {
    run_command("simulate", [&] {
      write_report(simulate(files::load_site(options->site), *options), options->report);
      return 0;
    });
  });
}

}  // namespace tools
