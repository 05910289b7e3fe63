#pragma once

#include <span>

#include "geo/core/grid.hpp"

namespace geo {

/// Distance from each cell's centre to the nearest coast, m, on land and at sea. The coast is the
/// set of mid-points of faces between a land cell (elevation >= 0) and a sea cell.
///
/// Exact: great circles on latitude-longitude grids (on the sphere of the figure's radius, so
/// within the flattening of the geodesic), straight lines on planes and tori, across wrapping
/// edges and poles. Linear cost: the nearest coast along each parallel (one pass either way)
/// leaves one candidate per parallel and meridian; the best of those maximises a linear function,
/// so the candidates of a meridian form an upper convex hull that the rows walk along. Same idea
/// as the separable Euclidean transform of Felzenszwalb & Huttenlocher (2012). Threads work on
/// blocks of columns; needs 4 bytes per cell.
///
/// Without any coast every cell gets half the circumference (half the perimeter of a plane).
/// Arrays have one value per cell (`check_sizes`); Bug otherwise.
void distance_to_coast(const Grid& grid, std::span<const float> elevation,
                       std::span<float> distance_m);

}  // namespace geo
