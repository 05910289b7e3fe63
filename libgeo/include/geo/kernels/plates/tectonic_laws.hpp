#pragma once

#include <algorithm>
#include <cmath>

#include "geo/core/vector3.hpp"

namespace geo {

// The laws of "Procedural Tectonic Planets" (Cortial, Peytavie, Galin & Guerin 2019), sections 4.1
// to 4.5, one function each, with what Driftworld makes of them where the paper leaves a choice.
// Lengths in km, speeds and rates in mm/yr, which is km/Myr; times in Myr.

/// Constants of the paper's Table 3.
struct TectonicConstants {
  double step_myr = 2.0;
  double ridge_km = -1.0;                ///< z_r, highest ridge
  double abyss_km = -6.0;                ///< z_a, abyssal plains
  double trench_km = -10.0;              ///< z_t, deepest trench
  double summit_km = 10.0;               ///< z_c, highest continent
  double subduction_distance_km = 1800;  ///< r_s
  double collision_distance_km = 4200;   ///< r_c
  double collision_per_km = 1.3e-5;      ///< Delta_c
  double speed_mm_yr = 100.0;            ///< v_0, fastest plate
  double damping_mm_yr = 4e-2;           ///< epsilon_o
  double erosion_mm_yr = 3e-2;           ///< epsilon_c
  double accretion_mm_yr = 3e-1;         ///< epsilon_t
  double uplift_mm_yr = 6e-1;            ///< u_0
};

/// f of 4.1, a piecewise cubic: 3 s^2 - 2 s^3 from the trench to its maximum at `control_km` (s = d
/// / control), then (1 - s)^3 to 0 at `reach_km` (s = (d - control) / (reach - control)). 0
/// outside.
[[nodiscard]] inline double uplift_by_distance(double d_km, double control_km, double reach_km) {
  if (d_km < 0.0 || d_km >= reach_km) return 0.0;
  if (d_km < control_km) {
    const double s = d_km / control_km;
    return s * s * (3.0 - 2.0 * s);
  }
  const double s = 1.0 - (d_km - control_km) / (reach_km - control_km);
  return s * s * s;
}
/// Driftworld's f, one cubic with its maximum 1 at `control_km` and 0, with zero slope, at reach.
[[nodiscard]] inline double uplift_by_distance_driftworld(double d_km, double control_km,
                                                          double reach_km) {
  if (d_km < 0.0 || d_km >= reach_km) return 0.0;
  const double d = d_km, c = control_km, r = reach_km;
  const double above =
      d * d * d / 3.0 - (c + r) * d * d / 2.0 + c * r * d + r * r * r / 6.0 - r * r * c / 2.0;
  return above / ((r * r * r - c * c * c) / 6.0 + (c * c * r - r * r * c) / 2.0);
}
/// g of 4.1: v / v_0.
[[nodiscard]] inline double uplift_by_speed(double v_mm_yr, double fastest_mm_yr) {
  return v_mm_yr / fastest_mm_yr;
}
/// h of 4.1: the square of the elevation of the subducting crust, from 0 in the deepest trench to 1
/// at the highest summit.
[[nodiscard]] inline double uplift_by_elevation(double z_km, double trench_km, double summit_km) {
  const double s = std::clamp((z_km - trench_km) / (summit_km - trench_km), 0.0, 1.0);
  return s * s;
}
/// Fold direction after a step: f + beta (s_i - s_j) dt. The speeds in mm/yr.
[[nodiscard]] inline Vector3 turned_fold(const Vector3& fold, const Vector3& relative_mm_yr,
                                         double beta, double step_myr) {
  return add(fold, relative_mm_yr, beta * step_myr);
}
/// What one point q of a trench adds to the axis of the subducting plate with centre c:
/// (c x q) / |c x q|; nothing where the two are parallel.
[[nodiscard]] inline Vector3 slab_pull(const Vector3& centre, const Vector3& trench) {
  return normalised(cross(centre, trench));
}

/// r of 4.2: r_c sqrt(v / v_0) A / A_0, at most r_c.
[[nodiscard]] inline double collision_radius_km(double v_mm_yr, double area_km2,
                                                double mean_area_km2,
                                                const TectonicConstants& k = {}) {
  return k.collision_distance_km *
         std::min(1.0, std::sqrt(v_mm_yr / k.speed_mm_yr) * area_km2 / mean_area_km2);
}
/// f of 4.2: (1 - (d / r)^2)^2 within r.
[[nodiscard]] inline double collision_profile(double d_km, double radius_km) {
  if (!(d_km < radius_km)) return 0.0;
  const double s = 1.0 - (d_km / radius_km) * (d_km / radius_km);
  return s * s;
}
/// Surge of 4.2 beside a terrane, km: Delta_c A f. Delta_c is per km, the area in km2.
[[nodiscard]] inline double collision_surge_km(double area_km2, double d_km, double radius_km,
                                               const TectonicConstants& k = {}) {
  return k.collision_per_km * area_km2 * collision_profile(d_km, radius_km);
}
/// Fold direction of 4.2 about a terrane with centroid q: (n x (p - q) / |p - q|) x n, with n = p.
[[nodiscard]] inline Vector3 collision_fold(const Vector3& p, const Vector3& q) {
  return cross(cross(p, normalised(add(p, q, -1.0))), p);
}

/// alpha of 4.3: d_ridge / (d_ridge + d_plate), 0 on the ridge, 1 at the plate; 0 where both are 0.
[[nodiscard]] inline double ridge_share(double to_ridge_km, double to_plate_km) {
  const double sum = to_ridge_km + to_plate_km;
  return sum > 0.0 ? to_ridge_km / sum : 0.0;
}
/// z_Gamma of 4.3: (z_r - z_a) 2^(-d / sigma) + z_a (Driftworld, with the sign that lets the ridge
/// end; its sigma is 0.05 of the planet's radius).
[[nodiscard]] inline double ridge_profile_km(double to_ridge_km, double falloff_km,
                                             const TectonicConstants& k = {}) {
  return (k.ridge_km - k.abyss_km) * std::exp2(-to_ridge_km / falloff_km) + k.abyss_km;
}
/// Elevation of new floor: alpha z_mean + (1 - alpha) z_Gamma.
[[nodiscard]] inline double new_floor_km(double share, double mean_km, double profile_km) {
  return share * mean_km + (1.0 - share) * profile_km;
}

/// Share of its first thickness that a passive margin's crust keeps at a share s of its width, from
/// whole to stretched fourfold; a `haste` above 1 brings it there sooner.
[[nodiscard]] inline double stretched_share(double s, double haste = 1.0) {
  constexpr double kOuter = 0.25;
  return kOuter + (1.0 - kOuter) * std::pow(1.0 - s * s * (3.0 - 2.0 * s), haste);
}
/// How much deeper a column below the sea stands for its water, rho_m / (rho_m - rho_w).
inline constexpr double kWaterLoad = 1.45;
/// Height of a column whose height without the water above it is given.
[[nodiscard]] inline double water_loaded(double dry) { return dry < 0.0 ? kWaterLoad * dry : dry; }
/// Height that a column would have without the water above it.
[[nodiscard]] inline double dry_height(double z) { return z < 0.0 ? z / kWaterLoad : z; }
/// Height of a column at z whose crust has thickened; the root is rho_m / (rho_m - rho_c).
[[nodiscard]] inline double height_after(double z, double thickening, double root) {
  return water_loaded(dry_height(z) + thickening / root);
}

/// P of 4.4: lambda e^-lambda, with lambda = lambda_0 f(x) A / A_0.
[[nodiscard]] inline double rift_probability(double rate, double weight, double area_ratio) {
  const double lambda = rate * weight * area_ratio;
  return lambda * std::exp(-lambda);
}

/// 4.5, continents: change of elevation in a step, -(z / z_c) epsilon_c dt.
[[nodiscard]] inline double erosion_km(double z_km, const TectonicConstants& k = {}) {
  return -(z_km / k.summit_km) * k.erosion_mm_yr * k.step_myr;
}
/// 4.5, ocean floor: -(1 - z / z_t) epsilon_o dt.
[[nodiscard]] inline double damping_km(double z_km, const TectonicConstants& k = {}) {
  return -(1.0 - z_km / k.trench_km) * k.damping_mm_yr * k.step_myr;
}
/// 4.5, trenches: epsilon_t dt.
[[nodiscard]] inline double accretion_km(const TectonicConstants& k = {}) {
  return k.accretion_mm_yr * k.step_myr;
}

}  // namespace geo
