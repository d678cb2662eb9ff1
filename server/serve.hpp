// `docent serve`: the server. Puts the robot's thread, the serial links, the web and the cameras together.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace server {

struct ServeOptions {
  std::filesystem::path site = "static/sites/rhine-hall";
  std::filesystem::path pages = "web/dist";
  std::filesystem::path database = "var/docent.sqlite";
  std::string bind = "0.0.0.0";
  unsigned short port = 8080;
  std::string staff_password;    // empty: clients on this machine are staff
  std::string start = "global";  // or "home", or "x,y,degrees"
  std::optional<std::filesystem::path> record;

  // Real lines; all empty: the simulated museum behind pseudo-terminals.
  std::string base;
  std::string laser_front;
  std::string laser_rear;

  std::optional<int> visitors;  // of the simulated museum; none: the site's usual number
  std::uint64_t seed = 1;
};

// Serves until SIGINT or SIGTERM. Throws std::runtime_error with one clear line when it cannot begin.
int serve(const ServeOptions& options);

void add_serve_command(CLI::App& app);

}  // namespace server
