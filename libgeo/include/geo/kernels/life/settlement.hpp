#pragma once

#include <array>

namespace geo {

/// A year of twelve months, the first in midsummer or midwinter as the climate counts them.
struct MonthlyClimate {
  std::array<double, 12> temperature_c;
  std::array<double, 12> precipitation_mm;  ///< per month
};

/// The harmonic year T = mean + range / 2 cos θ, P = annual / 12 (1 + s cos θ), s cut to [-1, 1].
[[nodiscard]] MonthlyClimate harmonic_months(double mean_c, double range_k, double annual_mm,
                                             double seasonality);

/// Limits to farming, each from 0 (impossible) to 1 (no limit).
struct SettlementLimits {
  double warmth;  ///< long enough a growing season: 1 / (1 + exp(0.0052 (1334 - D))), D in degree
                  ///< days above 5 degC (Ramankutty et al. 2002)
  double water;   ///< 1 / (1 + exp(14.705 (0.3295 - a))), a = actual over potential
                  ///< evapotranspiration (Ramankutty et al. 2002), the former after Budyko (1974),
                  ///< the latter 58.93 mm yr-1 per degree of biotemperature (Holdridge 1967)
  double heat;    ///< work that a body can do, mean of the months: 1 - 0.25 max(0, W - 25)^(2/3),
                  ///< W the wet-bulb globe temperature in the shade, degC, at noon (Dunne 2013)
  double soil;    ///< what leaching leaves: warm and wet climates wash nutrients out of deeply
                  ///< weathered ground (Sanchez 2019)

  /// All of them together.
  [[nodiscard]] double product() const { return warmth * water * heat * soil; }
};
[[nodiscard]] SettlementLimits settlement_limits(const MonthlyClimate& climate);

/// Share of land that slope (its tangent) leaves for fields: 1 up to 0.08, falling to 0 at 0.45
/// (Fischer et al. 2012).
[[nodiscard]] double slope_limit(double slope);

/// The slope at the length of fields, 1 km, from the range of elevation in a wider neighbourhood:
/// ranges of elevation grow with the root of the length (Hurst exponent 1/2, Turcotte 1997).
[[nodiscard]] double field_slope(double range_m, double length_m);

/// Temperature of a wet bulb in air of the pressure at sea level, degC, within 1 K from 5 to 99 %
/// and -20 to 50 degC (Stull 2011).
[[nodiscard]] double wet_bulb_c(double temperature_c, double relative_humidity);

}  // namespace geo
