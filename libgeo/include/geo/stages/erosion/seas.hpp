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

/// Share of the area below 0.
[[nodiscard]] double share_of_sea(const Grid& grid, std::span<const float> elevation_m);

/// Where the sea stands, m, once straits, filled seas and deltas have changed how much it covers:
/// at the level below which `share` of the area lies. 0 on parts of a planet, and where nothing of
/// that happens.
[[nodiscard]] float moved_sea_level_m(const ErosionParameters& parameters, const Grid& grid,
                                      std::span<const float> elevation_m, double share);

/// Moves the datum there. Of flats that lie just at the new level, as mouths have laid them, as
/// many cells as `share` still lacks become sea, from their shores on; waves plane off 5 m of what
/// a rising sea drowns [cattaneo2003]. Returns whether anything changed.
bool keep_sea_share(const ErosionParameters& parameters, const Grid& grid,
                    std::span<float> elevation_m, double share);

/// Both in turn, until the sea covers `share` and no strait has fallen dry; straits come last.
/// Returns whether anything changed.
bool settle_seas(const ErosionParameters& parameters, const Grid& grid,
                 std::span<float> elevation_m, double share);

}  // namespace geo
