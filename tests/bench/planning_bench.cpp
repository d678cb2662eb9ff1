// What planning costs over a museum of 67 x 53 m at 5 cm: the paper's value iteration beside the bucket queue, from
// cold and after a doorway was blocked.
#include <benchmark/benchmark.h>

#include <limits>
#include <vector>

#include "robot/mapping/obstacle_layers.hpp"
#include "robot/planning/planner.hpp"

namespace robot {
namespace {

// Six by five rooms with a door in every wall.
Museum rooms(int width, int height) {
  Museum museum;
  museum.map = OccupancyGrid(width, height, 0.05, {}, free_cell);
  const int room_x = width / 6, room_y = height / 5;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool door_y = y % room_y > room_y / 2 - 15 && y % room_y < room_y / 2 + 15;
      const bool door_x = x % room_x > room_x / 2 - 15 && x % room_x < room_x / 2 + 15;
      const bool wall = (x % room_x < 3 && !door_y) || (y % room_y < 3 && !door_x);
      const bool border = x < 2 || y < 2 || x >= width - 2 || y >= height - 2;
      if (wall || border) museum.map[{x, y}] = occupied_cell;
    }
  }
  return museum;
}

const Museum& big_museum() {
  static const Museum museum = rooms(1340, 1060);
  return museum;
}

constexpr Cell goal{100, 100};

// The paper's loop (RHINO 4.2, steps 1 and 2) over the whole grid, swept up and down until nothing changes.
void value_iteration_textbook(benchmark::State& state) {
  const CostGrid costs = CostMap(big_museum(), standard_body().footprint).costs();
  constexpr std::uint32_t infinite = std::numeric_limits<std::uint32_t>::max();
  int sweeps = 0;
  for (auto _ : state) {
    std::vector<std::uint32_t> values(costs.size(), infinite);
    values[costs.index(goal)] = 0;
    sweeps = 0;
    for (bool changed = true; changed; ++sweeps) {
      changed = false;
      for (std::size_t k = 0; k < values.size(); ++k) {
        const std::size_t i = sweeps % 2 ? values.size() - 1 - k : k;
        const Cell c = costs.cell_at(i);
        if (costs.cells()[i] == 0) continue;
        for (int d = 0; d < 9; ++d) {
          const Cell n{c.x + d % 3 - 1, c.y + d / 3 - 1};
          if (!costs.contains(n) || values[costs.index(n)] == infinite) continue;
          const std::uint32_t step = n.x != c.x && n.y != c.y ? 7 : 5;
          const std::uint32_t value = values[costs.index(n)] + step * costs.cells()[i];
          if (value >= values[i]) continue;
          values[i] = value;
          changed = true;
        }
      }
    }
    benchmark::DoNotOptimize(values.data());
  }
  state.counters["sweeps"] = sweeps;
}
BENCHMARK(value_iteration_textbook)->Unit(benchmark::kMillisecond)->Iterations(1);

void value_function_cold(benchmark::State& state) {
  ValueFunction values(CostMap(big_museum(), standard_body().footprint).costs());
  for (auto _ : state) {
    values.set_goal(goal);
    values.finish();
  }
}
BENCHMARK(value_function_cold)->Unit(benchmark::kMillisecond);

// A person of 0.5 m stands in a door between the goal and half of the museum, then leaves.
void value_function_repair(benchmark::State& state) {
  const CostGrid costs = CostMap(big_museum(), standard_body().footprint).costs();
  ValueFunction values(costs);
  values.set_goal(goal);
  values.finish();
  std::vector<CostChange> shut, open;
  for (int y = -10; y <= 10; ++y) {
    for (int x = -10; x <= 10; ++x) {
      const Cell c{1340 / 6 + x, 1060 / 10 + y};
      if (x * x + y * y > 100 || costs[c] == 0) continue;
      shut.push_back({c, static_cast<std::uint8_t>(state.range(0))});
      open.push_back({c, costs[c]});
    }
  }
  for (auto _ : state) {
    values.change(shut);
    values.finish();
    values.change(open);
    values.finish();
  }
}
BENCHMARK(value_function_repair)->ArgName("cost")->Arg(0)->Arg(60)->Unit(benchmark::kMillisecond);

void planner_set_up(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(Planner(big_museum(), standard_body().footprint));
}
BENCHMARK(planner_set_up)->Unit(benchmark::kMillisecond);

void path_of_60_metres(benchmark::State& state) {
  Planner planner(big_museum(), standard_body().footprint);
  planner.set_goal({5, 5});
  while (!planner.work(1 << 20)) {
  }
  for (auto _ : state) benchmark::DoNotOptimize(planner.path_from({60, 48}));
}
BENCHMARK(path_of_60_metres)->Unit(benchmark::kMicrosecond);

void travel_between_24_exhibits(benchmark::State& state) {
  const Planner planner(big_museum(), standard_body().footprint);
  std::vector<Point> points;
  for (int i = 0; i < 24; ++i) points.push_back({4.0 + 10.0 * (i % 6), 5.0 + 11.0 * (i / 6)});
  for (auto _ : state) benchmark::DoNotOptimize(planner.travel_distances(points));
}
BENCHMARK(travel_between_24_exhibits)->Unit(benchmark::kMillisecond);

// A scan in which a third of the beams meet people, among what earlier scans left.
void obstacle_layers_scan(benchmark::State& state) {
  ObstacleLayers layers(big_museum().map);
  ScanView scan;
  scan.angle_min = -pi / 2;
  scan.angle_step = pi / 180;
  for (int i = 0; i < 181; ++i) {
    const bool person = i % 9 < 3;
    scan.ranges.push_back(person ? 1.0f + 0.03f * static_cast<float>(i) : 7.0f);
    scan.kinds.push_back(person ? BeamKind::person : BeamKind::map);
  }
  double x = 5.0;
  for (auto _ : state) {
    scan.map_from_laser = {x, 5.0, 0.0};
    x = x > 25.0 ? 5.0 : x + 0.02;
    layers.add(scan);
    benchmark::DoNotOptimize(layers.take_changes());
  }
}
BENCHMARK(obstacle_layers_scan)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace robot
