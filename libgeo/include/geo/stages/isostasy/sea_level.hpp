#pragma once

#include <span>

#include "geo/core/grid.hpp"
#include "geo/core/planet.hpp"

namespace geo {

/// Where the sea of a planet stands over a surface, m on its datum: at the level that covers
/// planet.ocean_fraction of the area, or that planet.water_volume_km3 fills the basins to. Of the
/// levels that leave all dry, or cover all, it is the one nearest to the datum.
[[nodiscard]] double sea_level_m(const Grid& grid, std::span<const float> elevation_m,
                                 const Planet& planet);

}  // namespace geo
