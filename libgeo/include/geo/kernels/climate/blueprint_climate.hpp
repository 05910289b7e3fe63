#pragma once

#include <span>

#include "geo/core/grid.hpp"
#include "geo/kernels/climate/orography.hpp"

namespace geo {

/// Constants of the climate of the Tectonica blueprint, section 5 (equation numbers are its own).
/// Lengths are kilometres where the blueprint counts 20 km cells.
struct BlueprintClimate {
  double equator_c = 28.0;              ///< 5.1
  double cooling_c_deg2 = 0.007;        ///< 5.1
  double lapse_k_km = 6.0;              ///< 5.2
  double ocean_warming_k = 2.0;         ///< 5.3
  double greenhouse_k = 5.0;            ///< 5.3
  double continental_k_km = 0.008;      ///< 5.3a
  double windward_mm_yr = 600.0;        ///< 5.5
  double windward_decay_km = 1000.0;    ///< 5.5: 0.02 per 20 km
  double windward_trace_km = 1000.0;    ///< 5.5
  double coastal_mm_yr = 600.0;         ///< 5.6
  double coastal_reach_km = 60.0;       ///< 5.6
  double lift_mm_yr_m = 0.8;            ///< 5.7
  double lift_step_km = 20.0;           ///< 5.7: the upwind neighbour
  double shadow_mm_yr_m = 0.40;         ///< 5.8
  double shadow_decay_km = 250.0;       ///< 5.8
  double shadow_trace_km = 500.0;       ///< 5.8
  double altitude_decay_1_m = 0.0004;   ///< 5.9
  double continental_decay_km = 800.0;  ///< 5.10a
  double ocean_factor = 1.2;            ///< ocean precipitation over the zonal base
  double aerosol_mm_yr = 200.0;         ///< 5.10: rain lost per unit of aerosol
};

/// Temperature, eqs 5.1-5.3a, degC: the sum of all terms, clamped to -70..55. `aerosol_k` is the
/// cooling by events.
[[nodiscard]] double blueprint_temperature_c(const BlueprintClimate& model, double latitude_deg,
                                             double elevation_m, double distance_to_coast_km,
                                             double pressure_bar, double noise_k = 0.0,
                                             double aerosol_k = 0.0);
/// Zonal base of precipitation, eq. 5.4, mm yr-1: linear between its values.
[[nodiscard]] double hadley_precipitation_mm_yr(double latitude_deg);

/// Coastal exposure of a place (5.6): share of sea within a disc about the cell (column, row), from
/// 36 samples of the share of land, right to some 0.03.
[[nodiscard]] double sea_exposure(const DisplacedSampler& land, int column, int row,
                                  double reach_m);

/// What topography and the wind make of precipitation, mm yr-1 per cell: windward moisture (5.5),
/// coastal exposure (5.6), orographic lift (5.7), rain shadow (5.8, subtracted), traced against the
/// three-cell wind in kilometres over wrapping edges and poles.
/// @param latitude_deg  per row
/// `latitude_deg`: one value per row, from south to north; the others one per cell; Bug otherwise.
void blueprint_orographic_precipitation(const Grid& grid, const BlueprintClimate& model,
                                        std::span<const double> latitude_deg,
                                        std::span<const float> land_fraction,
                                        std::span<const float> height_m,
                                        std::span<float> rain_mm_yr);

/// The whole of eq. 5.10 for one cell. Land loses `aerosol_mm_yr` per unit of `aerosol`, the
/// optical depth of what events have left in the air, and is clamped to 20..4500 mm yr-1; rain at
/// sea knows no aerosol.
[[nodiscard]] double blueprint_precipitation_mm_yr(const BlueprintClimate& model,
                                                   double hadley_mm_yr, double relief_mm_yr,
                                                   double elevation_m, double distance_to_coast_km,
                                                   double pressure_bar, double noise_mm_yr,
                                                   double aerosol = 0.0);

}  // namespace geo
