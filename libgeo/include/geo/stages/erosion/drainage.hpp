#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/kernels/water/flow_graph.hpp"
#include "geo/stages/erosion/erosion.hpp"

namespace geo {

/// The ways of the water over a relief: receivers, their order, the area that drains through each
/// cell, and what lies under the water of depressions.
struct Drainage {
  FlowGraph graph;
  std::vector<double> area_m2;
  std::vector<std::uint8_t> flooded;  ///< lakes that catch sediment; empty where none do
};

/// Routes the water of a relief as erosion.flow_routing says, over the sills of all depressions.
/// `drainage` is replaced; what it held is released first: two would not fit the memory budget.
void drain(const ErosionParameters& parameters, const Grid& grid,
           std::span<const float> elevation_m, std::span<const std::uint8_t> outlets,
           Drainage& drainage);

}  // namespace geo
