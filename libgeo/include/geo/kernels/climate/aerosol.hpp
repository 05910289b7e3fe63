#pragma once

namespace geo {

/// Aerosol that an event has put into the stratosphere, and the climate that it dims.
struct AerosolVeil {
  double mass_kg;
  double lifetime_yr;      ///< time in which the mass falls to 1/e
  double planet_area_m2;   ///< over which they spread evenly
  double absorbed_w_m2;    ///< sunlight that the planet takes up without them
  double feedback_w_m2_k;  ///< by how much its radiation to space falls per kelvin
  double heat_capacity_w_yr_m2_k;
};

/// Optical depth 2500 m2 kg-1 * mass / area: the particles of Pinatubo (30 Tg of solution, 0.15).
[[nodiscard]] double aerosol_optical_depth(const AerosolVeil& veil);

/// By how much the planet is cooler than before, K, `age_yr` after the event, or in the coldest
/// year if that is still to come. The forcing is -25 W m-2 per unit of optical depth (Hansen et al.
/// 2005) and never takes more than all sunlight,
///   F = absorbed (1 - exp(-25 tau / absorbed)),
/// decays with the lifetime L, and meets one heat capacity C with feedback B, so that with
/// R = C / B
///   dT(t) = F / B * L / (L - R) * (exp(-t / L) - exp(-t / R)).
/// The Chicxulub impact, 12 km wide, then cools Earth by about 26 K (Brugger et al. 2017).
[[nodiscard]] double aerosol_cooling_k(const AerosolVeil& veil, double age_yr);

/// Share of precipitation that is left in air cooled by dimmed sunlight, 2.4 % per kelvin (Bala,
/// Duffy & Taylor 2008).
[[nodiscard]] double precipitation_left(double cooling_k);

}  // namespace geo
