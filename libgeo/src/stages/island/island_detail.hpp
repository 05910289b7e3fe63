#pragma once

#include <cstdint>
#include <span>

#include "island_surface.hpp"

namespace geo {

/// Detail that continues the planet's roughness, its mean over each planet cell taken out; on land
/// that of exemplars, unless `exemplars` is null. `planet_m`: the planet's surface alone.
void add_rough_detail(const PlanetCells& cells, const PlanetTerrain& planet,
                      const IslandParameters& p, const ExemplarLibrary* exemplars,
                      std::uint64_t seed, std::span<const float> planet_m, std::span<float> z);

/// Blueprint 9.3: amplitude in proportion to height.
void add_height_detail(const PlanetCells& cells, const IslandParameters& p, std::uint64_t seed,
                       std::span<float> z);

}  // namespace geo
