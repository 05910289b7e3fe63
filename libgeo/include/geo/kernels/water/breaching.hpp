#pragma once

#include <cstdint>
#include <span>

#include "geo/core/grid.hpp"
#include "geo/kernels/water/flow_graph.hpp"

namespace geo {

/// How deep and how long a cut through a spurious barrier may be.
struct BreachLimits {
  double depth_m = 0.0;
  double length_m = 0.0;    ///< of the part deeper than `shallow_m`
  double shallow_m = 20.0;  ///< noise of the DEM, which makes no spurious depression
};

/// Cuts pits open where a gorge narrower than a cell has been averaged away. From each pit, the
/// highest first, the cheapest way (least section area, depth times length) to a lower cell is
/// sought; if it keeps the limits, the cells along it are lowered to a gentle descent, though never
/// below sea level. No pit appears that was not there. Returns the number of cuts.
/// `toughness`: factor of the cost in each cell, or empty: through even ground the cheapest way
/// would follow the directions of the grid.
/// Method: least-cost breaching (Lindsay & Dhun 2015; Lindsay 2016), with limits on both depth and
/// length. Cost: linear in cells, plus a search of some dozen cells for each pit.
/// Arrays have one value per cell (`check_sizes`); Bug otherwise.
int breach_depressions(const Grid& grid, std::span<const std::uint8_t> outlets,
                       const BreachLimits& limits, std::span<float> elevation_m,
                       std::span<const float> toughness = {});

/// How deep and how long a cut a river may make.
struct GorgeLimits {
  double depth_factor = 1.0;  ///< over the depth of its valley
  double length_m = 0.0;      ///< of the part deeper than `shallow_m`
  double shallow_m = 20.0;    ///< noise of the DEM, which makes no spurious depression
};

/// Cuts depressions open along rivers. `graph` routes every depression over its sill
/// (`route_water`) and `discharge_m3_s` is what then flows. From the foot of each climb on a flow
/// path, the highest first, the path to the next lower cell is lowered to a gentle descent,
/// though never below sea level, if a river of that discharge can have cut a valley as deep
/// (`valley_depth`). So the Nile passes its cataracts, while dry basins keep their rims; what
/// cannot be cut stays whole, a lake or an endorheic basin. No pit appears that was not there.
/// Returns the number of cuts. Method: breaching along flow paths (Martz & Garbrecht 1999), the
/// limit of depth from hydraulic geometry. Cost: linear, plus the length of the cuts.
/// Arrays have one value per cell (`check_sizes`); Bug otherwise.
int grade_rivers(const Grid& grid, const FlowGraph& graph, std::span<const std::uint8_t> outlets,
                 std::span<const double> discharge_m3_s, const GorgeLimits& limits,
                 std::span<float> elevation_m);

}  // namespace geo
