#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "geo/core/grid.hpp"

namespace geo {

/// Which of a set of points is nearest to each cell, by true distance on the sphere plus a length
/// that each point carries (a handicap, m).
///
/// `nearest` holds, on entry, for each cell the number of a point within it or next to it, or -1;
/// on return every cell's nearest point (all -1 where there are no points). Points are handed from
/// cell to cell with their positions (vector propagation, Danielsson 1980), in sweeps over the
/// rows, across the date line and the poles: distances are true ones, neither octagons nor steps
/// of cells, and the choice is wrong only where two points are equally far to a fraction of a
/// cell. Cost: linear. Serial, so that several sets may be propagated side by side.
void nearest_sources(const Grid& grid, std::span<const std::array<float, 3>> unit_position,
                     std::span<const float> handicap_m, std::span<std::int32_t> nearest);

/// Great-circle distance between two unit vectors, m.
double distance_m(const std::array<float, 3>& a, const std::array<float, 3>& b, double radius_m);

}  // namespace geo
