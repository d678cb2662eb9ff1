// `docent simulate`: the robot and the world in one closed loop, faster than real time, and the statistics of the
// deployment.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "robot/museum.hpp"

namespace tools {

struct SimulateOptions {
  std::filesystem::path site;
  double hours = 1.0;
  int visitors = 100;
  std::uint64_t seed = 1;
  std::string report = "-";
  bool cameras = false;             // render and encode both cameras five times a second
  double requests_per_hour = 50.0;  // RHINO served about as many
  std::filesystem::path record;     // file for a recording of all inputs and outputs; empty: none
  bool find_itself = false;         // start without a known pose
};

// Runs the deployment to its end and returns its report.
nlohmann::json simulate(const robot::Museum& museum, const SimulateOptions& options);

void add_simulate_command(CLI::App& app);

}  // namespace tools
