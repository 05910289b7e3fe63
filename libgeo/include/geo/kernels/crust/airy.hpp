#pragma once

#include "geo/core/numeric.hpp"

namespace geo {

/// Densities of a column, kg m-3 (Turcotte & Schubert 2002).
template <class T>
struct BasicColumnDensities {
  T mantle{3300.0};
  T continental_crust{2800.0};
  T oceanic_crust{2900.0};
  T water{1030.0};
  T sediment{2300.0};
};
using ColumnDensities = BasicColumnDensities<double>;

/// Height of the top of a floating crust above the level at which the mantle alone would stand,
/// m: h = C (rho_m - rho_c) / rho_m (Turcotte & Schubert 2002).
template <class C, class D, class M>
[[nodiscard]] inline auto airy_freeboard_m(const C& thickness_m, const D& density_kg_m3,
                                           const M& mantle_kg_m3) {
  return thickness_m * (mantle_kg_m3 - density_kg_m3) / mantle_kg_m3;
}

/// Elevations of Airy columns against the mid-ocean ridge. The datum is the column of a ridge 2.6
/// km under the sea with 7 km of crust of 2900 kg m-3, whose mantle is hot through and through; a
/// lithosphere in thermal equilibrium (that of GDH1, Stein & Stein 1992) is heavier by as much as
/// lowers a dry column by 2.13 km, and `lithosphere` is the share of that, 0 hot, 1 cold.
/// The dry elevation is C (1 - rho_c / rho_m) - ridge - 2130 m * lithosphere, where `ridge` is
/// what brings the ridge's own column to -2600 m under water. T is double or a number that carries
/// derivatives (core/numeric.hpp).
template <class T>
class BasicAiryDatum {
 public:
  explicit BasicAiryDatum(const BasicColumnDensities<T>& densities = {}) : d_(densities) {
    ridge_m_ = airy_freeboard_m(kRidgeCrustM, d_.oceanic_crust, d_.mantle) +
               kRidgeDepthM / water_load_factor();
  }
  /// rho_m / (rho_m - rho_w): a basin sinks by this much more when the sea fills it.
  [[nodiscard]] T water_load_factor() const { return d_.mantle / (d_.mantle - d_.water); }
  /// Elevation without any water, m, with the sea level at 0.
  [[nodiscard]] T dry_elevation_m(const T& thickness_m, const T& density_kg_m3,
                                  const T& lithosphere) const {
    return airy_freeboard_m(thickness_m, density_kg_m3, d_.mantle) - ridge_m_ -
           kColdLithosphereM * lithosphere;
  }
  /// The same under a sea that loads what lies below its level.
  [[nodiscard]] T loaded(const T& dry_elevation_m) const {
    return value_of(dry_elevation_m) < 0.0 ? dry_elevation_m * water_load_factor()
                                           : dry_elevation_m;
  }
  /// Share of the cold lithosphere that puts ocean floor of 7 km crust at a depth below the sea.
  [[nodiscard]] T lithosphere_of_depth(double depth_m) const {
    return (depth_m - kRidgeDepthM) / (kColdLithosphereM * water_load_factor());
  }
  /// Rise of the sea floor under one metre of sediment, m: it displaces water and sinks in.
  [[nodiscard]] T rise_per_sediment() const {
    return (d_.mantle - d_.sediment) / (d_.mantle - d_.water);
  }

  static constexpr double kRidgeDepthM = 2600.0;
  static constexpr double kRidgeCrustM = 7000.0;
  static constexpr double kColdLithosphereM = 2130.0;

 private:
  BasicColumnDensities<T> d_;
  T ridge_m_;
};
using AiryDatum = BasicAiryDatum<double>;

}  // namespace geo
