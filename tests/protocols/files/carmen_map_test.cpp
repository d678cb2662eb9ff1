#include "protocols/files/carmen_map.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <bit>

#include "protocols/files/problem.hpp"
#include "tests/support/hostile_bytes.hpp"
#include "tests/support/recorded_data.hpp"

namespace files {
namespace {

using ::testing::SizeIs;
using testing_support::recorded_data;

std::string u32(std::uint32_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 255);
  return bytes;
}
std::string f32(float value) { return u32(std::bit_cast<std::uint32_t>(value)); }

std::string chunk(char type, const std::string& name, const std::string& body) {
  std::string label = name;
  label.resize(10, ' ');
  return type + u32(static_cast<std::uint32_t>(10 + body.size())) + label + body;
}

// Two columns, three rows, one named pose.
std::string small_map() {
  std::string grid = u32(2) + u32(3) + f32(0.1f);
  for (const float value : {0.0f, 1.0f, -1.0f, 0.5f, 0.25f, 0.0f}) grid += f32(value);
  std::string label = "door";
  label.resize(20, '\0');
  const std::string places = u32(1) + u32(1) + label + f32(1.5f) + f32(2.5f) + f32(0.5f);
  return "# made here\nCARMENMAPFILEv020" + chunk(32, "CREATOR", "somebody") + chunk(1, "GRIDMAP", grid) +
         chunk(4, "PLACES", places);
}

TEST(CarmenMap, ReadsColumnsAndPlaces) {
  const auto map = parse_carmen_map(small_map(), "a.map");
  EXPECT_EQ(map.grid.width(), 2);
  EXPECT_EQ(map.grid.height(), 3);
  EXPECT_DOUBLE_EQ(map.grid.resolution(), 0.1);
  EXPECT_EQ((map.grid[{0, 1}]), 100);
  EXPECT_EQ((map.grid[{0, 2}]), robot::unknown_cell);
  EXPECT_EQ((map.grid[{1, 0}]), 50);
  ASSERT_THAT(map.places, SizeIs(1));
  EXPECT_EQ(map.places[0].name, "door");
  EXPECT_NEAR(map.places[0].theta.value_or(0), 0.5, 1e-6);
}

RC_GTEST_PROP(CarmenMap, DamagedMapsAreReadOrRefused, ()) {
  try {
    RC_ASSERT(!parse_carmen_map(*testing_support::damaged(small_map()), "a.map").grid.empty());
  } catch (const FileError& error) {
    RC_ASSERT(!error.problem().text.empty());
  }
}

RC_GTEST_PROP(CarmenMap, DamagedWeanMapsAreReadOrRefused, ()) {
  const std::string good = "robot_specifications->resolution 10\n\nglobal_map[0]: 2 3\n-1 0.9 0.1\n1 0 0.5\n";
  try {
    RC_ASSERT(!parse_wean_map(*testing_support::damaged(good), "wean.dat").empty());
  } catch (const FileError& error) {
    RC_ASSERT(!error.problem().text.empty());
  }
}

TEST(CarmenMap, WeanRowsAreColumnsAndHighMeansFree) {
  const auto grid =
      parse_wean_map("robot_specifications->resolution 10\n\nglobal_map[0]: 2 3\n-1 0.9 0.1\n1 0 0.5\n", "wean.dat");
  EXPECT_EQ((grid[{0, 0}]), robot::unknown_cell);
  EXPECT_EQ((grid[{0, 1}]), 10);
  EXPECT_EQ((grid[{0, 2}]), 90);
  EXPECT_EQ((grid[{1, 1}]), 100);
  EXPECT_EQ((grid[{1, 2}]), robot::unknown_cell) << "neither wall nor floor";
  EXPECT_DOUBLE_EQ(grid.resolution(), 0.1);
}

TEST(CarmenMap, ReadsTheRecordedMaps) {
  const auto thick = recorded_data("maps/thickwean.map"), wean = recorded_data("wean/wean.dat.gz");
  NEED_RECORDING(thick);
  const auto map = read_map(thick);
  EXPECT_EQ(map.width(), 477);
  EXPECT_EQ(map.height(), 170);
  EXPECT_FALSE(read_map(recorded_data("maps/longwood.walls.map")).empty());
  const auto hall = read_map(wean);
  EXPECT_EQ(hall.width(), 800);
  std::size_t walls = 0, floor = 0;
  for (const auto value : hall.cells()) {
    walls += robot::is_occupied(value);
    floor += robot::is_free(value);
  }
  EXPECT_NEAR(static_cast<double>(floor), 45'000, 5'000) << "some 450 square metres of corridor and hall";
  EXPECT_NEAR(static_cast<double>(walls), 20'000, 3'000);
}

TEST(CarmenMap, UnknownFilesAreRefused) {
  EXPECT_THROW(parse_carmen_map("hello", "a.map"), FileError);
  EXPECT_THROW(parse_wean_map("hello", "a.dat"), FileError);
  EXPECT_THROW(read_map("/nowhere/at/all.map"), FileError);
}

}  // namespace
}  // namespace files
