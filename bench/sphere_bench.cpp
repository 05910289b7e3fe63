// Plates on a sphere: the rows of Table 2 of Cortial et al. (2019), for as many samples.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <vector>

#include "geo/kernels/plates/sphere/sphere_start.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"

namespace geo {
namespace {

/// A planet of 40 plates and 30 % land that has drifted for a while.
struct Planet {
  explicit Planet(std::int32_t n) : samples(n), mesh(samples) {
    SphereSettings settings;
    settings.rift_per_myr = 0.0;
    model =
        std::make_unique<SphereTectonics>(mesh, settings, start_sphere(mesh, {}, settings, 1), 1);
    for (int k = 0; k < 16; ++k) advance(*model);
  }
  FibonacciSphere samples;
  SphereMesh mesh;
  std::unique_ptr<SphereTectonics> model;
};

Planet& planet(std::int64_t n) {
  static std::int64_t size = 0;
  static std::unique_ptr<Planet> one;
  if (size != n) {
    one.reset();
    one = std::make_unique<Planet>(static_cast<std::int32_t>(n));
    size = n;
  }
  return *one;
}

void report(benchmark::State& state) {
  state.counters["samples/s"] = benchmark::Counter(static_cast<double>(state.range(0)),
                                                   benchmark::Counter::kIsIterationInvariantRate);
}

/// Lattice and triangulation.
void SphereMeshing(benchmark::State& state) {
  for (auto _ : state) {
    const FibonacciSphere samples(static_cast<std::int32_t>(state.range(0)));
    benchmark::DoNotOptimize(SphereMesh(samples).neighbours(0).data());
  }
  report(state);
}

/// Subduction, continental collision and elevation: a step of 2 Myr.
void SphereStep(benchmark::State& state) {
  const SphereTectonics& from = *planet(state.range(0)).model;
  for (auto _ : state) {
    state.PauseTiming();
    auto model = std::make_unique<SphereTectonics>(from);
    state.ResumeTiming();
    advance(*model);
    benchmark::DoNotOptimize(model->state.crust.elevation_m.data());
    state.PauseTiming();
    model.reset();
    state.ResumeTiming();
  }
  report(state);
}

/// Oceanic crust: all crust resampled, gaps filled.
void SphereResampling(benchmark::State& state) {
  const SphereTectonics& from = *planet(state.range(0)).model;
  for (auto _ : state) {
    state.PauseTiming();
    auto model = std::make_unique<SphereTectonics>(from);
    state.ResumeTiming();
    resample(*model);
    benchmark::DoNotOptimize(model->state.crust.elevation_m.data());
    state.PauseTiming();
    model.reset();
    state.ResumeTiming();
  }
  report(state);
}

/// Plate rifting into three.
void SphereRifting(benchmark::State& state) {
  const SphereTectonics& from = *planet(state.range(0)).model;
  const std::vector<Vector3> places{normalised({1.0, 0.1, 0.1}), normalised({0.9, -0.3, 0.1}),
                                    normalised({0.9, 0.1, -0.3})};
  for (auto _ : state) {
    state.PauseTiming();
    auto model = std::make_unique<SphereTectonics>(from);
    const int plate = std::max(0, plate_at(*model, places[0]));
    state.ResumeTiming();
    rift_plate(*model, plate, places, 30.0);
    benchmark::DoNotOptimize(model->state.crust.plate.data());
    state.PauseTiming();
    model.reset();
    state.ResumeTiming();
  }
  report(state);
}

void sizes(benchmark::internal::Benchmark* bench) {
  for (const int n : {60'000, 100'000, 250'000, 500'000, 4'000'000}) bench->Arg(n);
  bench->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}

BENCHMARK(SphereMeshing)->Apply(sizes);
BENCHMARK(SphereStep)->Apply(sizes);
BENCHMARK(SphereResampling)->Apply(sizes);
BENCHMARK(SphereRifting)->Apply(sizes);

}  // namespace
}  // namespace geo
