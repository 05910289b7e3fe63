// Routing, filling and incision: what one step of a landscape is made of.
#include <algorithm>

#include "bandwidth.hpp"
#include "geo/kernels/landscape/stream_power.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "geo/kernels/water/flow_graph.hpp"
#include "terrain.hpp"

namespace geo::bench {
namespace {

std::vector<double> cell_areas(const Grid& grid) {
  std::vector<double> area(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) area[cell] = grid.area_m2(grid.row(cell));
  return area;
}

void SteepestDescent(benchmark::State& state) {
  set_threads(state);
  const Grid& grid = sphere();
  const auto& z = terrain(grid);
  const auto outlets = find_outlets(grid, z);
  std::vector<Index> receiver(z.size());
  for (auto _ : state) steepest_receivers(grid, z, outlets, receiver);
  report(state, grid, 4 + 1 + 4);
}
BENCHMARK(SteepestDescent)->Apply(one_and_two_threads);

void FillDepressions(benchmark::State& state) {
  set_threads(state);
  const Grid& grid = sphere();
  const auto& z = terrain(grid);
  const auto outlets = find_outlets(grid, z);
  std::vector<float> filled(z.size());
  for (auto _ : state) fill_depressions(grid, z, outlets, filled);
  report(state, grid, 4 + 1 + 4);
}
BENCHMARK(FillDepressions)->Apply(one_and_two_threads);

void BuildDepressionHierarchy(benchmark::State& state) {
  set_threads(state);
  const Grid& grid = sphere();
  const auto& z = terrain(grid);
  const auto outlets = find_outlets(grid, z);
  std::vector<Index> receiver(z.size());
  for (auto _ : state) {
    steepest_receivers(grid, z, outlets, receiver);
    benchmark::DoNotOptimize(build_depression_hierarchy(grid, z, outlets, receiver));
  }
  report(state, grid, 4 + 1 + 4 + 4);
}
BENCHMARK(BuildDepressionHierarchy)->Apply(one_and_two_threads);

void SteepestDescentAndAccumulation(benchmark::State& state) {  // on a surface without depressions
  set_threads(state);
  const Grid& grid = sphere();
  auto z = terrain(grid);
  const auto outlets = find_outlets(grid, z);
  breach_sills<float>(grid, route_water(grid, z, outlets).graph, z);
  const auto areas = cell_areas(grid);
  for (auto _ : state) {
    FlowGraph graph;
    graph.receiver.resize(z.size());
    steepest_receivers(grid, z, outlets, graph.receiver);
    graph.put_in_order();
    auto area = areas;
    graph.accumulate(area);
    benchmark::DoNotOptimize(area.data());
  }
  report(state, grid, 4 + 1 + 4 + 4 + 8);
}
BENCHMARK(SteepestDescentAndAccumulation)->Apply(one_and_two_threads);

/// Outlets, receivers, depressions, order, accumulation and the implicit solve.
void ErosionStep(benchmark::State& state) {
  set_threads(state);
  const Grid& grid = sphere();
  const auto& start = terrain(grid);
  auto z = start;
  const auto areas = cell_areas(grid);
  auto area = areas;
  const std::vector<float> erodibility{1e-6F};
  for (auto _ : state) {
    state.PauseTiming();
    std::copy(start.begin(), start.end(), z.begin());
    std::copy(areas.begin(), areas.end(), area.begin());
    state.ResumeTiming();
    const auto outlets = find_outlets(grid, z);
    const FlowGraph graph = route_water(grid, z, outlets).graph;
    graph.accumulate(area);
    incise<float, float>(grid, graph, area, erodibility, {.dt_yr = 1e5, .sea_level_m = 0.0}, z);
  }
  report(state, grid, 4 + 4 + 1 + 4 + 4 + 8 + 4);
}
BENCHMARK(ErosionStep)->Apply(one_and_two_threads);

}  // namespace
}  // namespace geo::bench
