#include "protocols/files/carmen_map.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

#include "protocols/files/bytes.hpp"
#include "protocols/files/fields.hpp"
#include "protocols/files/map_server_file.hpp"
#include "protocols/files/problem.hpp"

namespace files {
namespace {

constexpr std::size_t max_map_bytes = 256u << 20;
constexpr int max_cells_a_side = 8000;
constexpr std::string_view magic = "CARMENMAPFILE";
constexpr std::string_view version = "v020";
constexpr unsigned char gridmap_chunk = 1, places_chunk = 4;

// Little-endian values from the front of a byte string; fails softly at its end.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : bytes_(bytes) {}
  std::size_t left() const { return bytes_.size(); }
  std::optional<std::string_view> take(std::size_t count) {
    if (count > bytes_.size()) return std::nullopt;
    const auto front = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return front;
  }
  std::optional<std::uint32_t> u32() {
    const auto four = take(4);
    if (!four) return std::nullopt;
    std::uint32_t value = 0;
    for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>((*four)[static_cast<std::size_t>(i)]);
    return value;
  }
  std::optional<float> f32() {
    const auto bits = u32();
    return bits ? std::optional(std::bit_cast<float>(*bits)) : std::nullopt;
  }

 private:
  std::string_view bytes_;
};

// The makers of wean.dat gave everything within some ten metres of the robot's way a value that fades about 0.6, seen
// or not: between a wall's and the floor's values nothing was observed.
bool is_halo(double free) { return free > 0.35 && free < 0.85; }

std::int8_t per_cent(double occupied) {
  if (!(occupied >= 0.0)) return robot::unknown_cell;
  return static_cast<std::int8_t>(std::lround(100.0 * std::min(occupied, 1.0)));
}

robot::OccupancyGrid gridmap(Cursor in, const std::string& name) {
  const auto width = in.u32(), height = in.u32();
  const auto resolution = in.f32();
  if (!width || !height || !resolution || *width < 1 || *height < 1 || *width > max_cells_a_side ||
      *height > max_cells_a_side || !(*resolution >= 0.001f && *resolution <= 10.0f)) {
    throw FileError({name, 0, "its grid has an unusable size or resolution", "write the map again"});
  }
  if (in.left() / 4 < static_cast<std::size_t>(*width) * *height) {
    throw FileError({name, 0, "its grid is cut short", "fetch the map again"});
  }
  robot::OccupancyGrid grid(static_cast<int>(*width), static_cast<int>(*height), std::round(*resolution * 1e5) / 1e5,
                            {});
  for (int x = 0; x < grid.width(); ++x) {
    for (int y = 0; y < grid.height(); ++y) grid[{x, y}] = per_cent(*in.f32());
  }
  return grid;
}

// int32 count; each: int32 type, 20 characters of name, then two floats (type 0), three (1) or six (2).
std::vector<NamedPlace> places(Cursor in, const std::string& name) {
  const FileError broken({name, 0, "its list of places is damaged", "fetch the map again"});
  const auto count = in.u32();
  if (!count || *count > 10'000) throw broken;
  std::vector<NamedPlace> found;
  for (std::uint32_t i = 0; i < *count; ++i) {
    const auto type = in.u32();
    const auto label = in.take(20);
    const auto x = in.f32(), y = in.f32();
    if (!type || *type > 2 || !label || !x || !y || !std::isfinite(*x) || !std::isfinite(*y)) throw broken;
    NamedPlace place{std::string(label->substr(0, label->find('\0'))), {*x, *y}, {}};
    if (*type >= 1) {
      const auto theta = in.f32();
      if (!theta || !std::isfinite(*theta)) throw broken;
      place.theta = robot::wrap_angle(*theta);
    }
    if (*type == 2 && !in.take(12)) throw broken;
    found.push_back(std::move(place));
  }
  return found;
}

}  // namespace

CarmenMap parse_carmen_map(std::string_view bytes, const std::string& name) {
  const auto start = bytes.find(magic);
  if (start == std::string_view::npos || !bytes.substr(start + magic.size()).starts_with(version)) {
    throw FileError({name, 0, "is not a CARMEN map of version 0.20", "give a file with " + std::string(magic)});
  }
  Cursor in(bytes.substr(start + magic.size() + version.size()));
  CarmenMap map;
  while (in.left() >= 15) {  // a chunk's head; some maps end in a stray line end
    const auto type = in.take(1);
    const auto size = in.u32();
    const auto chunk = size ? in.take(*size) : std::nullopt;
    if (!chunk || chunk->size() < 10) throw FileError({name, 0, "is cut short", "fetch the map again"});
    const Cursor body(chunk->substr(10));  // after the chunk's name
    if (static_cast<unsigned char>(type->front()) == gridmap_chunk) map.grid = gridmap(body, name);
    if (static_cast<unsigned char>(type->front()) == places_chunk) map.places = places(body, name);
  }
  if (map.grid.empty()) throw FileError({name, 0, "holds no grid", "give a map with a GRIDMAP chunk"});
  return map;
}

CarmenMap read_carmen_map(const std::filesystem::path& path) {
  return parse_carmen_map(read_bytes(path, max_map_bytes), path.string());
}

robot::OccupancyGrid parse_wean_map(std::string_view text, const std::string& name) {
  robot::OccupancyGrid grid;
  double resolution = 0.1;
  int x = 0;
  for_each_line(text, [&](int number, std::string_view line) {
    Fields fields(line);
    if (grid.empty()) {
      const auto key = fields.word();
      if (key == "robot_specifications->resolution") resolution = fields.number().value_or(10.0) / 100.0;
      if (key != "global_map[0]:") return;
      const auto width = fields.integer(), height = fields.integer();
      if (!width || !height || *width < 1 || *height < 1 || *width > max_cells_a_side || *height > max_cells_a_side ||
          !(resolution >= 0.001 && resolution <= 10.0)) {
        throw FileError({name, number, "the map has an unusable size or resolution", "give columns and rows"});
      }
      // A value takes two characters at least: what the text cannot hold takes no memory.
      if (static_cast<std::size_t>(*width) * static_cast<std::size_t>(*height) * 2 > text.size()) {
        throw FileError({name, number, "the map is cut short", "fetch it again"});
      }
      grid = robot::OccupancyGrid(*width, *height, resolution, {}, robot::unknown_cell);
      return;
    }
    if (x >= grid.width()) return;
    for (int y = 0; y < grid.height(); ++y) {
      const auto free = fields.number();
      if (!free) throw FileError({name, number, "the row is cut short or not of numbers", "fetch the map again"});
      grid[{x, y}] = *free < 0.0 || is_halo(*free) ? robot::unknown_cell : per_cent(1.0 - *free);
    }
    ++x;
  });
  if (grid.empty()) throw FileError({name, 0, "holds no global_map", "give a map such as wean.dat"});
  if (x < grid.width()) throw FileError({name, 0, "rows are missing", "fetch the map again"});
  return grid;
}

robot::OccupancyGrid read_wean_map(const std::filesystem::path& path) {
  return parse_wean_map(read_bytes(path, max_map_bytes), path.string());
}

robot::OccupancyGrid read_map(const std::filesystem::path& path) {
  if (path.extension() == ".yaml" || path.extension() == ".yml") return read_map_server(path);
  if (std::filesystem::is_directory(path)) return read_map_server(path / "map.yaml");
  const auto bytes = read_bytes(path, max_map_bytes);
  if (bytes.find(magic) != std::string::npos) return parse_carmen_map(bytes, path.string()).grid;
  if (bytes.find("global_map[0]:") != std::string::npos) return parse_wean_map(bytes, path.string());
  throw FileError({path.string(), 0, "is not a map that is known here", "give map.yaml, a CARMEN .map or wean.dat"});
}

}  // namespace files
