#pragma once

#include <complex>
#include <span>

#include "geo/core/grid.hpp"

namespace geo {

/// Heat balance   (loss + sum of conductances) T - sum(conductance * T_neighbour) = source
/// on a sphere or torus, for real or complex unknowns. The matrix is symmetric: conjugate gradients
/// (without conjugation for complex unknowns: COCG, van der Vorst & Melissen 1990), preconditioned
/// with the exact solution of each row, which takes the narrow cells near the poles in its stride.
/// One thread: on a grid of 2 degrees a step takes well below a millisecond.
template <class T>
struct HeatProblem {
  std::span<const double> conductance_east;   ///< of the face to the east, W K-1, size nx*ny
  std::span<const double> conductance_north;  ///< of the face to the north, W K-1 (0 at a pole)
  std::span<const T> loss;                    ///< W K-1 per cell
  std::span<const T> source;                  ///< W per cell
};
/// Improves `temperature` until a step changes less than 1e-5 K, at most `iterations` times.
template <class T>
void solve_heat(const Grid& grid, const HeatProblem<T>& problem, int iterations,
                std::span<T> temperature);

/// Constants of the energy-balance model (North 1975, North et al. 1981, with the moist transport
/// of Flannery 1984).
struct EnergyBalance {
  double solar_constant_w_m2 = 1361.0;
  double obliquity_deg = 23.44;
  double outgoing_w_m2 = 204.6;         ///< A at 0 degC
  double outgoing_slope_w_m2_k = 2.09;  ///< B
  double diffusivity_w_m2_k = 0.53;     ///< D at 15 degC, on the unit sphere
  double moist_transport = 1.0;         ///< share of latent heat in D's change with temperature
  double coalbedo = 0.697;              ///< mean absorbed share without ice
  double coalbedo_p2 = -0.0779;         ///< its second Legendre coefficient in latitude
  double ice_coalbedo = 0.27;           ///< of ice sheets and snow on land
  double sea_ice_coalbedo = 0.55;       ///< of sea ice, broken and wet in summer
  double ice_temperature_c = -16.0;     ///< annual mean at which half the surface is ice
  double ice_width_k = 3.0;             ///< width of the transition; 0: no ice at all
  double land_heat_capacity_w_yr_m2_k = 0.27;
  double ocean_heat_capacity_w_yr_m2_k = 5.4;
  double gyre_heat_w_m2 = 120.0;  ///< heat that gyres release along a western coast of an ocean
  double gyre_reach_km = 3200.0;  ///< e-folding distance of a coast's influence
  double lapse_k_m = 0.0057;
};

/// Heat that wind-driven gyres bring to the sea, W m-2: trades push warm water west and let cold
/// water well up in the east, westerlies the other way round (zero at 45 deg),
///   q = gyre_heat cos(2 lat) (land to the west - land to the east) * water,
/// the land shares weighted by exp(-distance / reach) along the parallel.
void gyre_heat(const Grid& grid, const EnergyBalance& model, std::span<const double> latitude_deg,
               std::span<const float> land_fraction, std::span<double> heat_w_m2);

/// Annual mean and first annual harmonic of the temperature at sea level:
///   C dT/dt = Q (1 - albedo) - (A + B T) + div(D grad T).
/// The mean is solved with its ice cover, the harmonic as a complex Helmholtz equation
/// (B + i omega C) T1 = Q1 (1 - albedo) + div(D grad T1) that shares its matrix.
///
/// @param latitude_deg   per row
/// @param land_fraction  0..1 per cell
/// @param height_m       mean elevation of the cell above sea level, 0 at sea
/// @param[out] mean_c    degC at sea level
/// @param[out] harmonic_k  T(L) = mean + Re(harmonic e^{iL}), L the solar longitude
void solve_energy_balance(const Grid& grid, const EnergyBalance& model,
                          std::span<const double> latitude_deg,
                          std::span<const float> land_fraction, std::span<const float> height_m,
                          std::span<double> mean_c, std::span<std::complex<double>> harmonic_k);

}  // namespace geo
