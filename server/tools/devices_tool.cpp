#include "server/tools/devices_tool.hpp"

#include <csignal>
#include <memory>
#include <ostream>

#include <boost/asio/io_context.hpp>
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

}  // namespace

int devices_main(const DevicesOptions& options, std::ostream& out) {
  const robot::Museum museum = files::load_site(options.site);
  boost::asio::io_context context(1);
  boost::asio::signal_set signals(context, SIGINT, SIGTERM);
  signals.async_wait([&](boost::system::error_code, int) { context.stop(); });
  const devices::SimulatedHardware hardware(context.get_executor(), museum, robot::standard_body(),
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
  command->callback([options] { run_command("devices", [&] { return devices_main(*options, std::cout); }); });
}

}  // namespace tools
