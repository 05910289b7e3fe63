#include "geo/kernels/climate/evaporation.hpp"

#include <algorithm>
#include <cmath>

#include "geo/core/array_sizes.hpp"

namespace geo {

double budyko_evaporated_share(double dryness) {
  if (!(dryness > 0.0)) return 0.0;
  return std::sqrt(dryness * std::tanh(1.0 / dryness) * -std::expm1(-dryness));
}

double oudin_evaporation_mm_d(double insolation_w_m2, double temperature_c) {
  constexpr double kSecondsPerDay = 86400.0, kLatentHeat_j_kg = 2.45e6;
  return insolation_w_m2 * kSecondsPerDay / kLatentHeat_j_kg * std::max(0.0, temperature_c + 5.0) /
         100.0;
}

double clearness(double precipitation_mm, double potential_mm) {
  if (!(potential_mm > 0.0)) return 1.0;
  const double sunshine = 0.35 + 0.55 * std::exp(-precipitation_mm / potential_mm);
  return (0.25 + 0.5 * sunshine) / 0.5;
}

double wind_over_sea_m_s(double east_m_s, double north_m_s, double eddies_m_s) {
  constexpr double kGustsOfCalmAir_m_s = 4.0;
  return std::hypot(std::hypot(east_m_s, north_m_s), eddies_m_s, kGustsOfCalmAir_m_s);
}

std::vector<float> cold_advection_k_s(const Grid& grid, std::span<const float> temperature_c,
                                      std::span<const float> wind_east,
                                      std::span<const float> wind_north) {
  check_sizes("cold_advection_k_s", grid.size(),
              {{"temperature_c", temperature_c.size()},
               {"wind_east", wind_east.size()},
               {"wind_north", wind_north.size()}});
  std::vector<float> cooling(temperature_c.size());
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      const Index here = grid.cell(i, j);
      const auto carried = [&](double wind, int behind, int ahead, double spacing_m) {
        const Index upwind = grid.neighbour(i, j, wind > 0.0 ? behind : ahead);
        return std::abs(wind) * (temperature_c[here] - temperature_c[upwind]) / spacing_m;
      };
      const double cooling_k_s = carried(wind_east[here], kWest, kEast, grid.spacing_east_m(j)) +
                                 carried(wind_north[here], kSouth, kNorth, grid.spacing_north_m(j));
      cooling[here] = static_cast<float>(std::max(0.0, cooling_k_s));
    }
  }
  return cooling;
}

}  // namespace geo
