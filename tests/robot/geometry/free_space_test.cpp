#include "robot/geometry/free_space.hpp"

#include <gtest/gtest.h>

#include "tests/support/ascii_world.hpp"

namespace robot {
namespace {

using testing::draw_world;

// Two rooms joined by a passage 3 cells (0.3 m) wide.
// clang-format off
const auto rooms = draw_world(0.1, {"#####################",
                                    "#         #         #",
                                    "#         #         #",
                                    "#    A              #",
                                    "#              B    #",
                                    "#                   #",
                                    "#         #         #",
                                    "#         #         #",
                                    "#####################"});
// clang-format on

bool reaches(const Mask& open, double radius, Point from, Point to) {
  const auto mask = reachable_cells(cells_clear_for(open, radius), from);
  return mask.at_or(mask.cell(to), 0) != 0;
}

TEST(FreeSpace, BodyPassesOnlyWhereItFits) {
  const auto open = open_cells(rooms.map, {}, {});
  EXPECT_TRUE(reaches(open, 0.15, rooms.at('A'), rooms.at('B')));
  EXPECT_FALSE(reaches(open, 0.25, rooms.at('A'), rooms.at('B')));
}

TEST(FreeSpace, HazardClosesAPassageThatTheMapLeavesOpen) {
  const std::vector<Point> plate = {{1.0, 0.25}, {1.1, 0.25}, {1.1, 0.65}, {1.0, 0.65}};
  EXPECT_FALSE(reaches(open_cells(rooms.map, {plate}, {}), 0.05, rooms.at('A'), rooms.at('B')));
}

TEST(FreeSpace, HazardThinnerThanACellStillBlocks) {
  const std::vector<Point> wire = {{1.05, 0.0}, {1.051, 0.0}, {1.051, 0.9}};
  EXPECT_FALSE(reaches(open_cells(rooms.map, {wire}, {}), 0.05, rooms.at('A'), rooms.at('B')));
}

TEST(FreeSpace, BoundaryKeepsInside) {
  const std::vector<Point> left = {{0, 0}, {1.0, 0}, {1.0, 0.9}, {0, 0.9}};
  EXPECT_FALSE(reaches(open_cells(rooms.map, {}, left), 0.05, rooms.at('A'), rooms.at('B')));
}

TEST(FreeSpace, NothingIsReachedFromAPlaceThatIsNotClearOrOffTheMap) {
  const auto open = open_cells(rooms.map, {}, {});
  for (const Point from : {Point{0.05, 0.05}, Point{-5.0, 1.0}, Point{std::nan(""), 0.0}}) {
    EXPECT_FALSE(reaches(open, 0.05, from, rooms.at('B')));
  }
}

TEST(FreeSpace, TheMapsRimIsNotOpen) {
  const OccupancyGrid bare(10, 10, 0.1, {}, free_cell);
  const auto clear = cells_clear_for(open_cells(bare, {}, {}), 0.2);
  EXPECT_FALSE((clear[{1, 5}]));
  EXPECT_TRUE((clear[{2, 5}]));
}

}  // namespace
}  // namespace robot
