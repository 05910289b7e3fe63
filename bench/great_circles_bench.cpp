// Great-circle noise over a whole grid, for its steepness and number of circles.
#include <benchmark/benchmark.h>

#include <vector>

#include "geo/kernels/noise/great_circles.hpp"

namespace geo {
namespace {

void BM_GreatCircles(benchmark::State& state) {
  const auto nx = static_cast<int>(state.range(0));
  const Grid grid = Grid::sphere(nx, nx / 2);
  const GreatCircles circles(
      {.circles = state.range(1), .steepness = static_cast<double>(state.range(2))}, 1, "bench");
  std::vector<float> values(grid.size());
  for (auto _ : state) {
    great_circle_noise(grid, circles, values);
    benchmark::DoNotOptimize(values.data());
  }
  state.counters["cells/s"] = benchmark::Counter(static_cast<double>(grid.size()),
                                                 benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(BM_GreatCircles)
    ->Args({1024, 1000, 300})
    ->Args({2048, 1000, 300})
    ->Args({4096, 1000, 300})
    ->Args({2048, 1000, 50})
    ->Args({2048, 100, 300})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace geo
