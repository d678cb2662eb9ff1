#include "robot/simulation/sensors.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/robot/simulation/scenes.hpp"

namespace robot::simulation {
namespace {

constexpr SensorNoise no_noise{0.0, 0.0, 0.0, 0.0, pi, 0.0, 0.0};

Museum room_with_pillars() {
  Museum museum = testing::hall(12.0, 9.0);
  testing::build(museum, 3.0, 2.0, 3.6, 2.6);
  testing::build(museum, 7.9, 5.0, 8.3, 7.0);
  return museum;
}

std::vector<Person> some_people(Random& random) {
  std::vector<Person> people(8);
  for (auto& person : people) {
    person.position = {random.uniform(0.5, 11.5), random.uniform(0.5, 8.5)};
    person.heading = random.uniform(-pi, pi);
    person.velocity = {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
    person.stride = random.uniform(-pi, pi);
  }
  return people;
}

// Walks the beam in steps of a millimetre.
double brute_force(const OccupancyGrid& map, const std::vector<Person>& people, Point from, double angle,
                   double limit) {
  const Point way{std::cos(angle), std::sin(angle)};
  for (double t = 0.0; t < limit; t += 1e-3) {
    const Point p = from + t * way;
    if (is_occupied(map.at_or(map.cell(p), free_cell))) return t;
    for (const auto& person : people) {
      for (const Point leg : legs(person)) {
        if (distance(leg, p) < leg_radius) return t;
      }
    }
  }
  return limit;
}

TEST(Sensors, LaserWithoutNoiseIsExact) {
  const Museum museum = room_with_pillars();
  const Walls walls(museum.map);
  const Body body = standard_body();
  Sensors sensors(museum, body, no_noise, Random(1));
  Random random(5);
  for (int round = 0; round < 4; ++round) {
    const auto people = some_people(random);
    const Pose pose{random.uniform(1.0, 2.5), random.uniform(3.0, 8.0), random.uniform(-pi, pi)};
    for (const auto id : {LaserId::front, LaserId::rear}) {
      const LaserScan scan = sensors.scan(id, walls, people, pose, {});
      const auto& mount = body.lasers[static_cast<std::size_t>(id)];
      const Pose from = pose * mount.base_from_laser;
      ASSERT_EQ(scan.ranges.size(), 181u);
      int off = 0;
      for (int i = 0; i < mount.beams; i += 6) {
        const double expected = brute_force(museum.map, people, from.position(),
                                            from.theta + mount.angle_min + i * mount.angle_step, mount.max_range);
        off += std::abs(scan.ranges[static_cast<std::size_t>(i)] - expected) > 3e-3;
      }
      EXPECT_LE(off, 1);  // a beam may graze a leg or a corner between two steps of the comparison
    }
  }
}

TEST(Sensors, BeamsBeyondTheRangeComeBackAsNothing) {
  const Museum museum = testing::hall(40.0, 4.0);
  Body body = standard_body();
  body.lasers[0].max_range = 8.0;
  Sensors sensors(museum, body, {}, Random(1));
  const LaserScan scan = sensors.scan(LaserId::front, Walls(museum.map), {}, {5.0, 2.0, 0.0}, {});
  EXPECT_TRUE(std::isnan(scan.ranges[90]));
  EXPECT_FALSE(std::isnan(scan.ranges[0]));
}

TEST(Sensors, NoiseHasTheStatedSpread) {
  const Museum museum = testing::hall(8.0, 8.0);
  const Walls walls(museum.map);
  SensorNoise noise;
  noise.laser_bias = noise.laser_turn = 0.0;
  Sensors sensors(museum, standard_body(), noise, Random(3));
  double sum = 0.0, squares = 0.0;
  int count = 0, lost = 0;
  for (int i = 0; i < 4000; ++i) {
    const float range = sensors.scan(LaserId::front, walls, {}, {4.0, 4.0, 0.0}, {}).ranges[90];
    if (std::isnan(range)) {
      ++lost;
      continue;
    }
    sum += range, squares += range * range, ++count;
  }
  const double mean = sum / count;
  EXPECT_NEAR(mean, 7.9 - 4.22, 0.002);
  EXPECT_NEAR(std::sqrt(squares / count - mean * mean), 0.01, 0.002);
  EXPECT_GT(lost, 0);
  EXPECT_LT(lost, 30);
}

TEST(Sensors, SonarHearsGlassThatTheLaserLooksThrough) {
  Museum museum = testing::hall(10.0, 10.0);
  museum.hazards = {{"case", HazardKind::glass, testing::box(6.0, 4.0, 7.0, 6.0), {}},
                    {"plate", HazardKind::low_obstacle, testing::box(3.0, 4.0, 4.0, 6.0), {}}};
  const Walls walls(museum.map);
  const Body body = standard_body();
  Sensors sensors(museum, body, no_noise, Random(1));
  const Pose pose{5.0, 5.0, 0.0};
  const LaserScan scan = sensors.scan(LaserId::front, walls, {}, pose, {});
  EXPECT_NEAR(scan.ranges[90], 9.9 - 5.22, 1e-3);
  const SonarScan first_group = sensors.sonars(walls, {}, pose, {});
  ASSERT_EQ(first_group.readings.size(), 3u);  // 0, 8, 16
  EXPECT_NEAR(first_group.readings[0].range, 1.0 - 0.27, 1e-3);
  for (int i = 0; i < 3; ++i) sensors.sonars(walls, {}, pose, {});
  const SonarScan fifth_group = sensors.sonars(walls, {}, pose, {});  // 4, 12 (to the rear), 20
  EXPECT_EQ(fifth_group.readings[1].sonar, 12);
  EXPECT_TRUE(std::isnan(fifth_group.readings[1].range));  // over the plate, the wall is beyond 4 m
}

TEST(Sensors, SonarHearsAPersonInItsCone) {
  const Museum museum = testing::hall(10.0, 10.0);
  std::vector<Person> people(1);
  people[0].position = {6.5, 5.1};
  Sensors sensors(museum, standard_body(), no_noise, Random(1));
  const SonarScan heard = sensors.sonars(Walls(museum.map), people, {5.0, 5.0, 0.0}, {});
  EXPECT_NEAR(heard.readings[0].range, std::hypot(1.5 - 0.27, 0.1) - 0.22, 1e-3);
}

}  // namespace
}  // namespace robot::simulation
