#include "robot/mapping/obstacle_layers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace robot {
namespace {

using ::testing::IsEmpty;
using ::testing::Not;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

OccupancyGrid open_hall() { return OccupancyGrid(200, 200, 0.05, {-5.0, -5.0}, free_cell); }

// A front scan of 181 beams from the origin, all of them ending at `far`, except those within `half_width` degrees of
// straight ahead, which meet something at `range`.
ScanView scan_with_object(float range, int half_width, float far = 4.5f) {
  ScanView scan;
  scan.angle_min = -pi / 2;
  scan.angle_step = pi / 180;
  scan.ranges.assign(181, far);
  scan.kinds.assign(181, BeamKind::map);
  for (int i = 90 - half_width; i <= 90 + half_width; ++i) {
    scan.ranges[static_cast<std::size_t>(i)] = range;
    scan.kinds[static_cast<std::size_t>(i)] = BeamKind::person;
  }
  return scan;
}

SonarScan heard(std::vector<SonarReading> readings) { return {Time{}, std::move(readings)}; }

TEST(ObstacleLayers, SomethingThatStaysBecomesAnObstacle) {
  ObstacleLayers layers(open_hall());
  const Cell ahead = layers.map().cell({2.0, 0.0});
  layers.add(scan_with_object(2.0f, 3));
  EXPECT_FALSE(layers.blocked(ahead));  // a single look is no obstacle yet
  for (int i = 0; i < 30; ++i) layers.add(scan_with_object(2.0f, 3));
  EXPECT_TRUE(layers.blocked(ahead));
  EXPECT_THAT(layers.take_changes(), ::testing::Contains(ahead));
  EXPECT_THAT(layers.take_changes(), IsEmpty());
  EXPECT_TRUE(is_occupied(layers.integrated()[ahead]));
}

TEST(ObstacleLayers, ABeamThatPassesClearsAtOnce) {
  ObstacleLayers layers(open_hall());
  for (int i = 0; i < 30; ++i) layers.add(scan_with_object(2.0f, 3));
  ASSERT_THAT(layers.blocked_cells(), Not(IsEmpty()));
  layers.take_changes();
  layers.add(scan_with_object(4.5f, 0));
  EXPECT_THAT(layers.blocked_cells(), IsEmpty());
  EXPECT_THAT(layers.take_changes(), Not(IsEmpty()));
}

TEST(ObstacleLayers, BeamsWithoutReturnClearNothing) {
  ObstacleLayers layers(open_hall());
  for (int i = 0; i < 30; ++i) layers.add(scan_with_object(2.0f, 3));
  layers.add(scan_with_object(nan, 90));
  EXPECT_TRUE(layers.blocked(layers.map().cell({2.0, 0.0})));
}

TEST(ObstacleLayers, WhatNobodyLooksAtFadesWithTheHalfLife) {
  ObstacleLayers layers(open_hall());
  layers.decay(from_seconds(0));
  for (int i = 0; i < 40; ++i) layers.add(scan_with_object(2.0f, 3));
  const Cell ahead = layers.map().cell({2.0, 0.0});
  ASSERT_EQ(layers.laser().evidence(ahead), 100);
  for (int t = 1; t <= 9; ++t) layers.decay(from_seconds(t));
  EXPECT_TRUE(layers.blocked(ahead));
  for (int t = 10; t <= 12; ++t) layers.decay(from_seconds(t));
  EXPECT_FALSE(layers.blocked(ahead));
  for (int t = 13; t <= 120; ++t) layers.decay(from_seconds(t));
  EXPECT_THAT(layers.laser().active(), IsEmpty());
}

TEST(ObstacleLayers, BeamsThatMeetTheMapMarkNothing) {
  ObstacleLayers layers(open_hall());
  for (int i = 0; i < 40; ++i) layers.add(scan_with_object(4.5f, -1));
  EXPECT_THAT(layers.laser().active(), IsEmpty());
}

TEST(ObstacleLayers, ScansThatMakeNoSenseAreLeftOut) {
  ObstacleLayers layers(open_hall());
  ScanView scan = scan_with_object(2.0f, 3);
  scan.kinds.pop_back();
  layers.add(scan);
  scan = scan_with_object(2.0f, 3);
  scan.map_from_laser.x = std::numeric_limits<double>::quiet_NaN();
  layers.add(scan);
  scan = scan_with_object(-1.0f, 90);
  layers.add(scan);
  EXPECT_THAT(layers.laser().active(), IsEmpty());
}

TEST(ObstacleLayers, SonarMarksWhatLasersPassOver) {
  ObstacleLayers layers(open_hall());
  const auto mounts = standard_body().sonars;
  const SonarScan echo = heard({{.sonar = 0, .range = 1.0f}});
  for (int i = 0; i < 3; ++i) layers.add(echo, {}, mounts);
  const Point low = mounts[0].base_from_sonar * Point{1.0, 0.0};
  EXPECT_TRUE(layers.sonar().blocked(layers.map().cell(low)));
  EXPECT_THAT(layers.sonar_obstacles_near({}, 2.0), Not(IsEmpty()));
  EXPECT_THAT(layers.sonar_obstacles_near({}, 0.5), IsEmpty());
  // Three free looks over the same place take it away again.
  const SonarScan silence = heard({{.sonar = 0, .range = 3.0f}});
  for (int i = 0; i < 3; ++i) layers.add(silence, {}, mounts);
  EXPECT_THAT(layers.blocked_cells(), IsEmpty());
}

TEST(ObstacleLayers, EchoesOfWallsAndOfPeopleThatTheLaserSeesMarkNothing) {
  const auto mounts = standard_body().sonars;
  const SonarScan echo = heard({{.sonar = 0, .range = 1.0f}});
  OccupancyGrid walled = open_hall();
  for (int y = 0; y < walled.height(); ++y) walled[{walled.cell({1.27, 0.0}).x, y}] = occupied_cell;
  ObstacleLayers near_wall(walled);
  for (int i = 0; i < 5; ++i) near_wall.add(echo, {}, mounts);
  EXPECT_THAT(near_wall.sonar().active(), IsEmpty());
  ObstacleLayers near_person(open_hall());
  near_person.add(scan_with_object(1.27f, 8));
  for (int i = 0; i < 5; ++i) near_person.add(echo, {}, mounts);
  EXPECT_THAT(near_person.sonar().active(), IsEmpty());
}

TEST(ObstacleLayers, SonarsThatDoNotExistAreLeftOut) {
  ObstacleLayers layers(open_hall());
  const SonarScan scan =
      heard({{.sonar = -1, .range = 1.0f}, {.sonar = 24, .range = 1.0f}, {.sonar = 3, .range = nan}});
  layers.add(scan, {}, standard_body().sonars);
  EXPECT_THAT(layers.sonar().active(), IsEmpty());
}

TEST(ObstacleLayers, ForgettingWorksEverywhereOrRoundAPoint) {
  ObstacleLayers layers(open_hall());
  for (int i = 0; i < 30; ++i) layers.add(scan_with_object(2.0f, 20));
  const std::size_t all = layers.blocked_cells().size();
  layers.forget_near({2.0, 0.0}, 0.3);
  EXPECT_LT(layers.blocked_cells().size(), all);
  EXPECT_THAT(layers.blocked_cells(), Not(IsEmpty()));
  layers.forget();
  EXPECT_THAT(layers.blocked_cells(), IsEmpty());
}

}  // namespace
}  // namespace robot
