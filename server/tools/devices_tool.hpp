// `docent devices`: offers the simulated robot's serial devices on pseudo-terminals, for other programs to drive.
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>

#include <CLI/CLI.hpp>

namespace tools {

struct DevicesOptions {
  std::filesystem::path site = "static/sites/rhine-hall";
  int visitors = 20;
  std::uint64_t seed = 1;
  bool list = false;    // say the terminals as JSON
  bool orders = false;  // unplug, damage and the like, told on standard input
};

// Says where the terminals are and runs the museum in real time until SIGINT or SIGTERM. Returns the exit code.
int devices_main(const DevicesOptions& options, std::ostream& out);

void add_devices_command(CLI::App& app);

}  // namespace tools
