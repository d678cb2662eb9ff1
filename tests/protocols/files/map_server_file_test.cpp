#include "protocols/files/map_server_file.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>
#include <zlib.h>

#include "protocols/files/bytes.hpp"
#include "protocols/files/problem.hpp"
#include "tests/support/hostile_bytes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace files {
namespace {

using ::testing::HasSubstr;
using testing_support::TemporaryFolder;

// 3 x 2: the top row is free, unknown, occupied.
const GreyImage picture{3, 2, {254, 205, 0, 0, 0, 254}};

std::string complaint_of(const std::filesystem::path& yaml) {
  try {
    read_map_server(yaml);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

TEST(MapServerFile, TopRowOfThePictureIsTheLargestY) {
  const auto grid = to_grid(picture, {}, 0.5, {-1.0, 2.0});
  EXPECT_EQ((grid[{0, 1}]), robot::free_cell);
  EXPECT_EQ((grid[{1, 1}]), robot::unknown_cell);
  EXPECT_EQ((grid[{2, 1}]), robot::occupied_cell);
  EXPECT_EQ((grid[{2, 0}]), robot::free_cell);
  EXPECT_EQ(grid.center({0, 0}), (robot::Point{-0.75, 2.25}));
}

TEST(MapServerFile, NegateTurnsBlackIntoFree) {
  const auto grid = to_grid(picture, {.negate = true}, 0.5, {});
  EXPECT_EQ((grid[{0, 1}]), robot::occupied_cell);
  EXPECT_EQ((grid[{2, 1}]), robot::free_cell);
}

TEST(MapServerFile, ScaleKeepsWhatLiesBetweenTheThresholds) {
  const GreyImage ramp{3, 1, {255, 128, 0}};
  const auto grid = to_grid(ramp, {.mode = MapServerRules::Mode::scale}, 1.0, {});
  EXPECT_EQ((grid[{0, 0}]), 0);
  EXPECT_NEAR((grid[{1, 0}]), 67, 2);
  EXPECT_EQ((grid[{2, 0}]), 100);
}

TEST(MapServerFile, RawTakesPixelsAsPerCent) {
  const auto grid = to_grid({3, 1, {0, 42, 255}}, {.mode = MapServerRules::Mode::raw}, 1.0, {});
  EXPECT_EQ(grid.cells(), (std::vector<std::int8_t>{0, 42, -1}));
}

TEST(MapServerFile, ReadsTextBinaryDeepAndCommentedPictures) {
  const auto text = parse_pgm("P2\n# made by hand\n3 2 # size\n255\n254 205 0\n0 0 254\n", "a.pgm");
  EXPECT_EQ(text.pixels, picture.pixels);
  EXPECT_EQ(parse_pgm(to_pgm(picture), "a.pgm").pixels, picture.pixels);
  const auto deep = parse_pgm(std::string("P5 2 1 65535\n\xff\xff\x00\x00", 17), "a.pgm");
  EXPECT_EQ(deep.pixels, (std::vector<std::uint8_t>{255, 0}));
}

RC_GTEST_PROP(MapServerFile, WrittenMapsComeBack, ()) {
  const int width = *rc::gen::inRange(1, 20), height = *rc::gen::inRange(1, 20);
  robot::OccupancyGrid map(width, height, 0.05, {*rc::gen::inRange(-500, 500) * 0.05, -1.25});
  for (auto& cell : map.cells()) cell = *rc::gen::element<std::int8_t>(0, 100, -1);
  const TemporaryFolder folder;
  write_map_server(folder.path() / "map.yaml", map);
  const auto back = read_map_server(folder.path() / "map.yaml");
  RC_ASSERT(back.cells() == map.cells());
  RC_ASSERT(robot::distance(back.origin(), map.origin()) < 1e-6);
  RC_ASSERT(back.resolution() == map.resolution());
}

RC_GTEST_PROP(MapServerFile, DamagedPicturesAreReadOrRefused, ()) {
  const auto bytes = *testing_support::damaged(*rc::gen::element<std::string>(
      to_pgm(picture), "P2\n3 2 255\n254 205 0\n0 0 254\n", "P5 99999 99999 255\n", "P2 -3 2 255"));
  try {
    const auto image = parse_pgm(bytes, "a.pgm");
    RC_ASSERT(image.pixels.size() == static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  } catch (const FileError& error) {
    RC_ASSERT(!error.problem().text.empty());
  }
}

RC_GTEST_PROP(MapServerFile, DamagedYamlIsReadOrRefused, ()) {
  const TemporaryFolder folder;
  folder.write("map.pgm", to_pgm(picture));
  const auto yaml = folder.write(
      "map.yaml", *testing_support::damaged("image: map.pgm\nresolution: 0.05\norigin: [-1.0, 2.0, 0.0]\nnegate: 0\n"
                                            "occupied_thresh: 0.65\nfree_thresh: 0.196\nmode: trinary\n"));
  try {
    RC_ASSERT(read_map_server(yaml).size() == 6u);
  } catch (const FileError& error) {
    RC_ASSERT(!error.problem().text.empty());
  }
}

TEST(MapServerFile, SaysWhatIsWrongAndWhere) {
  const TemporaryFolder folder;
  folder.write("map.pgm", to_pgm(picture));
  const auto complaint = [&](const std::string& yaml) { return complaint_of(folder.write("map.yaml", yaml)); };
  EXPECT_THAT(complaint("image: map.pgm\nresolution: 0.05\norigin: [0, 0, 1.5708]\n"),
              HasSubstr("map.yaml:3: the map is turned"));
  EXPECT_THAT(complaint("image: map.pgm\norigin: [0, 0, 0]\n"), HasSubstr("resolution is missing"));
  EXPECT_THAT(complaint("image: map.pgm\nresolution: .nan\norigin: [0, 0, 0]\n"), HasSubstr("map.yaml:2: resolution"));
  EXPECT_THAT(complaint("image: map.pgm\nresolution: 0.05\norigin: [0, .inf, 0]\n"), HasSubstr("map.yaml:3: origin"));
  EXPECT_THAT(complaint("image: no.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n"), HasSubstr("no.pgm: no such file"));
  EXPECT_THAT(complaint("image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nmode: fancy\n"),
              HasSubstr("map.yaml:4: unknown mode"));
  EXPECT_THAT(complaint("[1, 2"), HasSubstr("is not YAML"));
  EXPECT_THAT(complaint("just words"), HasSubstr("keys and values"));
}

std::string gzipped(const std::string& bytes) {
  std::string packed(compressBound(bytes.size()) + 64, '\0');
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

TEST(Bytes, GzippedFilesAreReadAsTheyAre) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.gz", gzipped("hello") + gzipped(" again"));
  EXPECT_EQ(read_bytes(file, 100), "hello again");
}

TEST(Bytes, CutGzipIsRefused) {
  const auto packed = gzipped(std::string(1000, 'x'));
  EXPECT_THROW(gunzip(packed.substr(0, packed.size() / 2), 10000, "a"), FileError);
}

TEST(Bytes, WhatUnpacksBeyondTheLimitIsRefused) {
  EXPECT_THROW(gunzip(gzipped(std::string(1'000'000, 'x')), 10'000, "a"), FileError);
  const TemporaryFolder folder;
  EXPECT_THROW(read_bytes(folder.write("big", std::string(100, 'x')), 99), FileError);
  EXPECT_THROW(read_bytes(folder.path(), 99), FileError);
}

}  // namespace
}  // namespace files
