#include "robot/perception/people.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "robot/geometry/random.hpp"
#include "tests/support/matchers.hpp"

namespace robot {
namespace {

using testing::PointNear;

struct Walker {
  Point position;
  Point velocity;
};

// A scan of 181 beams over a hall in which round people of 0.1 m stand; everything else is the map, 8 m away.
ScanView scan_of(const std::vector<Walker>& walkers, const Pose& map_from_laser, Time time, Random& random) {
  ScanView scan;
  scan.time = time;
  scan.map_from_laser = map_from_laser;
  scan.angle_min = -pi / 2;
  scan.angle_step = pi / 180;
  for (int i = 0; i < 181; ++i) {
    const double angle = map_from_laser.theta + scan.angle_min + i * scan.angle_step;
    const Point ray{std::cos(angle), std::sin(angle)};
    double range = 8.0;
    for (const Walker& walker : walkers) {
      const Point center = walker.position - map_from_laser.position();
      const double along = dot(center, ray), half = 0.01 - std::pow(cross(ray, center), 2);
      if (half > 0.0 && along > 0.0) range = std::min(range, along - std::sqrt(half));
    }
    scan.kinds.push_back(range < 8.0 ? BeamKind::person : BeamKind::map);
    scan.ranges.push_back(static_cast<float>(range + random.normal(0.01)));
  }
  return scan;
}

TEST(FindBodies, TwoPeopleApartAreTwoBodies) {
  Random random(1);
  const auto bodies = find_bodies(scan_of({{{3, 1}, {}}, {{2, -1}, {}}}, {}, {}, random));
  ASSERT_EQ(bodies.size(), 2u);
  EXPECT_THAT(bodies[0].position, PointNear(Point{2, -1}, 0.1));
  EXPECT_THAT(bodies[1].position, PointNear(Point{3, 1}, 0.1));
}

TEST(FindBodies, AWideClusterIsSeveralPeople) {
  Random random(1);
  const auto bodies = find_bodies(scan_of({{{2, -0.4}, {}}, {{2, 0}, {}}, {{2, 0.4}, {}}}, {}, {}, random));
  EXPECT_GE(bodies.size(), 2u);
  EXPECT_LE(bodies.size(), 3u);
}

TEST(FindBodies, TheMapNoiseAndBrokenScansAreNobody) {
  Random random(1);
  EXPECT_TRUE(find_bodies(scan_of({}, {}, {}, random)).empty());
  ScanView single = scan_of({}, {}, {}, random);
  single.kinds[40] = BeamKind::person;
  single.ranges[40] = 1.0f;
  EXPECT_TRUE(find_bodies(single).empty());
  ScanView nothing = scan_of({{{2, 0}, {}}}, {}, {}, random);
  for (auto& range : nothing.ranges) range = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(find_bodies(nothing).empty());
  ScanView broken = scan_of({{{2, 0}, {}}}, {}, {}, random);
  broken.kinds.resize(3);
  EXPECT_TRUE(find_bodies(broken).empty());
}

TEST(PeopleTracker, FollowsWalkersWithStableIdsAndTheirVelocity) {
  Random random(2);
  std::vector<Walker> walkers = {{{1, -2}, {0.3, 0.8}}, {{4, 2}, {-0.6, 0.0}}, {{2, 1.5}, {0, 0}}};
  PeopleTracker tracker;
  std::vector<int> ids;
  for (int i = 0; i < 60; ++i) {
    const Time now = from_seconds(0.05 * i);
    tracker.add(scan_of(walkers, {-0.5, 0, 0.1}, now, random));
    const People seen = tracker.people(now);
    if (i == 20) {
      for (const auto& person : seen.people) ids.push_back(person.id);
    }
    if (i > 20) {
      ASSERT_EQ(seen.people.size(), ids.size());
      for (std::size_t k = 0; k < ids.size(); ++k) EXPECT_EQ(seen.people[k].id, ids[k]);
    }
    for (Walker& walker : walkers) walker.position = walker.position + 0.05 * walker.velocity;
  }
  ASSERT_EQ(ids.size(), 3u);
  const People people = tracker.people(from_seconds(3.0));
  for (const Walker& walker : walkers) {
    EXPECT_THAT(people.people, ::testing::Contains(::testing::Truly([&](const PersonSeen& person) {
                  return distance(person.position, walker.position) < 0.2 &&
                         distance(person.velocity, walker.velocity) < 0.25;
                })));
  }
}

TEST(PeopleTracker, WhoIsGoneIsForgottenAfterASecond) {
  Random random(3);
  PeopleTracker tracker;
  for (int i = 0; i < 10; ++i) tracker.add(scan_of({{{2, 0}, {}}}, {}, from_seconds(0.05 * i), random));
  EXPECT_EQ(tracker.people(from_seconds(0.5)).people.size(), 1u);
  EXPECT_EQ(tracker.people(from_seconds(2.0)).people.size(), 0u);
  for (int i = 10; i < 40; ++i) tracker.add(scan_of({}, {}, from_seconds(0.05 * i), random));
  EXPECT_TRUE(tracker.people(from_seconds(1.95)).people.empty());
}

TEST(PeopleTracker, AGlimpseIsNobodyYet) {
  Random random(3);
  PeopleTracker tracker;
  for (int i = 0; i < 2; ++i) tracker.add(scan_of({{{2, 0}, {}}}, {}, from_seconds(0.05 * i), random));
  EXPECT_TRUE(tracker.people(from_seconds(0.1)).people.empty());
}

TEST(People, AreCountedNearAndOnThePath) {
  People people;
  people.people = {{{1, 0}, {}, 1}, {{4, 0.2}, {}, 2}, {{0, 2.5}, {}, 3}};
  EXPECT_EQ(people_within(people, {0, 0}, 3.0), 2);
  const std::vector<Point> path = {{0, 0}, {2, 0}, {6, 0}};
  EXPECT_EQ(people_on_path(people, path, 3.0, 0.5), 1);
  EXPECT_EQ(people_on_path(people, path, 5.0, 0.5), 2);
  EXPECT_EQ(people_on_path(people, {}, 5.0, 0.5), 0);
}

}  // namespace
}  // namespace robot
