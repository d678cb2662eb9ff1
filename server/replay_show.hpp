// `docent replay LOG --map MAP --serve`: a recorded drive on the pages, as the robot of today sees it, over and over.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "server/tools/replay_tool.hpp"

namespace server {

struct ShowOptions {
  bool serve = false;  // false: a report, no pages
  std::filesystem::path pages = "web/dist";
  std::string bind = "0.0.0.0";
  unsigned short port = 8080;
  double speed = 1.0;  // times as fast as it was recorded
};

// Shows the replay until SIGINT or SIGTERM. Throws std::runtime_error with one clear line when it cannot begin.
int show_replay(const tools::ReplayOptions& replay, const ShowOptions& options);

// The replay subcommand together with --serve.
void add_replay_command(CLI::App& app);

}  // namespace server
