#pragma once

#include <cmath>
#include <numbers>

namespace geo {

// Forces on plates, per metre of boundary or square metre of base (Forsyth & Uyeda 1975; Turcotte &
// Schubert 2002, sections 4 and 6). Ages in Myr.

/// What drives plates and what holds them back.
struct PlateForces {
  double mantle_kg_m3 = 3300.0;     ///< rho_m
  double water_kg_m3 = 1030.0;      ///< rho_w
  double expansion_k = 3e-5;        ///< alpha, 1/K
  double contrast_k = 1300.0;       ///< Delta T across the lithosphere, K
  double diffusivity_m2_s = 1e-6;   ///< kappa
  double gravity_m_s2 = 9.81;       ///< g
  double slab_km = 600.0;           ///< L, length of the slab that hangs in the upper mantle
  double slab_share = 0.14;         ///< epsilon, of its weight that reaches the plate
  double suction_share = 0.0;       ///< epsilon_s, of its weight that reaches the plate above
  double viscosity_pa_s = 1e20;     ///< eta, of the asthenosphere
  double asthenosphere_km = 200.0;  ///< h, its thickness
  double continental_drag = 2.0;    ///< f, drag below continents over that below oceans
  double collision_n_m = 5e12;      ///< resistance of each metre of suture
  double response_myr = 4.0;        ///< in which motion follows the forces
};

inline constexpr double kSecondsPerMyr = 3.15576e13;

/// Weight of a slab below each metre of its trench, N/m: 2 rho_m alpha Delta T sqrt(kappa t / pi) g
/// L, t the age of the subducting floor.
[[nodiscard]] inline double slab_weight_n_m(double age_myr, const PlateForces& k = {}) {
  const double cold_m =
      std::sqrt(k.diffusivity_m2_s * std::fmax(age_myr, 0.0) * kSecondsPerMyr / std::numbers::pi);
  return 2.0 * k.mantle_kg_m3 * k.expansion_k * k.contrast_k * cold_m * k.gravity_m_s2 * 1e3 *
         k.slab_km;
}
/// What of this weight W pulls the subducting plate, W epsilon, and what draws the plate above
/// to the trench by the flow that the slab drives in the mantle, W epsilon_s, N/m (Conrad &
/// Lithgow-Bertelloni 2002).
[[nodiscard]] inline double slab_pull_n_m(double age_myr, const PlateForces& k = {}) {
  return slab_weight_n_m(age_myr, k) * k.slab_share;
}
[[nodiscard]] inline double slab_suction_n_m(double age_myr, const PlateForces& k = {}) {
  return slab_weight_n_m(age_myr, k) * k.suction_share;
}
/// Push of all the floor between a ridge and where it has an age, N/m: g rho_m alpha Delta T (1 + 2
/// rho_m alpha Delta T / (pi (rho_m - rho_w))) kappa t.
[[nodiscard]] inline double ridge_push_n_m(double age_myr, const PlateForces& k = {}) {
  const double lighter = k.mantle_kg_m3 * k.expansion_k * k.contrast_k;
  return k.gravity_m_s2 * lighter *
         (1.0 + 2.0 * lighter / (std::numbers::pi * (k.mantle_kg_m3 - k.water_kg_m3))) *
         k.diffusivity_m2_s * std::fmax(age_myr, 0.0) * kSecondsPerMyr;
}
/// Drag on oceanic plates at 1 m/s over a mantle at rest, Pa: eta / h.
[[nodiscard]] inline double basal_drag_pa_s_m(const PlateForces& k = {}) {
  return k.viscosity_pa_s / (1e3 * k.asthenosphere_km);
}

}  // namespace geo
