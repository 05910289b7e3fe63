#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/kernels/climate/circulation.hpp"
#include "geo/kernels/climate/energy_balance.hpp"
#include "geo/kernels/climate/moisture.hpp"
#include "geo/kernels/climate/ocean_currents.hpp"
#include "geo/kernels/climate/soil_moisture.hpp"
#include "geo/kernels/climate/stationary_wave.hpp"

namespace geo {

/// Constants of the seasonal climate: energy balance, winds, waves, eddies, moisture.
struct SeasonalClimate {
  EnergyBalance energy;
  Circulation circulation;
  StationaryWave wave;
  OceanCurrents currents;
  MoistureBudget moisture;
  SoilMoisture soil;
  double itcz_share = 0.45;           ///< of the thermal equator's excursion that the cells follow
  double itcz_lag_month = 1;          ///< by which the trough follows the warmth of the air
  double heat_low_lag_month = 0.386;  ///< the same of heat lows and cold highs
  double itcz_locality = 0.0205;  ///< how far the trough follows its meridian's warmest latitude
  double sensible_w_m2_k = 1.99;  ///< heating of the air over ground warmer than its parallel
  double base_diffusivity_m2_s = 1.35e6;
  double eddy_diffusivity_m2_s = 7.17e+05;  ///< at the reference temperature gradient
  double eddy_rain = 0.127;  ///< rain-out by eddies there, whether the mean air rises or sinks
  double eddy_gradient_k_1000km = 4.4;  ///< the reference gradient
  double eddy_exponent = 2.6;           ///< by which their strength grows with the gradient
  double eddy_locality = 0.707;  ///< how far eddies follow the local gradient, not the parallel's
  double gust_m_s = 7.28;        ///< of eddies' winds over the sea at the reference gradient
  double cold_air_heat_j_m2_k = 5.88e+05;  ///< of air that evaporates as the sea warms it
  double ascent_time_d = 30;               ///< convergence over this time multiplies rain-out by e
  double descent_time_d = 1.59;            ///< the same of the descent that stationary waves make
  double ascent_bound = 0.895;             ///< most that ascent adds to the logarithm of rain-out
  double descent_bound = 5.56;             ///< most that descent takes from it
  double eddy_descent_share = 0.114;       ///< of that descent which the rain of eddies feels
  double ascent_latitude_deg = 87;   ///< at which converging winds make half as much rain as where
                                     ///< rotation is weak
  double ascent_smoothing_km = 746;  ///< over which ascent is felt
  double convection_1_k = 0.0105;    ///< growth of rain-out with excess moist static energy
  double sea_convection_1_k = 0.0482;     ///< the same with sea that is warmer than the air
  double sea_low_hpa_k = 0.0278;          ///< of the air over such sea
  double convection_latitude_deg = 50.6;  ///< to which the free atmosphere is level
  double orographic_share = 0.0128;       ///< of the mean height by which air is lifted over a cell
  double blocking_height_m = 822;         ///< height at which topography halves the moist flow
  double turned_share = 0.595;  ///< of what it holds back, which turns aside; the rest rises
  double land_drag = 3.57;      ///< on the wind over land, over the damping of the internal mode
  double land_transpiration = 1.0;  ///< share of the soil's evaporation that returns to the air
};

/// Water that passes between a surface and its air, m3 s-1 over the year. The two sides are summed
/// each by itself, and agree as far as the moisture budget was solved.
struct AirWater {
  double sea_evaporation_m3_s = 0.0, land_evaporation_m3_s = 0.0;
  double precipitation_m3_s = 0.0;
};

/// Fields of a coarse grid, one value per cell, for each month.
struct SeasonalFields {
  using Monthly = std::array<std::vector<float>, kMonths>;
  Monthly temperature_c;     ///< at sea level
  Monthly precipitation_mm;  ///< per month
  Monthly wind_east, wind_north;
  AirWater water;
};

/// From the annual mean winds, east and north, how many times more than over level ground the air
/// over each cell rains out, given that its topography lifts it here and lets it sink there.
using TerrainAscent = std::function<std::vector<float>(std::span<const float> wind_east,
                                                       std::span<const float> wind_north)>;

/// Twelve months of climate of a sphere or torus from its topography. Temperature at sea level
/// comes from the energy balance; land is warmer where its soil is dry, and snow in the polar night
/// colder than the air above it (Connolley 1996), by
///   max(0, 1 - Q / Q_mixed) snow(T) (k + g max(0, -10 degC - T)),
/// Q the insolation, T the air's temperature at the ground, k, g and Q_mixed the inversion's
/// constants of EnergyBalance. Pressure comes from the meridional cells about the thermal equator,
/// heat lows and the stationary waves that latent heat and warm land set up, and the drag of land,
/// which turns winds aside. Winds balance it with friction, and mountains turn them
/// (MountainBarrier). Where currents bring the sea heat it is
/// warmer than the air (sea_warmth_k): this adds to what evaporates, to the heating of the air
/// above, to convection, and to the temperature gradients that eddies feel, and makes a shallow
/// low. Evaporation from the sea grows with the speed of the wind, and where that comes from the
/// cold. Winds carry moisture, and so do eddies, which are strongest where temperature gradients
/// are steepest. It rains where air is humid, rises, or has more moist static energy than the free
/// atmosphere of the tropics; soil returns a part of the rain to the air. Waves and rain are
/// iterated together. What `ascent` (empty: level ground) lets rain out over one cell the air lacks
/// over the next; rain and evaporation of the whole surface agree every month. Months run in
/// parallel; the same bits for any number of threads. `latitude_deg`: one value per row, from south
/// to north; the others one per cell, `glacier_fraction` (of the cell's land that ice covers) or
/// none; Bug otherwise.
SeasonalFields solve_seasonal_climate(const Grid& grid, const SeasonalClimate& model,
                                      std::span<const double> latitude_deg,
                                      std::span<const float> land_fraction,
                                      std::span<const float> height_m,
                                      const TerrainAscent& ascent = {},
                                      std::span<const float> glacier_fraction = {});

}  // namespace geo
