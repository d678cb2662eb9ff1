// What localization costs, the textbook's way beside ours. On the museum of the peer workload when the recorded data is
// there (DOCENT_DATA, default ../shared/data), else on a hall of the same size drawn here.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>

#include "protocols/files/map_server_file.hpp"
#include "robot/localization/localizer.hpp"
#include "tests/support/simulated_scan.hpp"

namespace robot {
namespace {

OccupancyGrid drawn_hall() {
  OccupancyGrid map(1340, 1060, 0.05, {}, free_cell);
  Random random(1);
  const auto box = [&](int x, int y, int w, int h) {
    for (int v = y; v < std::min(y + h, map.height()); ++v) {
      for (int u = x; u < std::min(x + w, map.width()); ++u) map[{u, v}] = occupied_cell;
    }
  };
  box(0, 0, 1340, 4);
  box(0, 1056, 1340, 4);
  box(0, 0, 4, 1060);
  box(1336, 0, 4, 1060);
  for (int k = 0; k < 60; ++k) {
    box(static_cast<int>(random.index(1300)), static_cast<int>(random.index(1020)),
        8 + static_cast<int>(random.index(60)), 8 + static_cast<int>(random.index(60)));
  }
  box(620, 360, 80, 80);
  for (int v = 370; v < 430; ++v) {
    for (int u = 630; u < 690; ++u) map[{u, v}] = free_cell;
  }
  return map;
}

const OccupancyGrid& museum() {
  static const OccupancyGrid map = [] {
    const char* root = std::getenv("DOCENT_DATA");
    const auto file = std::filesystem::path(root ? root : "../shared/data") / "peer-workload" / "museum_hollow.pgm.gz";
    return std::filesystem::exists(file) ? files::read_pgm_map(file, 0.05, {}) : drawn_hall();
  }();
  return map;
}

const RayCaster& caster() {
  static const RayCaster instance(museum());
  return instance;
}

const LikelihoodField& field() {
  static const LikelihoodField instance(museum(), {}, 0.025);
  return instance;
}

constexpr Pose truth{33.0, 20.0, 0.7};

LaserScan museum_scan(int beams) {
  Random random(2);
  return testing::take_scan(caster(), truth, {-pi / 2, pi / (beams - 1), beams, 20.0f, 0.02, LaserId::front}, random);
}

std::vector<Point> ends(int beams) {
  std::vector<Point> result;
  for (const Beam& beam : beams_of(museum_scan(beams), {}).beams) result.push_back(beam.end);
  return result;
}

struct Poses {
  std::vector<double> x, y, theta;
};

// near: as while tracking; otherwise anywhere in the free space.
Poses poses(int count, bool near) {
  Random random(3);
  Poses result;
  while (static_cast<int>(result.x.size()) < count) {
    const Point p = near ? Point{truth.x + random.normal(0.2), truth.y + random.normal(0.2)}
                         : Point{random.uniform(0.0, 67.0), random.uniform(0.0, 53.0)};
    const Cell cell = museum().cell(p);
    if (!near && (!museum().contains(cell) || !is_free(museum()[cell]))) continue;
    result.x.push_back(p.x);
    result.y.push_back(p.y);
    result.theta.push_back(near ? truth.theta + random.normal(0.09) : random.uniform(-pi, pi));
  }
  return result;
}

// ---- Distance field -------------------------------------------------------------------------------------------

void distance_field_museum(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(distance_field(museum()));
}
BENCHMARK(distance_field_museum)->Unit(benchmark::kMillisecond);

// ---- Rays: arguments: 1 near, 0 anywhere -----------------------------------------------------------------------

template <typename Cast>
void rays(benchmark::State& state, Cast cast) {
  const Poses from = poses(2000, state.range(0) == 1);
  std::size_t i = 0;
  for (auto _ : state) {
    i = (i + 1) % from.x.size();
    for (int k = 0; k < 60; ++k) {
      benchmark::DoNotOptimize(cast(Point{from.x[i], from.y[i]}, from.theta[i] - pi / 2 + k * pi / 59));
    }
  }
  state.SetItemsProcessed(state.iterations() * 60);
}
void rays_textbook(benchmark::State& state) {
  rays(state, [](Point from, double angle) { return cast_ray(museum(), from, angle, 20.0); });
}
void rays_march(benchmark::State& state) {
  rays(state, [](Point from, double angle) { return caster().cast(from, angle, 20.0); });
}
BENCHMARK(rays_textbook)->Arg(1)->Arg(0);
BENCHMARK(rays_march)->Arg(1)->Arg(0);

// ---- Weights of poses x 60 beams: arguments: poses, 1 near or 0 anywhere ------------------------------------------

void likelihood_textbook(benchmark::State& state) {
  const Poses at = poses(static_cast<int>(state.range(0)), state.range(1) == 1);
  const auto scan = ends(60);
  std::vector<double> fit(at.x.size());
  for (auto _ : state) {
    for (std::size_t i = 0; i < fit.size(); ++i) fit[i] = field().log_likelihood({at.x[i], at.y[i], at.theta[i]}, scan);
    benchmark::DoNotOptimize(fit.data());
  }
}
void likelihood_weigh(benchmark::State& state) {
  const Poses at = poses(static_cast<int>(state.range(0)), state.range(1) == 1);
  const auto scan = ends(60);
  std::vector<float> fit(at.x.size());
  for (auto _ : state) {
    field().weigh(at.x, at.y, at.theta, scan, fit);
    benchmark::DoNotOptimize(fit.data());
  }
}
void likelihood_sizes(benchmark::internal::Benchmark* bench) {
  bench->Args({2000, 1})->Args({20000, 1})->Args({20000, 0})->Unit(benchmark::kMillisecond);
}
BENCHMARK(likelihood_textbook)->Apply(likelihood_sizes);
BENCHMARK(likelihood_weigh)->Apply(likelihood_sizes);

// ---- The whole filter ----------------------------------------------------------------------------------------------

// Motion, weights, resampling and clusters of this many samples.
void filter_step(benchmark::State& state) {
  const int count = static_cast<int>(state.range(0));
  MonteCarlo filter({.min_particles = count, .max_particles = count}, Random(1));
  const Seed seed{truth, 0.05, 0.02, 1.0};
  filter.start({&seed, 1});
  const auto scan = ends(60);
  std::vector<float> fit(static_cast<std::size_t>(count));
  for (auto _ : state) {
    filter.predict({}, {});
    const Particles& p = filter.particles();
    field().weigh(p.x, p.y, p.theta, scan, fit);
    filter.weigh(fit);
    benchmark::DoNotOptimize(filter.clusters());
    filter.resample_when_uneven();
  }
}
BENCHMARK(filter_step)->Arg(500)->Arg(2000)->Arg(20000)->Unit(benchmark::kMillisecond);

// A tracking update as the robot sees it: 180 beams read, filtered, weighed, matched. Argument: 1 when the samples are
// weighed, 0 when the scan only refines the estimate.
void localizer_update(benchmark::State& state) {
  Localizer localizer(museum(), {}, 1);
  Pose odom;
  localizer.move(odom, {});
  localizer.start_at(truth, 0.05, 0.02);
  LaserScan scan = museum_scan(180);
  const double way = state.range(0) == 1 ? 0.11 : 0.0;
  double direction = 1.0;
  for (auto _ : state) {
    odom.x += direction * way;  // to and fro: the scan fits to within the noise that the motion brings
    direction = -direction;
    scan.time += std::chrono::milliseconds(1);
    benchmark::DoNotOptimize(localizer.update(scan, {}, odom));
  }
}
BENCHMARK(localizer_update)->Arg(1)->Arg(0)->Unit(benchmark::kMillisecond);

// ---- The whole map from one look: argument: beams -----------------------------------------------------------------

void global_search(benchmark::State& state) {
  GlobalSearch search(museum(), caster(), field());
  const Look look{{beams_of(museum_scan(static_cast<int>(state.range(0))), {})}};
  for (auto _ : state) {
    search.start(look);
    while (search.step(100)) {
    }
    benchmark::DoNotOptimize(search.peaks().size());
  }
}
BENCHMARK(global_search)->Arg(181)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace robot
