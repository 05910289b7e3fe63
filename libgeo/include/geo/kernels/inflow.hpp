#pragma once

#include <cstdint>
#include <span>

#include "geo/core/grid.hpp"
#include "geo/kernels/fine_relief.hpp"

namespace geo {

/// The water of a planet: where each of its cells drains, and how much.
struct PlanetWater {
  std::span<const Index> receiver;
  std::span<const double> drainage_area_m2;
  std::span<const float> discharge_m3_s;
  std::span<const std::int32_t> lake_id;  ///< may be empty
};

/// Water that enters a part of a planet from outside, for a fine plane in an equal-area projection.
///
/// Wherever a planet cell outside drains to one inside, what gathered upstream of it (drainage area
/// and discharge) enters at the lowest land cell of the edge within half a planet cell of the
/// crossing; what falls on the cell itself enters evenly along that stretch. So rivers keep their
/// area and discharge, and no edge cell that the planet's water comes in over is an outlet. Where a
/// larger planet river leaves at a cell, nothing enters there. On a lake, whose cells all carry the
/// discharge of the whole, discharge goes by the share of the drainage area.
/// Outputs: one value per fine cell, 0 elsewhere. `elevation_m`: of the fine cells.
void find_inflow(const PlanetCells& cells, const PlanetWater& water,
                 std::span<const float> elevation_m, std::span<double> inflow_area_m2,
                 std::span<float> inflow_m3_s);

}  // namespace geo
