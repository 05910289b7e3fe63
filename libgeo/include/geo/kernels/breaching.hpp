#pragma once

#include <cstdint>
#include <span>

#include "geo/core/grid.hpp"
#include "geo/kernels/flow_graph.hpp"

namespace geo {

/// How deep and how long a cut may be.
struct BreachLimits {
  double depth_m = 0.0;       ///< anywhere: the noise of the relief
  double gorge_factor = 0.0;  ///< where a river runs: that many times its valley depth, if more
  double length_m = 0.0;      ///< of the part that runs above the pit
};

/// Cuts depressions open where a valley narrower than a cell has been averaged away. `graph` routes
/// every depression over its sill (`route_water`) and `discharge_m3_s` is what then flows. From
/// the foot of each climb on the way of the water, the highest first, the way to the next lower
/// cell is lowered to a gentle descent, though never below sea level, if it keeps the limits: a dam
/// is false if the river that crosses it is large enough to have cut a valley as deep
/// (`valley_depth`). So the Nile passes, while dry basins keep their rims; what cannot be cut stays
/// whole, a lake or an endorheic basin. No pit appears that was not there. Returns the number of
/// cuts. Method: breaching along flow paths (Martz & Garbrecht 1999; Lindsay 2016), the limit of
/// depth from hydraulic geometry. Cost: linear, plus the length of the cuts.
int breach_dams(const Grid& grid, const FlowGraph& graph, std::span<const std::uint8_t> outlets,
                std::span<const double> discharge_m3_s, const BreachLimits& limits,
                std::span<float> elevation_m);

}  // namespace geo
