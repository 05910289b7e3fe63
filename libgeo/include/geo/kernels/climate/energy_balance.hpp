#pragma once

#include <array>
#include <complex>
#include <functional>
#include <memory>
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
  double outgoing_w_m2 = 190;          ///< A at 0 degC
  double outgoing_slope_w_m2_k = 2.4;  ///< B
  double diffusivity_w_m2_k = 0.632;   ///< D at 15 degC, on the unit sphere
  double channel_share = 0.62;     ///< of D that is missing where a channel runs round the planet
  double moist_transport = 0.653;  ///< share of latent heat in D's change with temperature
  double advected_heat_j_m2_k = 1.21e+07;  ///< of the air that winds move
  double coalbedo = 0.662;                 ///< mean absorbed share without snow and ice
  double coalbedo_p2 = -0.108;             ///< its second Legendre coefficient in latitude
  double snow_coalbedo = 0.581;            ///< of snow beneath trees
  double open_snow_coalbedo = 0.507;       ///< of snow where summers are too cold for trees
  double tree_temperature_c = 10;          ///< warmest month at which half the land has trees
  double ice_coalbedo = 0.26;              ///< of land whose snow stays
  double glacier_coalbedo = 0.45;          ///< of land ice that melts in summer
  double sea_ice_coalbedo = 0.545;         ///< of sea ice, broken and wet in summer
  double snow_temperature_c = -3.01;       ///< monthly mean at which half the land is under snow
  double ice_temperature_c = -9;           ///< annual mean at which half the sea is ice
  double ice_width_k = 2.1;                ///< width of both transitions; 0: no ice and snow at all
  double land_heat_capacity_w_yr_m2_k = 0.213;
  double freezing_heat_w_yr_m2 = 3.2;  ///< that the ground's water and snow give as they freeze
  double ocean_heat_capacity_w_yr_m2_k = 6.17;
  double sea_exchange_w_m2_k = 11.9;  ///< heat and vapour from sea to air, per kelvin, at 15 degC
  double sunlit_air_share = 0.287;    ///< of the absorbed sunlight that air over the sea absorbs
  double ice_heat_capacity_w_yr_m2_k = 0.976;  ///< of sea ice that does not melt
  double melt_w_m2_k = 5.69;         ///< heat that melting ice takes for each kelvin above -1 degC
  double gyre_heat_w_m2 = 11.9;      ///< heat that gyres release along a western coast of an ocean
  double gyre_reach_km = 1.34e+03;   ///< e-folding distance of a coast's influence
  double subpolar_heat_w_m2 = 18.8;  ///< heat that subpolar gyres release along an eastern coast
  double subpolar_reach_km = 2.64e+03;
  double blocking_height_m = 1.49e+03;  ///< of topography that halves the heat passing over
  double lapse_k_m = 0.00511;
  double heat_wind_share = 0.279;      ///< of the zonal wind in mid-troposphere that carries heat
  double heat_wave_share = 0;          ///< of the winds about warm and cold ground that carries it
  double upwelling_w_m2 = 382;         ///< heat that water welling up along the equator takes
  double upwelling_trades_m_s = 3.12;  ///< wind from the east with which all of that wells up
  double upwelling_width_deg = 3.1;    ///< of latitude, over which it falls by e
  double upwelling_reach_km = 4.83e+03;      ///< to the west of a coast, over which that falls by e
  double coastal_upwelling_w_m2 = 48;        ///< heat that water and clouds off eastern coasts take
  double coastal_upwelling_reach_km = 3100;  ///< to the west of a coast, over which that falls by e
  double dry_warming_k_m2_w = 0.0317;  ///< by which dry ground is warmer for each W m-2 of sunlight
  double dry_warming_from_w_m2 = 201;  ///< above this
  double inversion_k = 1.74;           ///< by which snow is colder than the air in polar nights
  double inversion_growth = 0.128;     ///< more for each kelvin that it is colder than -10 degC
  double inversion_below_w_m2 = 193;   ///< less sunlight than this counts as a part of a night
};

/// Share of the heat carried over level ground that passes over a cell of a mean height:
///   1 / (1 + (h / blocking_height)^2).
[[nodiscard]] double open_to_heat(const EnergyBalance& model, double height_m);

/// Share of the sea that ice covers where the mean of the year is a temperature:
///   1 / (1 + exp((T - ice_temperature) / ice_width)), none without a width.
[[nodiscard]] double sea_ice_share(const EnergyBalance& model, double annual_mean_c);

/// Heat and vapour that pass from sea to air, per kelvin between them, where the annual mean of the
/// air is a temperature: what latent heat adds grows with it (Haney 1971).
[[nodiscard]] double sea_exchange_w_m2_k(const EnergyBalance& model, double annual_mean_c);
/// What of it is not latent heat.
[[nodiscard]] double dry_sea_exchange_w_m2_k(const EnergyBalance& model);

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

/// Winds that carry heat in one month, from its temperatures (degC at sea level, per cell) and the
/// annual mean of every parallel: east and north, m s-1 per cell. Called from several threads.
using HeatWinds =
    std::function<void(std::span<const float> month_c, std::span<const double> annual_mean_c,
                       std::span<float> east, std::span<float> north)>;

/// Solves, on a sphere or torus, for the periodic year
///   C dT/dt + F u . grad T = Q (1 - albedo) - (A + B T) + ocean + div(D grad T).
/// C is that of land. Over the sea g (T_s - T) takes the place of C dT/dt, and s Q that of Q:
///   C_s dT_s/dt = (1 - s) Q (1 - albedo) - g (T_s - T),
/// T_s the temperature of the mixed layer, s the share of sunlight that the air absorbs, g the
/// exchange of heat and vapour, which grows with the annual mean of T (Haney 1971). T_s is
/// eliminated. Where a channel runs round the planet (open_channels) D over the sea is less. By
/// harmonics: for each a sparse linear system with the annual and zonal mean of u, in whose source
/// all else is found by iteration: the albedo of the months' snow and ice, which is never below
/// that of what they lie on, the heat that ice at sea and on land takes as it melts in summer and
/// gives as it freezes in winter, that of the ground's water likewise, and what the winds of each
/// month carry besides, which sums to zero over the planet. F is the advected heat; without `winds`
/// nothing is carried. Throws Bug if a solver does not converge. Threads: one for each harmonic;
/// the same bits for any number of them.
///
/// @param latitude_deg      per row
/// @param land_fraction     0..1 per cell
/// @param height_m          mean elevation of the cell above sea level, 0 at sea
/// @param glacier_fraction  of the cell's land, 0..1; empty: no ice lies on land. Where none does,
///                          land is bright as its temperature has it snow
/// Throws Bug where sizes differ.
[[nodiscard]] TemperatureCycle solve_energy_balance(const Grid& grid, const EnergyBalance& model,
                                                    bool retrograde,
                                                    std::span<const double> latitude_deg,
                                                    std::span<const float> land_fraction,
                                                    std::span<const float> height_m,
                                                    const HeatWinds& winds = {},
                                                    std::span<const float> glacier_fraction = {});

/// The same for who goes on when winds are known: temperatures, and then those with the upwelling
/// that the winds along the equator make. Arguments as above; what spans view must live as long.
class EnergyBalanceYear {
 public:
  EnergyBalanceYear(const Grid& grid, const EnergyBalance& model, bool retrograde,
                    std::span<const double> latitude_deg, std::span<const float> land_fraction,
                    std::span<const float> height_m, HeatWinds winds,
                    std::span<const float> glacier_fraction);
  EnergyBalanceYear(EnergyBalanceYear&&) noexcept;
  ~EnergyBalanceYear();

  [[nodiscard]] const TemperatureCycle& temperature() const;
  /// `equatorial_wind_m_s`: see ocean_heat. Diffusivity, capacities and the mean of the winds stay
  /// those of the first solution; a few rounds from there.
  void upwell(std::span<const double> equatorial_wind_m_s);

 private:
  class Solver;
  std::unique_ptr<Solver> solver_;
};

}  // namespace geo
