// Reads values out of a TOML table and collects every complaint with its line, instead of giving up at the first.
#pragma once

#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <toml++/toml.h>

#include "protocols/files/problem.hpp"
#include "robot/museum.hpp"

namespace files {

struct Range {
  double low;
  double high;
};

class TomlReader {
 public:
  TomlReader(std::string file, std::vector<Problem>& problems) : file_(std::move(file)), problems_(problems) {}

  // Every text must be given in these languages.
  void set_languages(std::vector<std::string> languages) { languages_ = std::move(languages); }
  const std::vector<std::string>& languages() const { return languages_; }

  // Complains of keys that nobody reads: most are misspelt.
  void only_keys(const toml::table& table, std::initializer_list<std::string_view> known);

  // Values; without `otherwise` the key must be there. A value that is missing or unusable is reported and comes back
  // as `otherwise`, or as a zero or an empty one.
  double number(const toml::table& table, std::string_view key, Range range, std::optional<double> otherwise = {});
  std::string string(const toml::table& table, std::string_view key, const std::optional<std::string>& otherwise = {});
  robot::Text text(const toml::table& table, std::string_view key, bool needed = true);
  robot::Point point(const toml::table& table, std::string_view key);
  robot::Polygon polygon(const toml::table& table, std::string_view key);
  robot::Pose pose(const toml::table& table);  // from x, y, theta_deg
  std::vector<std::string> strings(const toml::table& table, std::string_view key);

  // A short name, as URLs carry it; complained of when another of the same kind has it already.
  std::string id(const toml::table& table, std::string_view kind);

  // The tables of [[key]]; none when it is absent.
  std::vector<const toml::table*> tables(const toml::table& table, std::string_view key);

  void complain(int line, std::string text, std::string mend);
  void complain(const toml::node& node, std::string text, std::string mend);
  static int line(const toml::node& node) { return static_cast<int>(node.source().begin.line); }

 private:
  std::optional<robot::Point> as_point(const toml::node& node);
  const toml::node* need(const toml::table& table, std::string_view key, std::string_view what);

  std::string file_;
  std::vector<Problem>& problems_;
  std::vector<std::string> languages_ = {"en"};
  std::set<std::string> ids_;  // "kind id"
};

}  // namespace files
