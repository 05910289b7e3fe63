#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/kernels/water/flow_graph.hpp"
#include "geo/stages/erosion/erosion.hpp"

namespace geo {

/// What falls on a planet and what the air would take, one value per cell.
struct LandClimate {
  std::vector<float> precipitation_mm_yr, potential_mm_yr;
  std::vector<float> sea_level_temperature_c;  ///< annual mean, brought down to the sea
  std::vector<float> range_k;                  ///< warmest less coldest month
};

/// The drainage of a surface: receivers, their order, the area that drains through each
/// cell, and what lies under the water of depressions.
struct Drainage {
  FlowGraph graph;
  /// Drained by each cell; where rain is known, the area that would yield its discharge at the
  /// reference runoff.
  std::vector<double> area_m2;
  std::vector<std::uint8_t> flooded;  ///< lakes that catch sediment; empty where none do
};

/// Routes the water of a surface as erosion.flow_routing says, over the sills of all depressions.
/// With a climate each cell sheds its runoff (land_water), not less than `least_runoff_mm_yr`; what
/// lakes lose to the air (balance_lakes) is gone beyond their sills, in closed basins all of it: no
/// river cuts them open. `inflow_area_m2`: what enters a part of a planet drains so much, one value
/// per cell or none. `drainage` is replaced; what it held is released first: two would not fit
/// the memory budget.
void drain(const ErosionParameters& parameters, const Grid& grid,
           std::span<const float> elevation_m, std::span<const std::uint8_t> outlets,
           Drainage& drainage, const LandClimate* climate = nullptr,
           std::span<const double> inflow_area_m2 = {});

}  // namespace geo
