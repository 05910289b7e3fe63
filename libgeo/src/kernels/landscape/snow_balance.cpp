#include "geo/kernels/landscape/snow_balance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace geo {

FrostOfYear frost_of_year(const SnowLaw& law, double mean_c, double range_k, double summer_rain) {
  // Twelve months of a cosine are seven temperatures, those between the ends twice.
  constexpr int kHalf = 6;
  static const std::array<double, kHalf + 1> kCosine = [] {
    std::array<double, kHalf + 1> cosine{};
    for (int m = 0; m <= kHalf; ++m) cosine[m] = std::cos(m * std::numbers::pi / kHalf);
    return cosine;
  }();
  const double per_root = 1.0 / std::sqrt(2.0 * std::numbers::pi);
  FrostOfYear year;
  for (int m = 0; m <= kHalf; ++m) {
    const double weight = (m == 0 || m == kHalf ? 1.0 : 2.0) / (2.0 * kHalf);
    const double t = (mean_c + 0.5 * range_k * kCosine[m]) / law.scatter_k;
    const double frost = 0.5 * std::erfc(t / std::numbers::sqrt2);
    const double warmth = per_root * std::exp(-0.5 * t * t) + t * (1.0 - frost);
    year.degree_days += weight * law.scatter_k * law.year_d * std::max(0.0, warmth);
    year.snow_share += weight * (1.0 + summer_rain * kCosine[m]) * frost;
  }
  return year;
}

double snow_balance_m_yr(const SnowLaw& law, double mean_c, double range_k,
                         double precipitation_mm_yr, double summer_rain) {
  const FrostOfYear year = frost_of_year(law, mean_c, range_k, summer_rain);
  const double snow_mm = year.snow_share * precipitation_mm_yr;
  const double melted_mm = std::min(snow_mm, law.snow_melt_mm_k_d * year.degree_days);
  const double lost_mm = std::max(0.0, melted_mm - law.refreezing * snow_mm);
  const double days_left =
      law.snow_melt_mm_k_d > 0.0 ? year.degree_days - melted_mm / law.snow_melt_mm_k_d : 0.0;
  // Superimposed ice melts before that below.
  const double ice_mm = law.ice_melt_mm_k_d * std::max(0.0, days_left);
  const double water_to_ice_m = 1.0 / law.ice_kg_m3;
  return water_to_ice_m * (snow_mm - lost_mm - ice_mm);
}

}  // namespace geo
