// docent: the command line. Wires, nothing else.
#include <CLI/CLI.hpp>

#include "server/replay_show.hpp"
#include "server/serve.hpp"
#include "server/tools/check_tool.hpp"
#include "server/tools/devices_tool.hpp"
#include "server/tools/map_tool.hpp"
#include "server/tools/simulate_tool.hpp"

int main(int argc, char** argv) {
  CLI::App app("Docent: a telepresence server for interactive museum tour-guide robots");
  app.require_subcommand(1);
  app.fallthrough();
  server::add_serve_command(app);
  tools::add_simulate_command(app);
  server::add_replay_command(app);
  tools::add_map_command(app);
  tools::add_devices_command(app);
  tools::add_check_command(app);
  CLI11_PARSE(app, argc, argv);
  return 0;
}
