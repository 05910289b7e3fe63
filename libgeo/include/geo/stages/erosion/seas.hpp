#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/stages/erosion/erosion.hpp"

namespace geo {

/// Cuts the straits that erosion.strait_* allow. Returns whether there were any. None on parts of
/// a planet, whose seas may meet beyond the edge.
bool join_seas(const ErosionParameters& parameters, const Grid& grid, std::span<float> elevation_m);

/// Cells of the seas that land cuts off from the ocean, one byte per cell; empty where there are
/// none, on parts of a planet, and where seas stay as they are (erosion.strait_sill_m = 0).
[[nodiscard]] std::vector<std::uint8_t> landlocked_cells(const ErosionParameters& parameters,
                                                         const Grid& grid,
                                                         std::span<const float> elevation_m);

}  // namespace geo
