// The simulated world's costs: one control tick (50 ms of the museum), one laser sweep, one picture. Textbook beside
// fast: beams against every person and a march cell by cell, crowds by all pairs.
#include <benchmark/benchmark.h>

#include <cmath>

#include "protocols/files/site_file.hpp"
#include "robot/geometry/ray_cast.hpp"
#include "robot/simulation/painter.hpp"
#include "robot/simulation/world.hpp"

namespace {

using namespace robot;              // NOLINT: a benchmark
using namespace robot::simulation;  // NOLINT

const Museum& material_hall() {
  static const Museum museum = files::load_site("static/sites/material-hall");
  return museum;
}

void simulation_tick(benchmark::State& state) {
  WorldConfig config;
  config.visitors = static_cast<int>(state.range(0));
  World world(material_hall(), standard_body(), config, 1);
  world.advance(from_seconds(60.0));
  for (auto _ : state) benchmark::DoNotOptimize(world.advance(world.now() + Seconds(0.05)));
}
BENCHMARK(simulation_tick)->Arg(100)->Arg(300)->Unit(benchmark::kMicrosecond);

void simulation_crowd_step(benchmark::State& state) {
  Crowd crowd(material_hall(), static_cast<int>(state.range(0)), Random(1));
  const RobotSeen robot{material_hall().home, {}, {}};
  for (int i = 0; i < 1000; ++i) crowd.step(0.025, robot);
  for (auto _ : state) crowd.step(0.025, robot);
}
BENCHMARK(simulation_crowd_step)->Arg(100)->Arg(300)->Unit(benchmark::kMicrosecond);

void simulation_laser(benchmark::State& state) {
  World world(material_hall(), standard_body(), {.visitors = 300}, 1);
  world.advance(from_seconds(30.0));
  for (auto _ : state) benchmark::DoNotOptimize(world.scan(LaserId::front));
}
BENCHMARK(simulation_laser)->Unit(benchmark::kMicrosecond);

// Every beam asks every leg and walks every cell.
void simulation_laser_textbook(benchmark::State& state) {
  World world(material_hall(), standard_body(), {.visitors = 300}, 1);
  world.advance(from_seconds(30.0));
  const auto& mount = world.body().lasers[0];
  for (auto _ : state) {
    const Pose from = world.truth() * mount.base_from_laser;
    double sum = 0.0;
    for (int i = 0; i < mount.beams; ++i) {
      const double angle = from.theta + mount.angle_min + i * mount.angle_step;
      double range = cast_ray(world.museum().map, from.position(), angle, mount.max_range);
      const Point way{std::cos(angle), std::sin(angle)};
      for (const auto& person : world.people()) {
        for (const Point leg : legs(person)) {
          const Point to = leg - from.position();
          const double along = dot(to, way), off = cross(to, way);
          const double chord = leg_radius * leg_radius - off * off;
          if (chord > 0.0 && along > 0.0) range = std::min(range, along - std::sqrt(chord));
        }
      }
      sum += range;
    }
    benchmark::DoNotOptimize(sum);
  }
}
BENCHMARK(simulation_laser_textbook)->Unit(benchmark::kMicrosecond);

void simulation_sonars(benchmark::State& state) {
  World world(material_hall(), standard_body(), {.visitors = 300}, 1);
  world.advance(from_seconds(30.0));
  for (auto _ : state) benchmark::DoNotOptimize(world.sonars());
}
BENCHMARK(simulation_sonars)->Unit(benchmark::kMicrosecond);

void simulation_picture(benchmark::State& state) {
  const Painter painter(material_hall());
  World world(material_hall(), standard_body(), {.visitors = 100}, 1);
  world.advance(from_seconds(60.0));
  const Snapshot moment = world.snapshot();
  const CameraView view = state.range(0) == 0 ? onboard_view(moment.robot) : wall_view(material_hall().cameras.front());
  for (auto _ : state) benchmark::DoNotOptimize(painter.render(view, moment));
}
BENCHMARK(simulation_picture)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
