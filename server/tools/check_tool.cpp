#include "server/tools/check_tool.hpp"

#include <memory>
#include <ostream>

#include "protocols/files/site_file.hpp"
#include "server/tools/report.hpp"

namespace tools {

int check_main(const std::filesystem::path& site, std::ostream& out) {
  const auto problems = files::check_site(site);
  for (const auto& problem : problems) out << files::to_text(problem) << "\n";
  if (problems.empty()) {
    const auto museum = files::load_site(site);
    out << site.string() << ": " << museum.exhibits.size() << " exhibits, " << museum.tours.size() << " tours, "
        << museum.hazards.size() << " hazards: all well\n";
  } else {
    out << site.string() << ": " << problems.size() << (problems.size() == 1 ? " problem\n" : " problems\n");
  }
  return problems.empty() ? 0 : 1;
}

void add_check_command(CLI::App& app) {
  auto* command = app.add_subcommand("check", "Validate a museum's files");
  auto site = std::make_shared<std::filesystem::path>();
  command->add_option("site", *site, "the museum's folder, with site.toml")->required();
  command->callback([site] { run_command("check", [&] { return check_main(*site, std::cout); }); });
}

}  // namespace tools
