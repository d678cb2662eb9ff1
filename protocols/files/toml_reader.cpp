#include "protocols/files/toml_reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "robot/geometry/polygon.hpp"

namespace files {
namespace {

constexpr std::size_t max_text = 10'000;
constexpr std::size_t max_corners = 1'000;
constexpr double farthest = 10'000.0;  // m

std::string quoted(std::string_view text) { return "\"" + std::string(text) + "\""; }

std::string plain(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

bool is_id(std::string_view id) {
  return !id.empty() && id.size() <= 64 && std::all_of(id.begin(), id.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
  });
}

}  // namespace

void TomlReader::complain(int line, std::string text, std::string mend) {
  problems_.push_back({file_, line, std::move(text), std::move(mend)});
}

void TomlReader::complain(const toml::node& node, std::string text, std::string mend) {
  complain(line(node), std::move(text), std::move(mend));
}

void TomlReader::only_keys(const toml::table& table, std::initializer_list<std::string_view> known) {
  for (const auto& [key, node] : table) {
    if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
    std::string list;
    for (const auto name : known) list += (list.empty() ? "" : ", ") + std::string(name);
    complain(static_cast<int>(key.source().begin.line), "unknown key " + quoted(key.str()), "known here: " + list);
  }
}

const toml::node* TomlReader::need(const toml::table& table, std::string_view key, std::string_view what) {
  const toml::node* node = table.get(key);
  if (!node) complain(table, std::string(key) + " is missing", "give " + std::string(key) + ", " + std::string(what));
  return node;
}

double TomlReader::number(const toml::table& table, std::string_view key, Range range,
                          std::optional<double> otherwise) {
  const std::string what = "a number from " + plain(range.low) + " to " + plain(range.high);
  const toml::node* node = otherwise ? table.get(key) : need(table, key, what);
  if (!node) return otherwise.value_or(0.0);
  if (const auto value = node->value<double>(); value && *value >= range.low && *value <= range.high) return *value;
  complain(*node, std::string(key) + " is not " + what, "give " + what);
  return otherwise.value_or(0.0);
}

std::string TomlReader::string(const toml::table& table, std::string_view key,
                               const std::optional<std::string>& otherwise) {
  const toml::node* node = otherwise ? table.get(key) : need(table, key, "a text in quotes");
  if (!node) return otherwise.value_or("");
  if (auto value = node->value<std::string>(); value && value->size() <= max_text) return *value;
  complain(*node, std::string(key) + " is not a text", "give a text in quotes, at most 10000 bytes");
  return "";
}

robot::Text TomlReader::text(const toml::table& table, std::string_view key, bool needed) {
  const toml::node* node = needed ? need(table, key, "a text in each language") : table.get(key);
  if (!node) return {};
  const toml::table* words = node->as_table();
  if (!words) {
    complain(*node, std::string(key) + " has no languages", "write " + std::string(key) + " = { en = \"...\", ... }");
    return {};
  }
  robot::Text text;
  for (const auto& language : languages_) {
    const auto* word = words->get(language);
    const auto value = word ? word->value<std::string>() : std::nullopt;
    if (!value || value->empty() || value->size() > max_text) {
      complain(word ? *word : *node, std::string(key) + " has no usable text in language " + quoted(language),
               "add " + language + " = \"...\", at most 10000 bytes");
    } else {
      text[language] = *value;
    }
  }
  for (const auto& [language, word] : *words) {
    if (std::find(languages_.begin(), languages_.end(), language.str()) == languages_.end()) {
      complain(word, std::string(key) + " has a text in " + quoted(language.str()) + ", which is not a language here",
               "add it to languages or take it out");
    }
  }
  return text;
}

std::optional<robot::Point> TomlReader::as_point(const toml::node& node) {
  const toml::array* pair = node.as_array();
  if (!pair || pair->size() != 2) return std::nullopt;
  const auto x = (*pair)[0].value<double>(), y = (*pair)[1].value<double>();
  if (!x || !y || !(std::abs(*x) <= farthest) || !(std::abs(*y) <= farthest)) return std::nullopt;
  return robot::Point{*x, *y};
}

robot::Point TomlReader::point(const toml::table& table, std::string_view key) {
  const toml::node* node = need(table, key, "[x, y] in metres");
  if (!node) return {};
  if (const auto point = as_point(*node)) return *point;
  complain(*node, std::string(key) + " is not a point", "give [x, y] in metres, both finite");
  return {};
}

robot::Polygon TomlReader::polygon(const toml::table& table, std::string_view key) {
  const toml::node* node = need(table, key, "a list of corners [x, y]");
  if (!node) return {};
  const toml::array* corners = node->as_array();
  if (!corners || corners->size() < 3 || corners->size() > max_corners) {
    complain(*node, std::string(key) + " is not a polygon", "give 3 to 1000 corners [[x, y], ...] in metres");
    return {};
  }
  robot::Polygon polygon;
  for (const auto& corner : *corners) {
    if (const auto point = as_point(corner)) {
      polygon.push_back(*point);
    } else {
      complain(corner, std::string(key) + " has a corner that is not a point", "give [x, y] in metres, both finite");
      return {};
    }
  }
  if (robot::crosses_itself(polygon)) {
    complain(*node, std::string(key) + " crosses itself", "give the corners in order round the outside, each once");
  } else if (std::abs(robot::signed_area(polygon)) < 1e-6) {
    complain(*node, std::string(key) + " has no area", "give corners that do not lie on one line");
  }
  return polygon;
}

robot::Pose TomlReader::pose(const toml::table& table) {
  return {number(table, "x", {-farthest, farthest}), number(table, "y", {-farthest, farthest}),
          robot::wrap_angle(robot::radians(number(table, "theta_deg", {-360.0, 360.0})))};
}

std::vector<std::string> TomlReader::strings(const toml::table& table, std::string_view key) {
  const toml::node* node = need(table, key, "a list of names");
  const toml::array* array = node ? node->as_array() : nullptr;
  if (node && !array) complain(*node, std::string(key) + " is not a list", "write [\"one\", \"two\"]");
  std::vector<std::string> names;
  for (std::size_t i = 0; array && i < array->size(); ++i) {
    if (auto name = (*array)[i].value<std::string>()) {
      names.push_back(*name);
    } else {
      complain((*array)[i], std::string(key) + " holds something that is not a text", "put names in quotes");
    }
  }
  return names;
}

std::string TomlReader::id(const toml::table& table, std::string_view kind) {
  const toml::node* node = need(table, "id", "a short name such as \"beam-engine\"");
  if (!node) return "";
  const auto id = node->value<std::string>();
  if (!id || !is_id(*id)) {
    complain(*node, "id is not usable", "use lower-case letters, digits and hyphens, at most 64");
    return "";
  }
  if (!ids_.insert(std::string(kind) + " " + *id).second) {
    complain(*node, std::string(kind) + " " + quoted(*id) + " is there twice", "give each its own id");
  }
  return *id;
}

std::vector<const toml::table*> TomlReader::tables(const toml::table& table, std::string_view key) {
  const toml::node* node = table.get(key);
  if (!node) return {};
  const toml::array* array = node->as_array();
  std::vector<const toml::table*> found;
  for (std::size_t i = 0; array && i < array->size(); ++i) {
    if (const toml::table* each = (*array)[i].as_table()) found.push_back(each);
  }
  if (!array || found.size() != array->size()) {
    complain(*node, std::string(key) + " is not a list of tables", "write [[" + std::string(key) + "]] above each");
  }
  return found;
}

}  // namespace files
