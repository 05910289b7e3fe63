#pragma once

namespace geo {

/// How snow falls and melts. Melt per degree-day as water (Braithwaite 1995), the rest after Reeh
/// (1991).
struct SnowLaw {
  double snow_melt_mm_k_d = 3.0;  ///< of snow, which is bright
  double ice_melt_mm_k_d = 8.0;
  double scatter_k = 4.5;   ///< standard deviation of days about their month
  double refreezing = 0.6;  ///< share of the year's snow whose meltwater freezes in it
  double ice_kg_m3 = 910.0;
  double year_d = 365.25;
};

/// Degree-days above freezing of a year and the share of its precipitation that falls as snow.
struct FrostOfYear {
  double degree_days = 0.0;
  double snow_share = 0.0;
};

/// Of a year whose months follow a cosine about `mean_c` with `range_k` from the coldest to the
/// warmest, and whose days scatter about them normally: per month T and standard deviation s,
///
///   degree-days   s φ(T/s) + T Φ(T/s) a day      snow   Φ(-T/s)
///
/// (Calov & Greve 2005). Precipitation follows the same cosine, by `summer_rain` of its mean: 0 is
/// even through the year, 1 none in the coldest month, -1 none in the warmest. Finite arguments;
/// range >= 0.
[[nodiscard]] FrostOfYear frost_of_year(const SnowLaw& law, double mean_c, double range_k,
                                        double summer_rain = 0.0);

/// Mass balance of a surface under that year, m of ice a year: snow, less what degree-days melt,
/// first snow, beyond what freezes in it again, then ice. What rains runs off. The balance falls as
/// the mean temperature rises.
[[nodiscard]] double snow_balance_m_yr(const SnowLaw& law, double mean_c, double range_k,
                                       double precipitation_mm_yr, double summer_rain = 0.0);

}  // namespace geo
