// Oriented noise over a whole grid, for the distance between its crests.
#include <benchmark/benchmark.h>

#include <vector>

#include "geo/kernels/noise/oriented_noise.hpp"

namespace geo {
namespace {

void BM_OrientedNoise(benchmark::State& state) {
  const auto nx = static_cast<int>(state.range(0));
  const auto wavelength_km = static_cast<double>(state.range(1));
  const Grid grid = Grid::sphere(nx, nx / 2), coarse = Grid::sphere(1024, 512);
  const Orientation crests{std::vector<float>(coarse.size(), 1.0F),
                           std::vector<float>(coarse.size(), 0.0F)};
  std::vector<float> values(grid.size());
  for (auto _ : state) {
    add_oriented_noise(grid, coarse, crests,
                       {.wavelength_km = wavelength_km,
                        .width_km = 0.8 * wavelength_km,
                        .length_km = 3.0 * wavelength_km},
                       1.0, 1, "bench", values);
    benchmark::DoNotOptimize(values.data());
  }
  state.counters["cells/s"] = benchmark::Counter(static_cast<double>(grid.size()),
                                                 benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(BM_OrientedNoise)
    ->Args({2048, 90})
    ->Args({2048, 48})
    ->Args({4096, 90})
    ->Args({4096, 48})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace geo
