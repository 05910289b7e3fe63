#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/core/random.hpp"

namespace geo::test {

/// Each write moves a height in single precision by up to 2^-24 of it, this way or that: at most so
/// much of the rock that moves. Seen: 5e-8.
inline constexpr double kHeightRounding = 1e-7;

/// Rough random terrain, pits and all: independent values at cells plus a broad random tilt.
/// About a third lies below zero.
inline std::vector<float> random_terrain(const Grid& grid, std::uint64_t seed) {
  const RandomStream random(seed, "test terrain");
  const double tilt_x = random.normal(1'000'000'001), tilt_y = random.normal(1'000'000'002);
  std::vector<float> z(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const double x = static_cast<double>(grid.column(cell)) / grid.nx() - 0.5;
    const double y = static_cast<double>(grid.row(cell)) / grid.ny() - 0.5;
    z[cell] = static_cast<float>(200.0 * random.normal(cell) + 80.0 +
                                 300.0 * (tilt_x * std::sin(6.28 * x) + tilt_y * y));
  }
  return z;
}

/// One grid of each topology, small enough for brute force.
inline std::vector<Grid> small_grids() {
  return {Grid::sphere(60, 30), Grid::torus(40, 50, 1000.0, 1500.0),
          Grid::plane(50, 40, 1000.0, 800.0), Grid::window(48, 32, {40.0, 56.0, -10.0, 14.0})};
}

}  // namespace geo::test
