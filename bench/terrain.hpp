#pragma once

#include <vector>

#include "geo/core/grid.hpp"

namespace geo::bench {

/// 4096 x 2048 cells unless the environment variable TERRANE_BENCH_NX asks for another width.
int columns();

/// The whole planet with columns() columns.
const Grid& sphere();
/// A plane of as many cells of 1 km, open at its edges.
const Grid& plane();

/// Fractal relief with the amplitude of Earth's and about 56 % of the cells above 0 m; made once.
const std::vector<float>& terrain(const Grid& grid);

}  // namespace geo::bench
