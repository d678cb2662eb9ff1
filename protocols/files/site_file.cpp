#include "protocols/files/site_file.hpp"

#include <algorithm>
#include <set>

#include "protocols/files/bytes.hpp"
#include "protocols/files/map_server_file.hpp"
#include "protocols/files/site_parts.hpp"
#include "protocols/files/toml_reader.hpp"

namespace files {
namespace {

constexpr std::size_t max_site_bytes = 4u << 20;

constexpr std::pair<std::string_view, robot::HazardKind> hazard_kinds[] = {
    {"glass", robot::HazardKind::glass},
    {"low_obstacle", robot::HazardKind::low_obstacle},
    {"staircase", robot::HazardKind::staircase},
    {"escalator", robot::HazardKind::escalator},
    {"keep_out", robot::HazardKind::keep_out}};

// Turns the parsed document into a museum, part by part.
class SiteReader {
 public:
  SiteReader(const std::filesystem::path& dir, Site& site)
      : dir_(dir), site_(site), read_((dir / "site.toml").string(), site.problems) {}

  void read() {
    try {
      document_ = toml::parse(read_bytes(dir_ / "site.toml", max_site_bytes), (dir_ / "site.toml").string());
    } catch (const toml::parse_error& error) {
      read_.complain(static_cast<int>(error.source().begin.line), std::string(error.description()),
                     "correct the TOML here");
      return;
    } catch (const FileError& error) {
      site_.problems.push_back(error.problem());
      return;
    }
    read_.only_keys(document_, {"id", "title", "languages", "map", "home", "boundary", "visitors", "speed", "hazard",
                                "area", "camera", "exhibit", "tour"});
    read_head();
    if (document_.get("visitors")) {
      museum().visitors = static_cast<int>(read_.number(document_, "visitors", {0.0, 2000.0}, museum().visitors));
    }
    read_speed();
    for (const auto* table : read_.tables(document_, "hazard")) read_hazard(*table);
    for (const auto* table : read_.tables(document_, "area")) read_area(*table);
    for (const auto* table : read_.tables(document_, "camera")) read_camera(*table);
    for (const auto* table : read_.tables(document_, "exhibit")) read_exhibit(*table);
    for (const auto* table : read_.tables(document_, "tour")) read_tour(*table);
    if (museum().exhibits.empty()) read_.complain(0, "there is no exhibit", "add at least one [[exhibit]]");
  }

 private:
  robot::Museum& museum() { return site_.museum; }

  void read_head() {
    museum().id = read_.id(document_, "site");
    read_languages();
    museum().title = read_.text(document_, "title");
    if (const auto* home = document_.get("home"); home && home->as_table()) {
      read_.only_keys(*home->as_table(), {"x", "y", "theta_deg"});
      museum().home = read_.pose(*home->as_table());
      site_.lines.home = TomlReader::line(*home);
    } else {
      read_.complain(home ? TomlReader::line(*home) : 0, "home is missing", "give home = { x, y, theta_deg }");
    }
    if (const auto* boundary = document_.get("boundary")) {
      museum().boundary = read_.polygon(document_, "boundary");
      site_.lines.boundary = TomlReader::line(*boundary);
    }
    const std::string map = read_.string(document_, "map");
    if (map.empty()) return;
    try {
      museum().map = read_map_server(dir_ / map);
    } catch (const FileError& error) {
      site_.problems.push_back(error.problem());
    }
  }

  void read_languages() {
    if (!document_.get("languages")) return;
    auto languages = read_.strings(document_, "languages");
    if (std::find(languages.begin(), languages.end(), "en") == languages.end()) {
      read_.complain(*document_.get("languages"), "languages leaves out \"en\"",
                     "every museum has English: add \"en\"");
      languages.insert(languages.begin(), "en");
    }
    read_.set_languages(std::move(languages));
  }

  void read_speed() {
    const auto* node = document_.get("speed");
    if (!node) return;
    const auto* table = node->as_table();
    if (!table) return read_.complain(*node, "speed is not a table", "write [speed] and its values below");
    read_.only_keys(*table, {"open_mps", "web_only_mps", "staff_mps"});
    auto& speed = museum().speed;
    speed.open_mps = read_.number(*table, "open_mps", {0.05, 2.0}, speed.open_mps);
    speed.web_only_mps = read_.number(*table, "web_only_mps", {0.05, 2.0}, speed.web_only_mps);
    speed.staff_mps = read_.number(*table, "staff_mps", {0.05, 2.0}, speed.staff_mps);
  }

  void read_hazard(const toml::table& table) {
    read_.only_keys(table, {"id", "kind", "polygon", "title"});
    robot::Hazard hazard;
    hazard.id = read_.id(table, "hazard");
    const std::string kind = read_.string(table, "kind");
    const auto* found = std::find_if(std::begin(hazard_kinds), std::end(hazard_kinds),
                                     [&](const auto& entry) { return entry.first == kind; });
    if (found != std::end(hazard_kinds)) {
      hazard.kind = found->second;
    } else {
      read_.complain(table, "unknown kind of hazard \"" + kind + "\"",
                     "use glass, low_obstacle, staircase, escalator or keep_out");
    }
    hazard.polygon = read_.polygon(table, "polygon");
    hazard.title = read_.text(table, "title", false);
    site_.lines.hazards.push_back(TomlReader::line(table));
    museum().hazards.push_back(std::move(hazard));
  }

  void read_area(const toml::table& table) {
    read_.only_keys(table, {"title", "label"});
    site_.lines.areas.push_back(TomlReader::line(table));
    museum().areas.push_back({read_.text(table, "title"), read_.point(table, "label")});
  }

  void read_camera(const toml::table& table) {
    read_.only_keys(table, {"id", "title", "x", "y", "theta_deg", "height", "tilt_deg", "field_of_view_deg"});
    robot::WallCamera camera;
    camera.id = read_.id(table, "camera");
    camera.title = read_.text(table, "title");
    camera.pose = read_.pose(table);
    camera.height = read_.number(table, "height", {0.2, 50.0}, camera.height);
    camera.tilt = robot::radians(read_.number(table, "tilt_deg", {-90.0, 45.0}, robot::degrees(camera.tilt)));
    camera.field_of_view =
        robot::radians(read_.number(table, "field_of_view_deg", {10.0, 170.0}, robot::degrees(camera.field_of_view)));
    site_.lines.cameras.push_back(TomlReader::line(table));
    museum().cameras.push_back(std::move(camera));
  }

  void read_exhibit(const toml::table& table) {
    read_.only_keys(table, {"id", "number", "title", "to", "about", "summary", "outline", "icon", "picture",
                            "viewpoint", "narration"});
    robot::Exhibit exhibit;
    exhibit.id = read_.id(table, "exhibit");
    exhibit.number = static_cast<int>(read_.number(table, "number", {1, 9999}));
    if (exhibit.number > 0 && !numbers_.insert(exhibit.number).second) {
      read_.complain(table, "number " + std::to_string(exhibit.number) + " is there twice",
                     "number each exhibit apart");
    }
    exhibit.title = read_.text(table, "title");
    exhibit.to = read_.text(table, "to", false);
    exhibit.about = read_.text(table, "about", false);
    exhibit.summary = read_.text(table, "summary");
    exhibit.outline = read_.polygon(table, "outline");
    exhibit.icon = read_.string(table, "icon", "");
    exhibit.picture = read_picture(table);
    std::vector<int> lines;
    for (const auto* viewpoint : read_.tables(table, "viewpoint")) {
      read_.only_keys(*viewpoint, {"x", "y", "theta_deg"});
      exhibit.viewpoints.push_back({read_.pose(*viewpoint)});
      lines.push_back(TomlReader::line(*viewpoint));
    }
    if (lines.empty()) read_.complain(table, "the exhibit has no viewpoint", "add [[exhibit.viewpoint]]");
    for (const auto* narration : read_.tables(table, "narration")) read_narration(*narration, exhibit);
    if (exhibit.narrations.empty()) read_.complain(table, "the exhibit has no text", "add [[exhibit.narration]]");
    site_.lines.exhibits.push_back(TomlReader::line(table));
    site_.lines.viewpoints.push_back(std::move(lines));
    museum().exhibits.push_back(std::move(exhibit));
  }

  void read_narration(const toml::table& table, robot::Exhibit& exhibit) {
    read_.only_keys(table, {"text", "picture", "seconds"});
    robot::Narration narration;
    narration.text = read_.text(table, "text");
    narration.picture = read_picture(table);
    narration.duration = robot::Seconds(read_.number(table, "seconds", {1.0, 600.0}, narration.duration.count()));
    exhibit.narrations.push_back(std::move(narration));
  }

  std::string read_picture(const toml::table& table) {
    std::string name = read_.string(table, "picture", "");  // not const: it is moved out
    if (name.empty()) return name;
    const std::filesystem::path path(name);
    const bool inside = path.is_relative() && std::find(path.begin(), path.end(), "..") == path.end();
    std::error_code error;
    if (!inside) {
      read_.complain(*table.get("picture"), "picture lies outside of the site's folder",
                     "name a file below the folder");
    } else if (!std::filesystem::is_regular_file(dir_ / path, error)) {
      read_.complain(*table.get("picture"), "there is no picture " + name, "add the file or take the name out");
    }
    return name;
  }

  void read_tour(const toml::table& table) {
    read_.only_keys(table, {"id", "title", "summary", "exhibits"});
    robot::Tour tour;
    tour.id = read_.id(table, "tour");
    tour.title = read_.text(table, "title");
    tour.summary = read_.text(table, "summary", false);
    tour.exhibits = read_.strings(table, "exhibits");
    if (tour.exhibits.empty()) read_.complain(table, "the tour visits nothing", "name exhibits by their ids");
    for (const auto& id : tour.exhibits) {
      if (!robot::find_exhibit(museum(), id)) {
        read_.complain(*table.get("exhibits"), "the tour visits \"" + id + "\", which is no exhibit",
                       "use the id of an [[exhibit]]");
      }
    }
    museum().tours.push_back(std::move(tour));
  }

  std::filesystem::path dir_;
  Site& site_;
  TomlReader read_;
  toml::table document_;
  std::set<int> numbers_;
};

std::string all_lines(const std::vector<Problem>& problems) {
  std::string text;
  for (const auto& problem : problems) text += (text.empty() ? "" : "\n") + to_text(problem);
  return text;
}

Site checked_site(const std::filesystem::path& dir, const robot::Footprint& footprint) {
  Site site = read_site(dir);
  check_places(site, (dir / "site.toml").string(), footprint);
  return site;
}

}  // namespace

SiteError::SiteError(std::vector<Problem> problems)
    : std::runtime_error(all_lines(problems)), problems_(std::move(problems)) {}

Site read_site(const std::filesystem::path& dir) {
  Site site;
  SiteReader(dir, site).read();
  return site;
}

robot::Museum load_site(const std::filesystem::path& dir) {
  Site site = checked_site(dir, robot::standard_body().footprint);
  if (!site.problems.empty()) throw SiteError(std::move(site.problems));
  return std::move(site.museum);
}

std::vector<Problem> check_site(const std::filesystem::path& dir, const robot::Footprint& footprint) {
  return checked_site(dir, footprint).problems;
}

}  // namespace files
