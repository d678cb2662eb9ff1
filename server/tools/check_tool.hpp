// `docent check SITE`: validates a museum's files, every error with file, line and mend.
#pragma once

#include <filesystem>
#include <iosfwd>

#include <CLI/CLI.hpp>

namespace tools {

// Prints a line for each problem, or that all is well. Returns the process's exit code: 0 when the museum is sound.
int check_main(const std::filesystem::path& site, std::ostream& out);

void add_check_command(CLI::App& app);

}  // namespace tools
