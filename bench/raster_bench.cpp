// Plates as height maps: whole worlds with Viitanen's defaults, and a step of one.
#include <benchmark/benchmark.h>

#include "geo/kernels/plates/raster/raster_tectonics.hpp"

namespace geo {
namespace {

/// A square map on which plates drift the same share of its side, whatever its cells.
RasterSettings settings_for(std::int64_t side) {
  RasterSettings settings;
  settings.world = {static_cast<int>(side), static_cast<int>(side)};
  const double finer = static_cast<double>(side) / 512.0;
  settings.speed *= finer;
  settings.arc_cells *= finer;
  settings.arc_scatter_cells *= finer;
  settings.overlap_cells *= finer * finer;
  return settings;
}

/// Two cycles of ten plates.
void RasterWorldOfTenPlates(benchmark::State& state) {
  std::int64_t steps = 0;
  for (auto _ : state) {
    RasterTectonics model(settings_for(state.range(0)), 1);
    while (model.advance()) {
    }
    steps = model.steps();
    benchmark::DoNotOptimize(model.map().crust.data());
  }
  state.counters["steps"] = static_cast<double>(steps);
}

/// A step after a hundred.
void RasterStep(benchmark::State& state) {
  RasterTectonics model(settings_for(state.range(0)), 1);
  for (int k = 0; k < 100; ++k) model.advance();
  for (auto _ : state) model.advance();
  state.counters["cells/s"] =
      benchmark::Counter(static_cast<double>(state.range(0) * state.range(0)),
                         benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK(RasterWorldOfTenPlates)
    ->Arg(256)
    ->Arg(512)
    ->Arg(1024)
    ->Unit(benchmark::kSecond)
    ->Iterations(1)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(RasterStep)
    ->Arg(512)
    ->Arg(1024)
    ->Arg(2048)
    ->Arg(4096)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(50)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace geo
