#pragma once

#include <span>

#include "geo/core/grid.hpp"

namespace geo {

/// Level L at which the water over the surface fills `volume_m3`:
///   sum over cells of area * max(0, L - z) = volume,
/// one float per cell (m), L in m on the datum of `elevation_m`. The left side is convex and
/// piecewise linear in L, so Newton's method from above reaches L in finitely many steps; exact
/// but for the rounding of sums in double, the same for any number of threads. The level is not
/// corrected for isostasy. Throws InputError for a field that does not fit the grid or holds a
/// value that is not finite, and for a volume that is not positive and finite.
double sea_level_for_volume(const Grid& grid, std::span<const float> elevation_m, double volume_m3);

}  // namespace geo
