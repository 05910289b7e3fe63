#pragma once

#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/kernels/landscape/surface_detail.hpp"
#include "geo/kernels/remapping/planet_cells.hpp"
#include "geo/stages/island/island.hpp"

namespace geo {

/// Does `change(column, row, cell)` to each cell of an island, on all threads.
template <class Change>
void on_cells(const Grid& grid, Change&& change) {
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) change(i, j, grid.cell(i, j));
  }
}

/// Length below which no ground is quite even.
inline constexpr double kPlain_m = 10e3;

/// Width over which detail and corrections fade in from the edge, where heights are the planet's: a
/// quarter of a planet cell, as long as that is little of the island.
[[nodiscard]] double seam_m(const PlanetCells& cells);

/// 1 in the planet's cells with nothing but land, or nothing but sea, in and around them; one value
/// per covered cell.
[[nodiscard]] std::vector<float> all_round(const PlanetCells& cells,
                                           std::span<const float> planet_elevation_m, bool land);

/// Octaves of detail from two of the planet's cells down to two of the island's.
[[nodiscard]] DetailLaw detail_law(const PlanetCells& cells, double cell_m);

/// Of what no ground lacks, terraces, levees, old channels and dunes, the octaves from a length of
/// at most 10 km down to two of the island's cells, with a Hurst exponent of a half.
[[nodiscard]] DetailLaw plain_law(const PlanetCells& cells, double cell_m,
                                  double longest_m = kPlain_m);

/// Standard deviation of these octaves; none where detail follows height.
[[nodiscard]] double plain_roughness_m(const IslandParameters& p, const DetailLaw& law);

}  // namespace geo
