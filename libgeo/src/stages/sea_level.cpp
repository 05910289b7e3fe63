#include "geo/stages/sea_level.hpp"

#include "geo/kernels/quantiles.hpp"
#include "geo/kernels/sea_level.hpp"

namespace geo {

double sea_level_m(const Grid& grid, std::span<const float> elevation_m, const Planet& planet) {
  constexpr double kCubicKilometre_m3 = 1e9;
  return planet.sea_level == "volume"
             ? sea_level_for_volume(grid, elevation_m, kCubicKilometre_m3 * planet.water_volume_km3)
             : level_for_fraction(grid, elevation_m, planet.ocean_fraction);
}

}  // namespace geo
