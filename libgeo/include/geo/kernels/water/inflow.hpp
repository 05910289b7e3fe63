#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/kernels/remapping/planet_cells.hpp"

namespace geo {

/// The water of a planet: where each of its cells drains, and how much.
struct PlanetWater {
  std::span<const float> elevation_m;
  std::span<const Index> receiver;
  std::span<const double> drainage_area_m2;
  std::span<const float> discharge_m3_s;
  std::span<const std::int32_t> lake_id;  ///< may be empty
};

/// Throws Bug unless all of it has one value for each cell of the planet (core/array_sizes.hpp).
void check_sizes(std::string_view kernel, const Grid& planet, const PlanetWater& water);

/// Where a river of the planet crosses the edge of a part of it.
struct RiverCrossing {
  Index planet_cell = kNoCell;  ///< the last on this side of the edge, whichever that is
  Index edge_cell = kNoCell;    ///< of the fine grid
};

/// Where water of a planet crosses the edge of a part of it.
struct Crossings {
  std::vector<RiverCrossing> rivers;  ///< in and out; straight out to sea, the sea there
  /// Where what falls on the part of a cell beyond the edge comes in without a river.
  std::vector<RiverCrossing> brooks;
};

/// Water that enters a part of a planet from outside, for a fine plane in an equal-area projection.
///
/// A planet cell counts as inside if its centre lies on the plane, or less than half a cell beyond
/// the edge while its water goes in from there. Wherever the planet's water passes from outside to
/// inside or back, largest first, it crosses at the lowest land cell that no other has taken within
/// half a planet cell of where the line between the two cell centres crosses the edge, and that
/// cell sinks to the planet's level, interpolated between the two, so that the coarse surface dams
/// no river at the edge. What gathered outside (drainage area and discharge) enters there. What
/// falls on as much of an inside cell as lies beyond the edge comes in with the largest of its
/// rivers from outside, or else as a brook, at the lowest of its edge cells whose ground falls
/// inward and is not below the planet's, from which it can get to the river of that cell. So rivers
/// keep their area and discharge, and no ground counts twice. No edge cell that water comes
/// in over is to be an outlet; where water leaves, none enters. On a lake, whose cells all carry
/// the discharge of the whole, a cell passes on the rivers that have come in above it, less the
/// lake's loss.
/// Outputs: one value per fine cell, 0 elsewhere; `elevation_m` of the fine cells: in and out.
/// Throws Bug where `water` does not have a value for each cell of the planet.
Crossings find_inflow(const PlanetCells& cells, const PlanetWater& water,
                      std::span<float> elevation_m, std::span<double> inflow_area_m2,
                      std::span<float> inflow_m3_s);

}  // namespace geo
