// What a control tick of motion costs, the textbook beside the fast way.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "robot/geometry/random.hpp"
#include "robot/motion/dynamic_window.hpp"
#include "robot/motion/safety_gate.hpp"
#include "robot/motion/virtual_sensors.hpp"

namespace robot {
namespace {

// A crowded place: two full scans of 181 beams at 0.6 to 6 m.
std::vector<Point> crowd_points(int count) {
  Random random(7);
  std::vector<Point> points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * pi * i / count, range = random.uniform(0.7, 6.0);
    points.push_back({range * std::cos(angle), range * std::sin(angle)});
  }
  return points;
}

std::vector<Twist> velocity_space() {
  std::vector<Twist> twists;
  for (int i = 0; i < 31; ++i) {
    for (int k = 0; k < 61; ++k) twists.push_back({0.7 * i / 30, -1.0 + 2.0 * k / 60});
  }
  return twists;
}

// The whole velocity space against 540 points, one point and pair at a time with trigonometry.
void contact_textbook(benchmark::State& state) {
  const auto points = crowd_points(540);
  const auto twists = velocity_space();
  for (auto _ : state) {
    double sum = 0.0;
    for (const Twist& twist : twists) {
      double least = 1e9;
      for (const Point& p : points) least = std::min(least, time_to_contact_plain({}, p, twist));
      sum += least;
    }
    benchmark::DoNotOptimize(sum);
  }
}
BENCHMARK(contact_textbook)->Unit(benchmark::kMillisecond);

void contact_columns(benchmark::State& state) {
  PointColumns columns;
  for (const Point& p : crowd_points(540)) columns.push_back(p);
  const auto twists = velocity_space();
  for (auto _ : state) {
    double sum = 0.0;
    for (const Twist& twist : twists) sum += std::min(1e9, time_to_contact({}, columns, twist));
    benchmark::DoNotOptimize(sum);
  }
}
BENCHMARK(contact_columns)->Unit(benchmark::kMillisecond);

void dynamic_window_tick(benchmark::State& state) {
  DynamicWindow window(standard_body());
  std::vector<Obstacle> obstacles;
  for (const Point& p : crowd_points(362)) obstacles.push_back({p, {}});
  for (std::size_t i = 0; i < obstacles.size(); i += 9) obstacles[i].velocity = {-0.5, 0.3};
  MotionTask task{{{0, 0}, {2, 0.3}, {5, 0}}, {5, 0, 0}, false, 0.7};
  double seconds = 0.0;
  for (auto _ : state) {
    seconds += 0.05;
    benchmark::DoNotOptimize(window.choose(task, {}, {0.4, 0.1}, obstacles, {}, from_seconds(seconds)));
  }
}
BENCHMARK(dynamic_window_tick)->Unit(benchmark::kMicrosecond);

void safety_gate_tick(benchmark::State& state) {
  const Body body = standard_body();
  SafetyGate gate(body, false);
  double seconds = 1.0;
  LaserScan scan{from_seconds(seconds), LaserId::front, -pi / 2, pi / 180, 32.0f, {}};
  for (const Point& p : crowd_points(181)) scan.ranges.push_back(static_cast<float>(norm(p)));
  BaseState base;
  base.motors_enabled = true;
  for (auto _ : state) {
    seconds += 0.05;
    const Time now = from_seconds(seconds);
    gate.add(Odometry{now, {}, {0.4, 0.1}}, now);
    gate.add(base, now);
    for (const LaserId id : {LaserId::front, LaserId::rear}) {
      scan.laser = id;
      scan.time = now;
      gate.add(scan, now);
    }
    benchmark::DoNotOptimize(gate.limit({0.5, 0.1}, now));
  }
}
BENCHMARK(safety_gate_tick)->Unit(benchmark::kMicrosecond);

void virtual_readings(benchmark::State& state) {
  Museum museum;
  museum.map = OccupancyGrid(400, 400, 0.05, {}, free_cell);
  museum.hazards.push_back({"stairs", HazardKind::staircase, {{8, 8}, {12, 8}, {12, 12}, {8, 12}}, {}});
  museum.boundary = {{1, 1}, {19, 1}, {19, 19}, {1, 19}};
  const VirtualSensors sensors(museum);
  Random random(3);
  std::vector<Pose> samples;
  for (int i = 0; i < 200; ++i) {
    samples.push_back({6.5 + random.normal(0.05), 9.0 + random.normal(0.05), 0.3 + random.normal(0.02)});
  }
  for (auto _ : state) benchmark::DoNotOptimize(sensors.read(samples));
}
BENCHMARK(virtual_readings)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace robot
