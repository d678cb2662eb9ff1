// What every command of the tools shares: JSON reports, percentiles, one clear line on bad input.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "protocols/files/bytes.hpp"

namespace tools {

// The value below which this share (0..1) of the values lies, between neighbours linearly. Empty: nothing.
inline std::optional<double> percentile(std::vector<double> values, double share) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const double at = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(at));
  const auto above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - std::floor(at)) * (values[above] - values[below]);
}

// JSON has no "nothing" for numbers but null.
inline nlohmann::json or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

// Writes a report to a file, or to standard output for "-". Throws files::FileError.
inline void write_report(const nlohmann::json& report, const std::string& where) {
  const std::string text = report.dump(2) + "\n";
  if (where == "-") {
    std::cout << text << std::flush;
  } else {
    files::write_bytes(where, text);
  }
}

// Runs a command's body; an exception becomes one line on standard error and exit code 1.
inline void run_command(const std::string& name, const std::function<int()>& body) {
  int code = 1;
  try {
    code = body();
  } catch (const std::exception& error) {
    std::cerr << "docent " << name << ": " << error.what() << "\n";
  }
  if (code != 0) throw CLI::RuntimeError(code);
}

}  // namespace tools
