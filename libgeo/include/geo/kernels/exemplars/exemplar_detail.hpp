#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/kernels/exemplars/exemplar.hpp"

namespace geo {

/// What a planet says about the terrain of a place. One value per cell of a sphere; all but the
/// elevation may be empty.
struct TerrainGuide {
  std::span<const float> elevation_m;
  std::span<const std::int8_t> orogeny_type;  ///< OrogenyType
  std::span<const float> orogeny_age_myr;
  std::span<const float> fold_east, fold_north;
  double old_myr = 100.0;      ///< age from which orogens count as old mountains
  double plain_slope = 0.005;  ///< rise over run about a place below which it is a plain
  double level_weight = 0.0;   ///< what contours count beside given folds
};

/// What a planet's cells about one place say, in the frame of east and north there.
struct LocalTerrain {
  std::array<double, kTerrains> share{};  ///< of each terrain
  double fold_rad = 0.0;                  ///< from east
  double roughness_m = 0.0;  ///< root mean square height above the mean of two neighbours
};
/// Looks at 5 x 5 places a cell apart. Terrain as Cortial et al. (2019): in an orogeny, by its type
/// or old by its age; else old mountains where it is steep, plain where not. Folds run as given,
/// or where there are none along the contours of the planet's own surface; with a `level_weight`
/// between the two.
[[nodiscard]] LocalTerrain look_around(const Grid& planet, const TerrainGuide& guide,
                                       const std::array<double, 3>& unit, double spacing_m);

/// Wavelengths that detail made of exemplars holds.
struct ExemplarBand {
  double spacing_m = 10e3;    ///< of the planet's cells, whose own detail ends at about twice that
  double longest_m = 20e3;    ///< of the exemplars' waves
  double shortest_m = 600.0;  ///< what their cells can show
  double hurst = 0.75;        ///< amplitudes of waves go with this power of their length
};
/// Settles the band of a library for cells of `fine_cell_m`.
[[nodiscard]] ExemplarBand exemplar_band(const ExemplarLibrary& library, double spacing_m,
                                         double fine_cell_m, double hurst = 0.75);

/// Terrain of zero mean and unit variance, as exemplars have it below the planet's cells.
///
/// Primitives, discs of terrain, stand about the points of a jittered Fibonacci lattice on the
/// sphere, so that they belong to places whatever grid looks at them. Each draws a terrain from
/// what the planet says at its centre, an exemplar of that terrain (likelier the more its roughness
/// is like the planet's), a piece of it, and a mirror image or not; and is turned so that its folds
/// run along those of the place (Cortial et al. 2019, section 5). Exemplars come high-passed, in
/// wavelengths below 2.5 planet cells; each octave of them as strong as its neighbours and the
/// Hurst exponent ask, by a factor of 4 at most, so that the spectrum has neither gap
/// nor hump; and evened out to one variance. Blended as
///   sum_k w_k e_k / sqrt(sum_k w_k^2),  w = (1 - r^2 / R^2)^2 exp(-4 r^2 / d^2)
/// (r the distance from a primitive, d the distance between primitives, R = 1.5 d), which keeps the
/// variance that a weighted mean would lose (Heitz & Neyret 2018).
///
/// `fine` is a projected plane. The same bits for any number of threads. Cost: about eight products
/// with 16 taps per cell. Throws InputError when the library is empty or `fine` has no place, Bug
/// where sizes differ.
void exemplar_detail(const Grid& planet, const TerrainGuide& guide, const Grid& fine,
                     const ExemplarLibrary& library, const ExemplarBand& band, std::uint64_t seed,
                     std::span<float> detail);

/// Least shorter side of an exemplar whose pieces show what waves of a length are like: they are
/// two of them long.
[[nodiscard]] double least_side_m(double longest_m);
/// Whether it is that large, and its cells are a twelfth of the waves at most.
[[nodiscard]] bool holds_waves(const Exemplar& exemplar, double longest_m);

/// The band of a whole planet, whose plates make its surface down to waves of `longest_m`: what
/// discs of the library hold of it, on cells of a 64th of its longest wave, whatever the grid.
[[nodiscard]] ExemplarBand planetary_band(const ExemplarLibrary& library, double longest_m);

/// The same terrain on a whole planet, below the waves that its plates make: unit variance and no
/// mean within the band. `guide` belongs to the sphere `on`, which may be coarser than `grid`.
/// Cells with 0 in `wanted` (one byte per cell of `grid`, or empty: all) are left out and become 0.
/// Grids differ by what their cells can show, waves longer than about 2.5 of them; there is no seam
/// at a meridian or a pole. The same bits for any number of threads. Cost: about eight products
/// with 16 taps per wanted cell, besides two blurs of each exemplar. Throws InputError when the
/// library is empty or a grid is no sphere, Bug where sizes differ.
void exemplar_detail_on_sphere(const Grid& grid, std::span<const std::uint8_t> wanted,
                               const Grid& on, const TerrainGuide& guide,
                               const ExemplarLibrary& library, const ExemplarBand& band,
                               std::uint64_t seed, std::span<float> detail);

}  // namespace geo
