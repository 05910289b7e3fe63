#pragma once

#include <cstdint>
#include <vector>

#include "geo/kernels/numerics/area_sum.hpp"
#include "geo/kernels/numerics/shapes.hpp"
#include "geo/stages/isostasy/crust.hpp"

namespace geo {

/// Whether the freeboard of continents is adjusted to the depth of the sea. Where the volume of
/// water is given, the sea finds its own level.
[[nodiscard]] inline bool settles_continents(const IsostasyParameters& p, const Planet& planet) {
  return (p.crust == "margins" || p.crust == "simulated") && p.ocean_depth_m > 0.0 &&
         planet.sea_level == "fraction";
}

/// How often they do: the first time moves the shore onto other crust.
inline constexpr int kSettlings = 2;

/// Constant freeboard (Wise 1974): continents wear down and build up until the sea reaches their
/// edges, so their crust is as thick as the basins between them are deep. All continental crust
/// rises or sinks by
///   R = g (D - mean over the sea of (level - z)) A / (A - A_c),
/// thickness by R / (1 - rho_c / rho_m), so that the mean depth becomes D = `ocean_depth_m` once
/// the sea has risen as far; A: area of the sea (`wet`), A_c: continental crust under it. g goes
/// to 0 where the sea is too small to reach onto continents: there they do not set its depth.
/// `level_m`: of the sea before. Returns R, m.
/// Source: Wise, D. U. (1974), The Geology of Continental Margins, 45-58.
template <class V>
Arithmetic<V> settle_continents(const Crust<V>& crust, const V& level_m,
                                const std::vector<std::uint8_t>& wet) {
  using Number = Arithmetic<V>;
  const Grid& grid = crust.grid;
  const auto sum = [&](auto&& value) {
    return area_sum<double>(grid, [&](Index c) { return wet[c] != 0 ? value(c) : 0.0; });
  };
  const double sea = sum([](Index) { return 1.0; });
  const double basins = sum([&](Index c) { return 1.0 - static_cast<double>(crust.fraction[c]); });
  if (!(basins > 0.0)) return Number(0.0);
  const double all_floor =
      area_sum<double>(grid, [&](Index c) { return 1.0 - static_cast<double>(crust.fraction[c]); });
  const double reaches = smooth_step(0.0, 0.05, (sea - all_floor) / grid.total_area_m2());
  const Number depth_m =
      area_sum<Number>(grid,
                       [&](Index c) {
                         return wet[c] != 0 ? Number(level_m - crust.elevation_m[c]) : Number(0.0);
                       }) /
      sea;
  const Number rise_m =
      (crust.active(crust.parameters.ocean_depth_m) - depth_m) * (reaches * sea / basins);
  const auto density = crust.densities();
  const Number thickening_m = rise_m / (1.0 - density.continental_crust / density.mantle);
#pragma omp parallel for schedule(static)
  for (Index c = 0; c < grid.size(); ++c) {
    const double share = crust.fraction[c];
    crust.elevation_m[c] = V(Number(crust.elevation_m[c]) + rise_m * share);
    crust.thickness_m[c] =
        V(limited(Number(Number(crust.thickness_m[c]) + thickening_m * share), 3e3, 80e3));
  }
  return rise_m;
}

}  // namespace geo
