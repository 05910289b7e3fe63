#include "bandwidth.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "geo/kernels/water/flow_graph.hpp"
#include "geo/kernels/water/multiple_flow.hpp"
#include "terrain.hpp"

namespace geo::bench {
namespace {

const Routing& routing() {
  static const Routing kRouting =
      route_water(sphere(), terrain(sphere()), find_outlets(sphere(), terrain(sphere())), true);
  return kRouting;
}

void accumulate(benchmark::State& state, const FlowPartition& partition) {
  set_threads(state);
  const Grid& grid = sphere();
  const Routing& routed = routing();
  std::vector<double> area(grid.size());
  for (auto _ : state) {
    for (Index c = 0; c < grid.size(); ++c) area[c] = grid.area_m2(grid.row(c));
    accumulate_flow(grid, routed.filled_m, routed.graph.receiver, partition, area);
  }
  // Surface, receiver, and the accumulated value in and out; two marks.
  report(state, grid, sizeof(float) + sizeof(Index) + 2.0 * sizeof(double) + 2.0);
}

void MultipleFlowFreeman(benchmark::State& state) {
  accumulate(state, {FlowMethod::multiple, 1.1});
}
void MultipleFlowQuinn(benchmark::State& state) {
  accumulate(state, {FlowMethod::multiple, 1.0, true});
}
void MultipleFlowDInfinity(benchmark::State& state) { accumulate(state, {FlowMethod::d_infinity}); }

BENCHMARK(MultipleFlowFreeman)->Apply(one_and_two_threads);
BENCHMARK(MultipleFlowQuinn)->Apply(one_and_two_threads);
BENCHMARK(MultipleFlowDInfinity)->Apply(one_and_two_threads);

}  // namespace
}  // namespace geo::bench
