#pragma once

#include <cmath>

namespace geo {

/// Saturation vapour pressure over water, Pa (Bolton 1980), -35..35 degC within 0.1 %.
[[nodiscard]] inline double saturation_pressure_pa(double temperature_c) {
  const double bounded_c = temperature_c < -90.0 ? -90.0 : temperature_c;
  return 611.2 * std::exp(17.67 * bounded_c / (bounded_c + 243.5));
}

/// Water that a saturated column holds, kg m-2 (= mm): vapour density at the surface times the
/// scale height of vapour, e / (R_v T) * H.
[[nodiscard]] inline double saturated_column_mm(double surface_temperature_c,
                                                double vapour_height_m = 2500.0) {
  constexpr double kVapourGasConstant = 461.5;
  return saturation_pressure_pa(surface_temperature_c) /
         (kVapourGasConstant * (surface_temperature_c + 273.15)) * vapour_height_m;
}

/// (L / c_p) RH dq_s/dT at 1 bar and 80 % humidity: how much more latent than sensible heat moist
/// air carries per kelvin.
[[nodiscard]] inline double latent_to_sensible_slope(double temperature_c) {
  constexpr double kLatentOverHeat_k = 2.5e6 / 1004.0, kHumidity = 0.8, kVapourToAir = 0.622;
  const double kelvin = temperature_c + 273.15;
  const double humidity = kVapourToAir * saturation_pressure_pa(temperature_c) / 1.0e5;
  return kLatentOverHeat_k * kHumidity * humidity * 5417.0 / (kelvin * kelvin);
}

}  // namespace geo
