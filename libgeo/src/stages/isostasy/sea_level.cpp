#include "geo/stages/isostasy/sea_level.hpp"

#include <algorithm>

#include "geo/kernels/landscape/sea_level.hpp"
#include "geo/kernels/numerics/quantiles.hpp"

namespace geo {

double sea_level_m(const Grid& grid, std::span<const float> elevation_m, const Planet& planet) {
  constexpr double kCubicKilometre_m3 = 1e9;
  if (planet.sea_level == "volume") {
    return sea_level_for_volume(grid, elevation_m, kCubicKilometre_m3 * planet.water_volume_km3);
  }
  const double level_m = level_for_fraction(grid, elevation_m, planet.ocean_fraction);
  if (planet.ocean_fraction <= 0.0) return std::min(level_m, 0.0);
  if (planet.ocean_fraction >= 1.0) return std::max(level_m, 0.0);
  return level_m;
}

}  // namespace geo
