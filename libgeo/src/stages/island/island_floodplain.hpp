#pragma once

#include <cstdint>
#include <span>

#include "geo/kernels/remapping/planet_cells.hpp"
#include "geo/stages/island/island.hpp"

namespace geo {

/// Gives ground that rivers have laid the relief of floodplains, their levees, old channels and
/// terraces: on even ground brooks would run side by side, straight along the grid. Noise n of unit
/// variance below 10 km makes up for what bumps b lack of those that the least roughness R has,
///   z exp(d / z), d = n sqrt(max(0, R^2 - R^2 <b^2> / <b_R^2>)),
/// b the height of a cell above the mean of two opposite neighbours, its mean square over the four
/// directions, smoothed over 1.4 cells. `held` cells keep their height, and land stays above the
/// sea.
void roughen_floodplains(const PlanetCells& cells, const IslandParameters& p, std::uint64_t seed,
                         std::span<const std::uint8_t> held, std::span<float> z);

}  // namespace geo
