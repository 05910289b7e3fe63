#pragma once

namespace geo {

/// What strikes, and what it strikes.
struct ImpactScene {
  double diameter_m;  ///< of the impactor
  double density_kg_m3;
  double velocity_m_s;
  double angle_deg;  ///< of the path with the horizontal
  double ground_density_kg_m3;
  double gravity_m_s2;
  double water_depth_m = 0.0;  ///< over the ground
};

/// A crater after its walls have come to rest, all lengths in m.
struct Crater {
  double transient_m;  ///< diameter of the transient crater
  double diameter_m;   ///< from rim to rim
  double depth_m;      ///< from rim to floor
  double rim_m;        ///< height of the rim over the old ground
  double uplift_m;     ///< height of the central peak or peak ring over the floor; 0: none
  double energy_j;     ///< of the impactor before it meets water
  bool complex;        ///< flat floor with a central uplift, not a bowl
  bool has_peak_ring;  ///< the uplift is a ring
};

/// Crater of an impact (Collins, Melosh & Marcus 2005):
///   D_t = 1.161 (rho_i / rho_t)^(1/3) L^0.78 v^0.44 g^-0.22 sin^(1/3) angle,
/// after water of depth w has slowed the impactor by exp(-3 rho_w C_D w / (2 rho_i L sin angle));
/// D = 1.25 D_t where that is below D_c = 3.2 km at 9.81 m s-2 and scales with 1/g, otherwise
/// D = 1.17 D_t^1.13 D_c^-0.13. Rim 0.07 D_t^4 / D^3. Depth of a bowl: transient depth D_t / 2.83
/// and rim less its lens of breccia; of a complex crater 0.4 km (D / km)^0.3 at Earth's gravity,
/// elsewhere the same depth over D_c at the same D over D_c. The central uplift stands 0.35 of the
/// depth over the floor, as in Tycho and Copernicus; it is a ring from 140 km on the Moon
/// (Melosh 1989), a diameter that scales with 1/g. The air does not slow or break the impactor.
[[nodiscard]] Crater crater_of(const ImpactScene& scene);

/// Change of a level ground at `distance_m` from the centre, continuous: bowl r^2, or floor to 0.6
/// of the radius R and a wall (r - 0.6 R)^2; outside the ejecta rim_m (R / r)^3, which is
/// D_t^4 / (112 r^3). A peak reaches to 0.22 R (Pike 1985), a ring lies from 0.4 to 0.6 R.
[[nodiscard]] double crater_profile_m(const Crater& crater, double distance_m);

/// How much of the old surface is gone there: 1 in the crater, 0 from 1.2 radii.
[[nodiscard]] double crater_erasure(const Crater& crater, double distance_m);

}  // namespace geo
