#include "robot/motion/virtual_sensors.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "robot/geometry/random.hpp"
#include "tests/support/matchers.hpp"

namespace robot {
namespace {

// A hall of 20 x 10 m with a trench across it between x = 12 and 13 m.
Museum hall_with_trench() {
  Museum museum;
  museum.map = OccupancyGrid(400, 200, 0.05, {}, free_cell);
  museum.hazards.push_back({"trench", HazardKind::staircase, {{12, 0}, {13, 0}, {13, 10}, {12, 10}}, {}});
  return museum;
}

std::vector<Pose> spread(const Pose& mean, double sigma, int count, std::uint64_t seed = 1) {
  Random random(seed);
  std::vector<Pose> samples;
  for (int i = 0; i < count; ++i) {
    samples.push_back({mean.x + random.normal(sigma), mean.y + random.normal(sigma), mean.theta});
  }
  return samples;
}

TEST(VirtualSensors, DirectionsTurnWithTheRobot) {
  const VirtualSensors sensors(hall_with_trench());
  for (const double theta : {0.3, -0.7, 2.0, -2.8}) {
    const auto readings = sensors.read(std::vector<Pose>{{10.5, 5.0, theta}});
    for (std::size_t d = 0; d < readings.ranges.size(); ++d) {
      const double c =
          std::cos(theta + 2.0 * pi * static_cast<double>(d) / static_cast<double>(readings.ranges.size()));
      const double expected = c > 0.6 ? std::min(2.5, 1.5 / c - 0.05) : 2.5;
      if (c > 0.6 || c < 0.4) {
        EXPECT_NEAR(readings.ranges[d], expected, 0.06) << theta << " " << d;
      }
    }
  }
}

float ahead(const VirtualReadings& readings) { return readings.ranges.front(); }

TEST(VirtualSensors, ACertainRobotReadsTheTrueDistance) {
  const VirtualSensors sensors(hall_with_trench());
  const auto readings = sensors.read(std::vector<Pose>{{10.5, 5.0, 0.0}});
  EXPECT_NEAR(ahead(readings), 1.5 - 0.04, 0.03);
  EXPECT_LE(ahead(readings), 1.5);
  EXPECT_NEAR(readings.clearance, 1.5 - 0.06, 0.05);
  EXPECT_NEAR(readings.outward.x, -1.0, 1e-3);
  EXPECT_FLOAT_EQ(readings.ranges[60], 2.5f);  // nothing behind
  // The same place seen while heading north: the trench is on the right.
  const auto turned = sensors.read(std::vector<Pose>{{10.5, 5.0, pi / 2}});
  EXPECT_NEAR(turned.ranges[90], 1.46, 0.03);
  EXPECT_NEAR(turned.outward.y, 1.0, 1e-3);
}

TEST(VirtualSensors, UncertaintyShortensTheReadings) {
  const VirtualSensors sensors(hall_with_trench());
  const auto certain = sensors.read(spread({10.0, 5.0, 0.0}, 0.02, 200));
  const auto uncertain = sensors.read(spread({10.0, 5.0, 0.0}, 0.3, 200));
  EXPECT_NEAR(ahead(certain), 2.0 - 2.33 * 0.02, 0.1);
  EXPECT_NEAR(ahead(uncertain), 2.0 - 2.33 * 0.3, 0.25);
}

TEST(VirtualSensors, NothingIsReadFarAwayOrWithoutHazards) {
  const VirtualSensors sensors(hall_with_trench());
  EXPECT_TRUE(sensors.read(std::vector<Pose>{{5.0, 5.0, 0.0}}).points.empty());
  EXPECT_TRUE(sensors.read({}).points.empty());
  Museum plain;
  plain.map = OccupancyGrid(100, 100, 0.05, {}, free_cell);
  const VirtualSensors none(plain);
  EXPECT_FALSE(none.has_hazards());
  EXPECT_TRUE(none.read(std::vector<Pose>{{1.0, 1.0, 0.0}}).points.empty());
}

TEST(VirtualSensors, TheOutsideOfTheBoundaryIsAHazard) {
  Museum museum;
  museum.map = OccupancyGrid(200, 200, 0.05, {}, free_cell);
  museum.boundary = {{2, 2}, {8, 2}, {8, 8}, {2, 8}};
  const VirtualSensors sensors(museum);
  EXPECT_TRUE(sensors.has_hazards());
  EXPECT_NEAR(ahead(sensors.read(std::vector<Pose>{{7.0, 5.0, 0.0}})), 0.96, 0.03);
  EXPECT_LT(sensors.signed_distance({9.0, 5.0}), 0.0);
}

TEST(VirtualSensors, ARopeThinnerThanACellIsSeen) {
  Museum museum;
  museum.map = OccupancyGrid(200, 200, 0.05, {}, free_cell);
  museum.hazards.push_back({"rope", HazardKind::keep_out, {{4.003, 1}, {4.007, 1}, {4.007, 9}, {4.003, 9}}, {}});
  const VirtualSensors sensors(museum);
  for (double y = 3.0; y < 7.0; y += 0.017) {
    EXPECT_NEAR(ahead(sensors.read(std::vector<Pose>{{2.5, y, 0.0}})), 1.46, 0.04) << y;
  }
}

TEST(VirtualSensors, InsideAHazardOnlyOutwardMotionIsAdmissible) {
  const VirtualSensors sensors(hall_with_trench());
  const auto time = [&](double theta, Twist twist) {
    const auto readings = sensors.read(std::vector<Pose>{{12.2, 5.0, theta}});
    PointColumns points;
    for (const Point& p : readings.points) points.push_back(p);
    return time_to_hazard(readings, points, {}, twist);
  };
  EXPECT_EQ(time(0.0, {0.3, 0.0}), 0.0);          // farther in
  EXPECT_EQ(time(0.0, {-0.2, 0.0}), no_contact);  // back out
  EXPECT_EQ(time(pi, {0.3, 0.0}), no_contact);    // out ahead
  EXPECT_EQ(time(pi, {-0.2, 0.0}), 0.0);
  EXPECT_EQ(time(pi / 2, {0.3, 0.0}), 0.0);         // along
  EXPECT_EQ(time(pi / 2, {0.0, 0.5}), no_contact);  // turning towards the way out
}

// The promise of eqs. (24) and (15): of all directions and beliefs, the reading is longer than the true distance for at
// most one in a hundred of the samples.
RC_GTEST_PROP(VirtualSensorsPromise, ReadingsUnderestimateFor99PerCent, (std::uint64_t seed)) {
  static const VirtualSensors sensors(hall_with_trench());
  Random random(seed);
  const int count = 20 + static_cast<int>(random.index(180));
  std::vector<Pose> samples;
  const Pose mean{random.uniform(9.5, 12.5), random.uniform(2.0, 8.0), random.uniform(-pi, pi)};
  const double sigma = random.uniform(0.0, 0.4), turn = random.uniform(0.0, 0.3);
  for (int i = 0; i < count; ++i) {
    samples.push_back({mean.x + random.normal(sigma), mean.y + random.normal(sigma), mean.theta + random.normal(turn)});
  }
  const auto readings = sensors.read(samples);
  for (std::size_t d = 0; d < readings.ranges.size(); ++d) {
    const double angle = 2.0 * pi * static_cast<double>(d) / static_cast<double>(readings.ranges.size());
    int shorter = 0;
    for (const Pose& s : samples) {
      // Distance to the trench written down by hand.
      const double c = std::cos(s.theta + angle);
      double truth = 1e9;
      if (s.x >= 12.0 && s.x <= 13.0)
        truth = 0.0;
      else if (s.x < 12.0 && c > 0.0)
        truth = (12.0 - s.x) / c;
      else if (s.x > 13.0 && c < 0.0)
        truth = (s.x - 13.0) / -c;
      const double y = s.y + truth * std::sin(s.theta + angle);
      if (truth < 1e8 && truth > 0.0 && (y < 0.0 || y > 10.0)) truth = 1e9;  // leaves the map before
      if (truth < static_cast<double>(readings.ranges[d])) ++shorter;
    }
    RC_ASSERT(shorter <= count / 100);
  }
}

}  // namespace
}  // namespace robot
