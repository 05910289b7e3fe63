#pragma once

#include <array>
#include <complex>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/kernels/climate/insolation.hpp"

namespace geo {

/// Constants of the energy-balance model (North 1975, North et al. 1981, with the moist transport
/// of Flannery 1984).
struct EnergyBalance {
  double solar_constant_w_m2 = 1361.0;
  Orbit orbit;
  double outgoing_w_m2 = 198.0;         ///< A at 0 degC
  double outgoing_slope_w_m2_k = 2.36;  ///< B
  double diffusivity_w_m2_k = 0.552;    ///< D at 15 degC, on the unit sphere
  double moist_transport = 1.15;        ///< share of latent heat in D's change with temperature
  double advected_heat_j_m2_k = 9.5e6;  ///< of the air that the zonal wind moves
  double coalbedo = 0.682;              ///< mean absorbed share without snow and ice
  double coalbedo_p2 = -0.0788;         ///< its second Legendre coefficient in latitude
  double snow_coalbedo = 0.66;          ///< of snow that melts in summer
  double ice_coalbedo = 0.232;          ///< of land whose snow stays
  double sea_ice_coalbedo = 0.65;       ///< of sea ice, broken and wet in summer
  double snow_temperature_c = -4.14;    ///< monthly mean at which half the land is under snow
  double ice_temperature_c = -9.68;     ///< annual mean at which half the sea is ice
  double ice_width_k = 2.45;            ///< width of both transitions; 0: no ice and snow at all
  double land_heat_capacity_w_yr_m2_k = 0.104;
  double ocean_heat_capacity_w_yr_m2_k = 6.73;
  double ice_heat_capacity_w_yr_m2_k = 0.532;  ///< of sea ice that does not melt
  double melt_w_m2_k = 10.1;      ///< heat that melting sea ice takes for each kelvin above -1 degC
  double gyre_heat_w_m2 = 41.9;   ///< heat that gyres release along a western coast of an ocean
  double gyre_reach_km = 1030.0;  ///< e-folding distance of a coast's influence
  double lapse_k_m = 0.00498;
  double dry_warming_k_m2_w = 0.0268;  ///< by which dry ground is warmer for each W m-2 of sunlight
  double dry_warming_from_w_m2 = 160.0;  ///< above this
};

/// Heat that wind-driven gyres bring to the sea, W m-2: trades push warm water west and let cold
/// water well up in the east, westerlies the other way round (zero at 45 deg),
///   q = gyre_heat cos(2 lat) (land to the west - land to the east) * water,
/// the land shares weighted by exp(-distance / reach) along the parallel. On a planet that turns
/// the other way, west is east.
/// Throws Bug where sizes differ.
void gyre_heat(const Grid& grid, const EnergyBalance& model, bool retrograde,
               std::span<const double> latitude_deg, std::span<const float> land_fraction,
               std::span<double> heat_w_m2);

/// Share of the sea that ice covers where the mean of the year is a temperature:
///   1 / (1 + exp((T - ice_temperature) / ice_width)), none without a width.
[[nodiscard]] double sea_ice_share(const EnergyBalance& model, double annual_mean_c);

/// Temperature at sea level through the year, in harmonics of the time of the year t (0 to 1):
///   T(t) = mean + Re(sum over k of harmonic_k e^(2 pi i k t)).
class TemperatureCycle {
 public:
  static constexpr int kHarmonics = 2;
  explicit TemperatureCycle(std::size_t cells) {
    for (auto& harmonic : harmonics_) harmonic.assign(cells, 0.0);
  }
  /// The mean for 0.
  [[nodiscard]] std::span<std::complex<double>> harmonic(int k) { return harmonics_[k]; }
  [[nodiscard]] std::span<const std::complex<double>> harmonic(int k) const {
    return harmonics_[k];
  }
  [[nodiscard]] double mean_c(std::size_t cell) const { return harmonics_[0][cell].real(); }
  /// In the middle of a month, 0 for January.
  [[nodiscard]] double month_c(std::size_t cell, int month) const;

 private:
  std::array<std::vector<std::complex<double>>, kHarmonics + 1> harmonics_;
};

/// Solves, on a sphere or torus,
///   C dT/dt + F u dT/dx = Q (1 - albedo) - (A + B T) + gyres + div(D grad T)
/// for the periodic year, by harmonics: for each a sparse linear system, in whose source the albedo
/// of the months' snow and ice is found by iteration. F is the advected heat, u the zonal wind.
/// Throws Bug if a solver does not converge. Threads: one for each harmonic.
///
/// @param latitude_deg, zonal_wind_m_s  per row
/// @param land_fraction  0..1 per cell
/// @param height_m       mean elevation of the cell above sea level, 0 at sea
/// Throws Bug where sizes differ.
[[nodiscard]] TemperatureCycle solve_energy_balance(const Grid& grid, const EnergyBalance& model,
                                                    bool retrograde,
                                                    std::span<const double> latitude_deg,
                                                    std::span<const double> zonal_wind_m_s,
                                                    std::span<const float> land_fraction,
                                                    std::span<const float> height_m);

}  // namespace geo
