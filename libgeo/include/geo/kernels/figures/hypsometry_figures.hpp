#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Hypsometry of a planet, by true area.
struct HypsometryFigures {
  double land_fraction = 0.0;    ///< share of the area with elevation >= 0
  double land_mean_m = 0.0;      ///< NaN when there is no land
  double ocean_mean_m = 0.0;     ///< NaN when there is no ocean; below zero
  double water_volume_m3 = 0.0;  ///< of the ocean below elevation 0
};

/// Shares, means and volume by true cell area. `elevation_m` holds one value per cell; throws
/// InputError when it does not fit the grid. Cost: linear.
HypsometryFigures measure_hypsometry(const Grid& grid, std::span<const float> elevation_m);

/// Shares of the area below levels[0], from each level up to the next, and from the last one up:
/// one more than levels, adding up to 1. Levels ascend. Throws InputError on wrong shapes.
std::vector<double> shares_between(const Grid& grid, std::span<const float> field,
                                   std::span<const double> levels);

/// Modes of elevation, and the antimode between them.
struct ElevationModes {
  double ocean_m, land_m, antimode_m;
};

/// Modes of the density of area over elevation. Ocean and antimode: bins of 25 m smoothed by a
/// Gaussian of 150 m, the highest below 1000 m of depth (shelves are drowned land) and the lowest
/// between that and the sea surface, the deepest of equals.
/// Land: centre of the fullest of the bins of 50 m above zero, each blended 1:2:1 with its
/// neighbours. NaN where there is no land or no deep sea. Cost: linear.
ElevationModes elevation_modes(const Grid& grid, std::span<const float> elevation_m);

}  // namespace geo
