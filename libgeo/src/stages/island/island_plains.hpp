#pragma once

#include <span>

#include "geo/kernels/remapping/planet_cells.hpp"

namespace geo {

/// Land that detail or the interpolation dipped below the sea level stays land unless the sea, as
/// the planet has it, reaches it: such dips become plains that rise from where their water leaves.
void dry_inland_dips(const PlanetCells& cells, std::span<const float> planet_elevation_m,
                     std::span<float> z);

}  // namespace geo
