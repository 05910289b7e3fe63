#include "geo/stages/erosion/drainage.hpp"

#include <algorithm>
#include <utility>

#include "geo/kernels/landscape/river_sediment.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "geo/kernels/water/multiple_flow.hpp"

namespace geo {

void drain(const ErosionParameters& p, const Grid& grid, std::span<const float> elevation_m,
           std::span<const std::uint8_t> outlets, Drainage& drainage) {
  const bool spread = p.flow_routing == "mfd";
  FlowGraph& graph = drainage.graph;
  graph = {};
  Routing routing = route_unordered(grid, elevation_m, outlets, spread);
  graph = std::move(routing.graph);
  std::vector<double>& area_m2 = drainage.area_m2;
  area_m2.resize(grid.size());
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    std::fill_n(area_m2.begin() + grid.cell(0, j), grid.nx(), grid.area_m2(j));
  }
  const auto put_in_order = [&] { graph.order = downstream_order(graph.receiver); };
  if (spread) {
    accumulate_flow(grid, routing.filled_m, graph.receiver, {FlowMethod::multiple, p.flow_exponent},
                    area_m2, put_in_order);
  } else {
    put_in_order();
    graph.accumulate(area_m2);
  }
  drainage.flooded.clear();
  if (p.deposits() && p.depressions == "fill") {
    drainage.flooded = flooded_cells(graph, elevation_m);
  }
}

}  // namespace geo
