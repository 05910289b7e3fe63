#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "geo/core/grid.hpp"
#include "geo/kernels/remapping/planet_cells.hpp"

namespace geo {

/// Roughness of a planet's surface at the scale of its own cells, m: the root mean square, over the
/// four directions through a cell, of its height above the mean of the two neighbours, and over the
/// cell and its eight neighbours with the weights 4, 2 (sides) and 1 (corners): about a single
/// mount a disc is rough, not a square. Slopes do not count, and heights beyond a shore count as
/// the sea level. `covered` holds one value per covered cell of the planet. `planet_elevation_m`:
/// one value per cell of the planet; `covered`: cells.size(). Bug otherwise.
void local_roughness(const PlanetCells& cells, std::span<const float> planet_elevation_m,
                     std::span<float> covered);

/// Detail below the planet's own cells.
struct DetailLaw {
  double wavelength_m = 20e3;  ///< of the first octave
  int octaves = 6;
  double gain = 0.5;  ///< amplitude of each octave over that of the one before, 2^-Hurst
};

/// Fractional Brownian motion of unit variance at every cell: a function of seed, stream and
/// position.
/// `detail`: one value per cell; Bug otherwise.
void unit_detail(const Grid& fine, const DetailLaw& law, std::uint64_t seed,
                 std::string_view stream, std::span<float> detail);

/// The same near the edges of a plane, where each wave fades in over half its length, or over
/// `seam_m` where that is shorter: were all to fade in with the longest, the ground along the edge
/// would be an even slope, on which water runs straight. Only cells nearer than `seam_m` are
/// written.
/// `detail`: one value per cell; Bug otherwise.
void unit_detail_near_edge(const Grid& fine, const DetailLaw& law, double seam_m,
                           std::uint64_t seed, std::string_view stream, std::span<float> detail);

/// A height with detail on it. Plains near the level of the sea would become flats at it wherever
/// detail dips further: `inland` (0 to 1), h exp(d / h) stays above it and drains; what lies below
/// it there does not dip further.
[[nodiscard]] double with_detail(double height_m, double detail_m, double inland);

/// Smooth step from 0 at the edge of a plane to 1 at `width_m` from it, at one cell.
double edge_ramp(const Grid& fine, int column, int row, double width_m);

}  // namespace geo
