// `docent replay LOG --map MAP`: localization over a recorded log, with errors against reference poses.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "server/tools/replay.hpp"

namespace tools {

struct ReplayOptions {
  std::filesystem::path log;
  std::filesystem::path map;     // map.yaml, a folder that holds one, a CARMEN .map or wean.dat
  std::vector<double> from, to;  // s on the log's clock, stretches whose scans are used
  std::string start;             // "global", "x,y,deg", or empty: the truth at the first scan, else global
  std::filesystem::path truth;   // reference poses; empty: none
  std::filesystem::path track;   // where the estimates go as CSV; empty: nowhere
  std::string report = "-";
  std::uint64_t seed = 1;
};

// Reads the files and finds the start pose. Throws files::FileError or std::invalid_argument.
ReplaySetup prepare_replay(const ReplayOptions& options);

// Runs it to the end and returns its report.
nlohmann::json run_replay(const ReplayOptions& options);

// Prints the report; returns the process's exit code.
int replay_main(const ReplayOptions& options);

// Returns the subcommand, so that the server can add --serve to it. With `instead`, that is called in place of
// replay_main when it returns true.
CLI::App* add_replay_command(CLI::App& app, std::function<bool(const ReplayOptions&)> instead = {});

}  // namespace tools
