#pragma once

#include <functional>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/kernels/climate/circulation.hpp"
#include "geo/kernels/climate/energy_balance.hpp"
#include "geo/kernels/climate/moisture.hpp"

namespace geo {

/// Constants of the seasonal climate: energy balance, winds, eddies, moisture.
struct SeasonalClimate {
  EnergyBalance energy;
  Circulation circulation;
  MoistureBudget moisture;
  double itcz_share = 1.22;  ///< of the thermal equator's excursion that the cells follow
  double base_diffusivity_m2_s = 7.5e5;
  double eddy_diffusivity_m2_s = 3.7e5;  ///< at the reference temperature gradient
  double eddy_rain = 5.8;                ///< extra rain-out activity there
  double eddy_gradient_k_1000km = 6.6;   ///< the reference gradient
  double ascent_time_d = 5.2;            ///< convergence over this time multiplies rain-out by e
  double orographic_share = 0.19;  ///< of the mean height by which moist air is lifted over a cell
  double blocking_height_m = 5000.0;  ///< height at which relief halves the moist flow
  double land_transpiration = 0.97;   ///< share of Budyko's evaporation that returns to the air
};

/// Water that passes between a surface and its air, m3 s-1 over the year. The two sides are summed
/// each by itself, and agree as far as the moisture budget was solved.
struct AirWater {
  double sea_evaporation_m3_s = 0.0, land_evaporation_m3_s = 0.0;
  double precipitation_m3_s = 0.0;
};

/// Fields of a coarse grid, one value per cell.
struct SeasonalFields {
  std::vector<float> temperature_c;                   ///< annual mean at sea level
  std::vector<float> harmonic_cos_k, harmonic_sin_k;  ///< T(L) = mean + cos * cos L - sin * sin L
  std::vector<float> precipitation_mm_yr;
  std::vector<float> boreal_rain_share;  ///< July-phased annual harmonic of rain over its mean
  std::vector<float> wind_east, wind_north;
  std::vector<float> humidity;  ///< annual mean relative humidity of the column
  AirWater water;
};

/// From the annual mean winds, east and north, how many times more than over level ground the air
/// over each cell rains out, given that its relief lifts it here and lets it sink there.
using ReliefAscent = std::function<std::vector<float>(std::span<const float> wind_east,
                                                      std::span<const float> wind_north)>;

/// Twelve months of climate of a sphere or torus from its relief: sea-level temperature from the
/// energy balance, winds from cells and heat lows, rain from the moisture budget with evaporation
/// from the land by Budyko (1974). What `ascent` (empty: level ground) lets rain in one cell the
/// air lacks in the next; rain and evaporation of the whole surface agree every month.
/// Months run in parallel; the same bits for any number of threads.
SeasonalFields solve_seasonal_climate(const Grid& grid, const SeasonalClimate& model,
                                      std::span<const double> latitude_deg,
                                      std::span<const float> land_fraction,
                                      std::span<const float> height_m,
                                      const ReliefAscent& ascent = {});

}  // namespace geo
