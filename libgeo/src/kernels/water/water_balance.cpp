#include "geo/kernels/water/water_balance.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/kernels/climate/evaporation.hpp"

namespace geo {

double land_evaporation(double precipitation_mm_yr, double potential_mm_yr) {
  if (!(precipitation_mm_yr > 0) || !(potential_mm_yr > 0)) return 0.0;
  const double share = budyko_evaporated_share(potential_mm_yr / precipitation_mm_yr);
  return std::min({precipitation_mm_yr * share, precipitation_mm_yr, potential_mm_yr});
}

LandWater land_water(const Grid& grid, std::span<const std::uint8_t> sea,
                     std::span<const float> precipitation_mm_yr,
                     std::span<const float> potential_mm_yr, std::span<double> runoff_m3_s,
                     std::span<float> flooding_loss_m3_s) {
  check_sizes("land_water", grid.size(),
              {{"sea", sea.size()},
               {"precipitation_mm_yr", precipitation_mm_yr.size()},
               {"potential_mm_yr", potential_mm_yr.size()},
               {"runoff_m3_s", runoff_m3_s.size()},
               {"flooding_loss_m3_s", flooding_loss_m3_s.size()}});
  std::vector<LandWater> rows(grid.ny());
#pragma omp parallel for schedule(dynamic, 8)
  for (int j = 0; j < grid.ny(); ++j) {
    const double m3_s_per_mm_yr = grid.area_m2(j) * 1e-3 / kSecondsPerYear;
    for (Index c = grid.cell(0, j); c < grid.cell(0, j) + grid.nx(); ++c) {
      runoff_m3_s[c] = 0;
      flooding_loss_m3_s[c] = 0;
      if (sea[c] != 0) continue;
      const double p = std::max(precipitation_mm_yr[c], 0.0F);
      const double potential = std::max(potential_mm_yr[c], 0.0F);
      const double e = land_evaporation(p, potential);
      runoff_m3_s[c] = (p - e) * m3_s_per_mm_yr;
      flooding_loss_m3_s[c] = static_cast<float>((potential - e) * m3_s_per_mm_yr);
      rows[j].precipitation_m3_s += p * m3_s_per_mm_yr;
      rows[j].evaporation_m3_s += e * m3_s_per_mm_yr;
    }
  }
  LandWater total;
  for (const LandWater& row : rows) {
    total.precipitation_m3_s += row.precipitation_m3_s;
    total.evaporation_m3_s += row.evaporation_m3_s;
  }
  return total;
}

}  // namespace geo
