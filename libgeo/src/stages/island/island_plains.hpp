#pragma once

#include <cstdint>
#include <span>

#include "geo/kernels/remapping/planet_cells.hpp"
#include "geo/stages/island/island.hpp"

namespace geo {

/// Land that detail or the interpolation dipped below the sea level stays land unless the sea, as
/// the planet has it, reaches it: such dips become plains that rise from where their water leaves.
void dry_inland_dips(const PlanetCells& cells, std::span<const float> planet_elevation_m,
                     const IslandParameters& p, std::uint64_t seed, std::span<float> z);

}  // namespace geo
