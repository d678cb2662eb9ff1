#include "protocols/files/map_server_file.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

#include "protocols/files/bytes.hpp"
#include "protocols/files/problem.hpp"

namespace files {
namespace {

constexpr std::size_t max_pixels = 64'000'000;
constexpr std::size_t max_pgm_bytes = 4 * max_pixels + 65536;  // text needs up to four characters a pixel
constexpr std::size_t max_yaml_bytes = 65536;
constexpr std::uint8_t white = 254, grey = 205, black = 0;  // as map_saver writes them

// The numbers of a PGM: separated by white space, # starts a comment.
class PgmNumbers {
 public:
  PgmNumbers(std::string_view bytes, std::size_t at) : bytes_(bytes), at_(at) {}

  std::optional<int> next() {
    skip_blank();
    int value = 0;
    const auto [end, error] = std::from_chars(bytes_.data() + at_, bytes_.data() + bytes_.size(), value);
    if (error != std::errc{} || value < 0) return std::nullopt;
    at_ = static_cast<std::size_t>(end - bytes_.data());
    return value;
  }
  std::size_t at() const { return at_; }

 private:
  static bool blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
  void skip_blank() {
    while (at_ < bytes_.size() && (blank(bytes_[at_]) || bytes_[at_] == '#')) {
      if (bytes_[at_] == '#') {
        while (at_ < bytes_.size() && bytes_[at_] != '\n') ++at_;
      } else {
        ++at_;
      }
    }
  }
  std::string_view bytes_;
  std::size_t at_;
};

std::uint8_t scaled(int value, int max_value) {
  return static_cast<std::uint8_t>((std::min(value, max_value) * 255 + max_value / 2) / max_value);
}

std::vector<std::uint8_t> binary_pixels(std::string_view bytes, std::size_t at, std::size_t count, int max_value,
                                        const std::string& name) {
  const std::size_t width = max_value > 255 ? 2 : 1;
  if (at > bytes.size() || bytes.size() - at < count * width) {
    throw FileError({name, 0, "the picture is cut short", "write the PGM again"});
  }
  std::vector<std::uint8_t> pixels(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto byte = [&](std::size_t k) { return static_cast<int>(static_cast<unsigned char>(bytes[at + k])); };
    pixels[i] = scaled(width == 2 ? byte(2 * i) * 256 + byte(2 * i + 1) : byte(i), max_value);
  }
  return pixels;
}

std::int8_t occupancy(int pixel, const MapServerRules& rules) {
  if (rules.mode == MapServerRules::Mode::raw) {
    return pixel <= 100 ? static_cast<std::int8_t>(pixel) : robot::unknown_cell;
  }
  const double occupied = (rules.negate ? pixel : 255 - pixel) / 255.0;
  if (occupied > rules.occupied_thresh) return robot::occupied_cell;
  if (occupied < rules.free_thresh) return robot::free_cell;
  if (rules.mode == MapServerRules::Mode::trinary) return robot::unknown_cell;
  const double share = (occupied - rules.free_thresh) / (rules.occupied_thresh - rules.free_thresh);
  return static_cast<std::int8_t>(std::lround(1.0 + 98.0 * std::clamp(share, 0.0, 1.0)));
}

// The YAML file's fields, each read with its own complaint.
class MapYaml {
 public:
  explicit MapYaml(const std::filesystem::path& path) : name_(path.string()) {
    try {
      root_ = YAML::Load(read_bytes(path, max_yaml_bytes));
    } catch (const YAML::Exception& error) {
      throw FileError({name_, error.mark.line + 1, "is not YAML: " + error.msg, "see map_server's format"});
    }
    if (!root_.IsMap()) fail(root_, "does not hold keys and values", "give image, resolution and origin");
  }

  template <typename T>
  T get(const char* key, const char* what, std::optional<T> otherwise = std::nullopt) const {
    const YAML::Node node = root_[key];
    if (!node) {
      if (otherwise) return *otherwise;
      fail(root_, std::string(key) + " is missing", std::string("give ") + key + ", " + what);
    }
    try {
      return node.as<T>();
    } catch (const YAML::Exception&) {
      fail(node, std::string(key) + " cannot be read", std::string("give ") + what);
    }
  }

  [[noreturn]] void fail(const YAML::Node& node, const std::string& text, const std::string& mend) const {
    throw FileError({name_, node.Mark().line + 1, text, mend});
  }
  [[noreturn]] void fail(const char* key, const std::string& text, const std::string& mend) const {
    fail(root_[key] ? root_[key] : root_, text, mend);
  }

 private:
  std::string name_;
  YAML::Node root_;
};

MapServerRules read_rules(const MapYaml& yaml) {
  MapServerRules rules;
  rules.negate = yaml.get<int>("negate", "0 or 1", 0) != 0;
  rules.occupied_thresh = yaml.get<double>("occupied_thresh", "a number from 0 to 1", rules.occupied_thresh);
  rules.free_thresh = yaml.get<double>("free_thresh", "a number from 0 to 1", rules.free_thresh);
  if (!(rules.free_thresh >= 0.0 && rules.free_thresh < rules.occupied_thresh && rules.occupied_thresh <= 1.0)) {
    yaml.fail("free_thresh", "thresholds must be 0 <= free_thresh < occupied_thresh <= 1", "use 0.196 and 0.65");
  }
  const auto mode = yaml.get<std::string>("mode", "trinary, scale or raw", "trinary");
  if (mode == "scale") {
    rules.mode = MapServerRules::Mode::scale;
  } else if (mode == "raw") {
    rules.mode = MapServerRules::Mode::raw;
  } else if (mode != "trinary") {
    yaml.fail("mode", "unknown mode \"" + mode + "\"", "use trinary, scale or raw");
  }
  return rules;
}

}  // namespace

GreyImage parse_pgm(std::string_view bytes, const std::string& name) {
  const bool text = bytes.starts_with("P2"), binary = bytes.starts_with("P5");
  if (!text && !binary) throw FileError({name, 0, "is not a PGM picture", "save it as PGM (P5 or P2)"});
  PgmNumbers numbers(bytes, 2);
  const auto width = numbers.next(), height = numbers.next(), max_value = numbers.next();
  if (!width || !height || !max_value || *width < 1 || *height < 1 || *max_value < 1 || *max_value > 65535) {
    throw FileError({name, 0, "bad PGM header", "give width, height and greatest value"});
  }
  const auto count = static_cast<std::uint64_t>(*width) * static_cast<std::uint64_t>(*height);
  if (count > max_pixels) throw FileError({name, 0, "more than 64 million pixels", "use a coarser map"});
  GreyImage image{*width, *height, {}};
  if (binary) {
    image.pixels = binary_pixels(bytes, numbers.at() + 1, static_cast<std::size_t>(count), *max_value, name);
    return image;
  }
  image.pixels.reserve(std::min<std::size_t>(static_cast<std::size_t>(count), bytes.size()));
  while (image.pixels.size() < count) {
    const auto value = numbers.next();
    if (!value) throw FileError({name, 0, "the picture is cut short", "write the PGM again"});
    image.pixels.push_back(scaled(*value, *max_value));
  }
  return image;
}

std::string to_pgm(const GreyImage& image) {
  std::string bytes = "P5\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n255\n";
  bytes.append(image.pixels.begin(), image.pixels.end());
  return bytes;
}

robot::OccupancyGrid to_grid(const GreyImage& image, const MapServerRules& rules, double resolution,
                             robot::Point origin) {
  robot::OccupancyGrid grid(image.width, image.height, resolution, origin);
  for (int y = 0; y < image.height; ++y) {
    const auto row = static_cast<std::size_t>(image.height - 1 - y) * static_cast<std::size_t>(image.width);
    for (int x = 0; x < image.width; ++x) {
      grid[{x, y}] = occupancy(image.pixels[row + static_cast<std::size_t>(x)], rules);
    }
  }
  return grid;
}

robot::OccupancyGrid read_pgm_map(const std::filesystem::path& pgm, double resolution, robot::Point origin,
                                  const MapServerRules& rules) {
  return to_grid(parse_pgm(read_bytes(pgm, max_pgm_bytes), pgm.string()), rules, resolution, origin);
}

robot::OccupancyGrid read_map_server(const std::filesystem::path& path) {
  const MapYaml yaml(path);
  const auto image = yaml.get<std::string>("image", "the picture's file name");
  const auto resolution = yaml.get<double>("resolution", "metres a pixel");
  if (!(resolution >= 1e-3 && resolution <= 10.0)) {
    yaml.fail("resolution", "resolution is not between 0.001 and 10 metres a pixel",
              "give metres a pixel, such as 0.05");
  }
  const auto origin = yaml.get<std::vector<double>>("origin", "[x, y, 0] in metres");
  if (origin.size() != 3 || !std::isfinite(origin[0]) || !std::isfinite(origin[1])) {
    yaml.fail("origin", "origin is not three numbers", "give [x, y, 0], the lower-left corner in metres");
  }
  if (origin[2] != 0.0) yaml.fail("origin", "the map is turned", "turn the picture itself and give yaw 0");
  return read_pgm_map(path.parent_path() / image, resolution, {origin[0], origin[1]}, read_rules(yaml));
}

void write_map_server(const std::filesystem::path& path, const robot::OccupancyGrid& map) {
  GreyImage image{map.width(), map.height(), {}};
  image.pixels.reserve(map.size());
  for (int y = map.height() - 1; y >= 0; --y) {
    for (int x = 0; x < map.width(); ++x) {
      const auto value = map[{x, y}];
      image.pixels.push_back(robot::is_occupied(value) ? black : robot::is_free(value) ? white : grey);
    }
  }
  std::filesystem::path pgm = path;
  pgm.replace_extension(".pgm");
  char text[512];
  std::snprintf(text, sizeof text,
                "resolution: %.9g\norigin: [%.9g, %.9g, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n",
                map.resolution(), map.origin().x, map.origin().y);
  write_bytes(pgm, to_pgm(image));
  write_bytes(path, "image: " + pgm.filename().string() + "\n" + text);
}

}  // namespace files
