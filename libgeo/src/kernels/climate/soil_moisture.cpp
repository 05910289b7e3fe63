#include "geo/kernels/climate/soil_moisture.hpp"

#include <algorithm>

namespace geo {

std::array<double, kMonths> soil_evaporation_mm(const SoilMoisture& model,
                                                const std::array<double, kMonths>& temperature_c,
                                                const std::array<double, kMonths>& precipitation_mm,
                                                const std::array<double, kMonths>& potential_mm) {
  constexpr int kMostYears = 40;
  constexpr double kSteady_mm = 1e-4;
  constexpr double kAllSnow_c = -1.0, kAllRain_c = 3.0, kMostSnow_mm = 1000.0;
  std::array<double, kMonths> evaporation{};
  // From dry ground on: no year gives back more than it got.
  double soil_mm = 0.0, snow_mm = 0.0;
  for (int year = 0; year < kMostYears; ++year) {
    const double soil_before_mm = soil_mm, snow_before_mm = snow_mm;
    for (int m = 0; m < kMonths; ++m) {
      const double rain_share =
          std::clamp((temperature_c[m] - kAllSnow_c) / (kAllRain_c - kAllSnow_c), 0.0, 1.0);
      snow_mm += (1.0 - rain_share) * precipitation_mm[m];
      const double melt_mm =
          std::min(snow_mm, model.melt_mm_k_month * std::max(0.0, temperature_c[m]));
      snow_mm = std::min(snow_mm - melt_mm, kMostSnow_mm);
      const double water_mm = soil_mm + rain_share * precipitation_mm[m] + melt_mm;
      const double wetness = std::min(1.0, water_mm / (model.stressed_share * model.capacity_mm));
      evaporation[m] = std::min(water_mm, wetness * potential_mm[m]);
      soil_mm = std::min(model.capacity_mm, water_mm - evaporation[m]);
    }
    if (soil_mm - soil_before_mm < kSteady_mm && snow_mm - snow_before_mm < kSteady_mm) break;
  }
  return evaporation;
}

}  // namespace geo
