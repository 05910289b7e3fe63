#pragma once

#include <cmath>

namespace geo {

/// How deep the ocean floor lies at an age, before any sediment.
enum class DepthModel {
  gdh1,  ///< Stein & Stein (1992): 2600 + 365 sqrt(t) to 20 Myr, then 5651 - 2473 exp(-0.0278 t)
  ps77,  ///< Parsons & Sclater (1977): 2500 + 350 sqrt(t) to 70 Myr, 6400 - 3200 exp(-t / 62.8)
};

/// Depth below sea level, m; ages below 0 count as 0.
inline double ocean_depth_m(double age_myr, DepthModel model = DepthModel::gdh1) {
  const double t = age_myr > 0.0 ? age_myr : 0.0;
  if (model == DepthModel::gdh1) {
    return t < 20.0 ? 2600.0 + 365.0 * std::sqrt(t) : 5651.0 - 2473.0 * std::exp(-0.0278 * t);
  }
  return t < 70.0 ? 2500.0 + 350.0 * std::sqrt(t) : 6400.0 - 3200.0 * std::exp(-t / 62.8);
}

/// Age at which GDH1 has the floor at a depth, Myr: 0 above the ridges, `oldest_myr` at most.
inline double ocean_age_of_depth_myr(double depth_m, double oldest_myr) {
  constexpr double kRidge_m = 2600.0, kYoung = 365.0,
                   kYoungest_m = 2600.0 + 365.0 * 4.4721359549995794;
  if (depth_m <= kRidge_m) return 0.0;
  const double root = (depth_m - kRidge_m) / kYoung;
  // Between the two branches lies a step of 1 m.
  if (depth_m < kYoungest_m) return std::fmin(root * root, oldest_myr);
  const double left = (5651.0 - depth_m) / 2473.0;
  if (left <= 0.0) return oldest_myr;
  return std::fmin(std::fmax(20.0, -std::log(left) / 0.0278), oldest_myr);
}

/// Heat flow through the floor, mW m-2: 510 / sqrt(t) to 55 Myr, then 48 + 96 exp(-0.0278 t)
/// (Stein & Stein 1992).
inline double ocean_heat_flow_mw_m2(double age_myr) {
  return age_myr <= 55.0 ? 510.0 / std::sqrt(age_myr) : 48.0 + 96.0 * std::exp(-0.0278 * age_myr);
}

/// What covers the deep floor, m of sediment: the rain of plankton and dust, first filling the
/// hollows of the hills within a few Myr, then piling up, and the apron of what rivers bring, which
/// thins away from the foot of the continent. The rain stands for plateaus and swells as well, of
/// which the Earth's floor has the more the older it is: it lifts the floor to the median of its
/// age.
template <class T>
struct BasicDeepSediment {
  T early_m{250.0};
  double early_time_myr = 8.0;
  T rate_m_myr{4.5};
  T apron_m{3000.0};
  T apron_length_km{320.0};
};
using DeepSediment = BasicDeepSediment<double>;

/// What rains on floor of an age t, m: early (1 - exp(-t / early_time)) + rate t.
template <class T>
[[nodiscard]] inline T pelagic_cover_m(const BasicDeepSediment<T>& s, double age_myr) {
  const double t = age_myr > 0.0 ? age_myr : 0.0;
  return s.early_m * -std::expm1(-t / s.early_time_myr) + s.rate_m_myr * t;
}

/// The apron at a distance d from the foot of the continent, m: (1 - exp(-t / 40 Myr)) apron
/// exp(-d / apron_length). Young floor has not been near a continent for long.
template <class T>
[[nodiscard]] inline T apron_m(const BasicDeepSediment<T>& s, double age_myr,
                               double from_continent_km) {
  using std::exp;
  const double grown = -std::expm1(-(age_myr > 0.0 ? age_myr : 0.0) / 40.0);
  return grown * s.apron_m * exp(-std::fmax(from_continent_km, 0.0) / s.apron_length_km);
}

/// Both together, by which the floor is lifted.
template <class T>
[[nodiscard]] inline T deep_sediment_m(const BasicDeepSediment<T>& s, double age_myr,
                                       double from_continent_km) {
  return pelagic_cover_m(s, age_myr) + apron_m(s, age_myr, from_continent_km);
}

/// How much of that is sediment, m with its pores: all of the apron, and of the rain what floor far
/// from continents has on the Earth: 60, 175 and 280 m at 5, 45 and 110 Myr (Laske et al. 2013,
/// ages of Müller et al. 2008).
[[nodiscard]] inline double deep_sediment_thickness_m(const DeepSediment& s, double age_myr,
                                                      double from_continent_km) {
  constexpr double kPelagicShare = 0.38;
  return kPelagicShare * pelagic_cover_m(s, age_myr) + apron_m(s, age_myr, from_continent_km);
}

/// Thickness of sediment as rock without pores, m: porosity falls from 0.63 at the top by e in
/// 1961 m, as in shale (Sclater & Christie 1980).
[[nodiscard]] inline double solid_thickness_m(double thickness_m) {
  constexpr double kPorosity = 0.63, kCompaction_m = 1961.0;
  return thickness_m + kPorosity * kCompaction_m * std::expm1(-thickness_m / kCompaction_m);
}

}  // namespace geo
