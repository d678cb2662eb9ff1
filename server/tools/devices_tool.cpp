#include "server/tools/devices_tool.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <memory>
#include <ostream>
#include <sstream>

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/signal_set.hpp>

#include "protocols/files/site_file.hpp"
#include "server/devices/simulated_hardware.hpp"
#include "server/tools/report.hpp"

namespace tools {
namespace {

struct Row {
  robot::Device device;
  const char* name;
  const char* kind;
};
constexpr Row rows[] = {{robot::Device::base, "base", "Pioneer P2OS, 9600 baud until HOSTBAUD"},
                        {robot::Device::laser_front, "laser_front", "SICK LMS 200, 9600 baud until told otherwise"},
                        {robot::Device::laser_rear, "laser_rear", "SICK LMS 200, 9600 baud until told otherwise"}};

constexpr const char* orders_help =
    "Orders on standard input with --orders, each answered by one line:\n"
    "  unplug DEVICE                        pull the cable; plug DEVICE puts it back\n"
    "  damage DEVICE cut|flip|random SHARE  a bad cable: this share (0..1) of the packets, both ways\n"
    "  mend DEVICE                          a good cable again\n"
    "  truth                                where the robot really is: x y theta, m and rad\n"
    "  latency                              from a scan's bytes to the next wheel command's, ms: median p99 commands";

// Carries out orders from standard input, one a line, until that ends.
class Orders {
 public:
  Orders(boost::asio::io_context& context, devices::SimulatedHardware& hardware, std::ostream& out)
      : hardware_(hardware), out_(out), flags_(::fcntl(STDIN_FILENO, F_GETFL)), input_(context, ::dup(STDIN_FILENO)) {
    wait();
  }
  // Whoever shares our standard input, as a shell does, wants it as it was.
  ~Orders() { ::fcntl(STDIN_FILENO, F_SETFL, flags_); }

 private:
  void wait() {
    boost::asio::async_read_until(input_, boost::asio::dynamic_buffer(text_, 4096), '\n',
                                  [this](boost::system::error_code error, std::size_t size) {
                                    if (error) return;
                                    carry_out(text_.substr(0, size));
                                    text_.erase(0, size);
                                    wait();
                                  });
  }

  void carry_out(const std::string& line) {
    using Damage = devices::SimulatedLine::Damage;
    std::istringstream words(line);
    std::string order, name, kind;
    words >> order;
    if (order == "truth") return tell_truth();
    if (order == "latency") return tell_latency();
    words >> name;
    const auto* row = std::find_if(std::begin(rows), std::end(rows), [&](const Row& r) { return name == r.name; });
    if (row == std::end(rows)) return say("no such order or device; see --help");
    if (order == "unplug") {
      hardware_.unplug(row->device);
    } else if (order == "plug") {
      hardware_.plug(row->device);
    } else if (order == "mend") {
      hardware_.damage(row->device, Damage::none, 0.0);
    } else if (order == "damage") {
      double share = 0.0;
      words >> kind >> share;
      const Damage damage = kind == "cut"      ? Damage::cut
                            : kind == "flip"   ? Damage::flip
                            : kind == "random" ? Damage::random
                                               : Damage::none;
      if (damage == Damage::none || !words || !(share >= 0.0 && share <= 1.0)) {
        return say("damage takes a device, cut, flip or random, and a share from 0 to 1");
      }
      hardware_.damage(row->device, damage, share);
    } else {
      return say("no such order; see --help");
    }
    say("done");
  }

  void tell_truth() {
    hardware_.with_world([this](robot::simulation::World& world) {
      const robot::Pose pose = world.truth();
      say(std::to_string(pose.x) + " " + std::to_string(pose.y) + " " + std::to_string(pose.theta));
    });
  }
  void tell_latency() {
    hardware_.with_latency([this](const devices::LatencyProbe& probe) {
      say(std::to_string(probe.milliseconds(0.5).value_or(0.0)) + " " +
          std::to_string(probe.milliseconds(0.99).value_or(0.0)) + " " + std::to_string(probe.commands()));
    });
  }
  void say(const std::string& line) { out_ << line << std::endl; }

  devices::SimulatedHardware& hardware_;
  std::ostream& out_;
  int flags_;
  boost::asio::posix::stream_descriptor input_;
  std::string text_;
};

}  // namespace

int devices_main(const DevicesOptions& options, std::ostream& out) {
  const robot::Museum museum = files::load_site(options.site);
  boost::asio::io_context context(1);
  boost::asio::signal_set signals(context, SIGINT, SIGTERM);
  signals.async_wait([&](boost::system::error_code, int) { context.stop(); });
  devices::SimulatedHardware hardware(context.get_executor(), museum, robot::standard_body(),
                                      {.visitors = options.visitors}, options.seed);
  nlohmann::json list = nlohmann::json::array();
  for (const Row& row : rows)
    list.push_back({{"device", row.name}, {"path", hardware.path(row.device)}, {"kind", row.kind}});
  if (options.list) {
    out << list.dump(2) << std::endl;
  } else {
    for (const auto& row : list) {
      out << row["device"].get<std::string>() << "\t" << row["path"].get<std::string>() << "\t"
          << row["kind"].get<std::string>() << "\n";
    }
    out << "Ctrl-C ends them." << std::endl;
  }
  const auto orders = options.orders ? std::make_unique<Orders>(context, hardware, out) : nullptr;
  context.run();
  return 0;
}

void add_devices_command(CLI::App& app) {
  auto* command = app.add_subcommand("devices", "Offer the simulated serial devices on pseudo-terminals");
  auto options = std::make_shared<DevicesOptions>();
  command->add_option("--site", options->site, "the museum's folder")->capture_default_str();
  command->add_option("--visitors", options->visitors, "people in the museum")
      ->capture_default_str()
      ->check(CLI::Range(0, 1000));
  command->add_option("--seed", options->seed, "of everything drawn by lot")->capture_default_str();
  command->add_flag("--list", options->list, "say the terminals as JSON");
  command->add_flag("--orders", options->orders, "take orders on standard input, see below");
  command->footer(orders_help);
  command->callback([options] { run_command("devices", [&] { return devices_main(*options, std::cout); }); });
}

}  // namespace tools
