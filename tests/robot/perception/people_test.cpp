#include "robot/perception/people.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/matchers.hpp"

namespace robot {
namespace {

using testing::PointNear;

// What a laser at the origin sees of round bodies of 0.2 m on an open floor.
ScanView scan_of(const std::vector<Point>& people, Time time) {
  ScanView scan{.time = time,
                .laser = LaserId::front,
                .map_from_laser = {},
                .angle_min = -pi / 2,
                .angle_step = pi / 180,
                .ranges = {},
                .kinds = {}};
  for (int i = 0; i < 181; ++i) {
    const double bearing = scan.angle_min + i * scan.angle_step;
    const Point along{std::cos(bearing), std::sin(bearing)};
    double range = std::numeric_limits<double>::infinity();
    for (const Point& p : people) {
      const double middle = dot(p, along), off = cross(p, along);
      if (middle > 0.0 && std::abs(off) < 0.2) range = std::min(range, middle - std::sqrt(0.04 - off * off));
    }
    const bool met = std::isfinite(range);
    scan.ranges.push_back(met ? static_cast<float>(range) : std::numeric_limits<float>::quiet_NaN());
    scan.kinds.push_back(met ? BeamKind::person : BeamKind::no_return);
  }
  return scan;
}

TEST(FindBodies, FindsEachPersonOnce) {
  const auto bodies = find_bodies(scan_of({{2, 0}, {3, 2}, {1, -1.5}}, {}));
  ASSERT_EQ(bodies.size(), 3u);
  EXPECT_THAT(bodies[0].position, PointNear(Point{1, -1.5}, 0.12));
  EXPECT_THAT(bodies[1].position, PointNear(Point{2, 0}, 0.12));
  EXPECT_THAT(bodies[2].position, PointNear(Point{3, 2}, 0.12));
}

TEST(FindBodies, LeavesOutTheMapAndWhatIsTooFar) {
  ScanView scan = scan_of({{2, 0}, {9, 0.5}}, {});
  EXPECT_EQ(find_bodies(scan).size(), 1u);
  for (BeamKind& kind : scan.kinds) kind = BeamKind::map;
  EXPECT_TRUE(find_bodies(scan).empty());
}

TEST(FindBodies, TakesBrokenScansWithoutHarm) {
  ScanView scan = scan_of({{2, 0}}, {});
  scan.kinds.resize(60);
  EXPECT_TRUE(find_bodies(scan).empty());
  scan.ranges.clear();
  EXPECT_TRUE(find_bodies(scan).empty());
}

TEST(PeopleTracker, FollowsWalkersAndKeepsTheirIds) {
  PeopleTracker tracker;
  for (int i = 0; i <= 40; ++i) {
    const double t = 0.05 * i;
    tracker.add(scan_of({{3, -1 + t}, {3, 1.5 - t}}, from_seconds(t)));  // they pass each other
  }
  const People people = tracker.people(from_seconds(2.0));
  ASSERT_EQ(people.people.size(), 2u);
  EXPECT_NEAR(std::abs(people.people[0].velocity.y), 1.0, 0.25);
  EXPECT_NE(people.people[0].id, people.people[1].id);
}

TEST(PeopleTracker, NeedsSeveralSightingsAndForgets) {
  PeopleTracker tracker;
  tracker.add(scan_of({{2, 0}}, from_seconds(0)));
  EXPECT_TRUE(tracker.people(from_seconds(0)).people.empty());
  for (int i = 1; i < 5; ++i) tracker.add(scan_of({{2, 0}}, from_seconds(0.05 * i)));
  EXPECT_EQ(tracker.people(from_seconds(0.2)).people.size(), 1u);
  EXPECT_TRUE(tracker.people(from_seconds(2.0)).people.empty());
}

TEST(People, AreCountedNearAndOnTheWay) {
  const People people{.time = {},
                      .people = {{.position = {1, 0.2}, .velocity = {}, .id = 1},
                                 {.position = {4, 0}, .velocity = {}, .id = 2},
                                 {.position = {1, 2}, .velocity = {}, .id = 3}}};
  EXPECT_EQ(people_within(people, {0, 0}, 2.5), 2);
  EXPECT_EQ(people_on_path(people, {{0, 0}, {5, 0}}, 3.0, 0.6), 1);
  EXPECT_EQ(people_on_path(people, {{0, 0}, {5, 0}}, 6.0, 0.6), 2);
  EXPECT_EQ(people_on_path(people, {}, 6.0, 0.6), 0);
}

}  // namespace
}  // namespace robot
