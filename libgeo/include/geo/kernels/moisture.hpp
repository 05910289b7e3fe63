#pragma once

#include <cstdint>
#include <span>

#include "geo/core/grid.hpp"

namespace geo {

/// Constants of the moisture budget.
struct MoistureBudget {
  double rain_time_d = 0.77;           ///< rain-out time of a saturated column
  std::int64_t humidity_exponent = 4;  ///< how sharply rain follows the column's relative humidity
  double evaporation_velocity_1_d = 0.25;  ///< v over open water that energy does not limit
  double evaporating_share = 0.95;         ///< of the annual insolation, at most
  int sweeps = 30;
};

/// Steady moisture budget of the air column on a sphere or torus:
///   div(u W - K grad W) = E - P,   P = e W (W/W_s)^n / tau,   E = water v (W_s - W)+ + land part,
/// W column water (mm), W_s what the column holds at saturation, e the activity of eddies. Finite
/// volumes, upwind; nonlinear Gauss-Seidel in four alternating directions. Sequential: seasons
/// are independent and run side by side.
///
/// @param open_water_1_d   v times the fraction of water, per cell
/// @param land_evaporation mm d-1 per cell (averaged over the cell)
/// @param column_mm        in: first guess; out: W
struct MoistureSeason {
  std::span<const float> wind_east, wind_north;  ///< m s-1
  std::span<const float> diffusivity;            ///< K, m2 s-1
  std::span<const float> eddy_activity;          ///< e
  std::span<const float> saturated_mm;           ///< W_s
  std::span<const float> open_water_1_d;
  std::span<const float> land_evaporation;  ///< mm d-1
};
void solve_moisture(const Grid& grid, const MoistureBudget& model, const MoistureSeason& season,
                    std::span<double> column_mm);

/// Rain of a column, mm d-1.
[[nodiscard]] double rain_mm_d(const MoistureBudget& model, double column_mm, double saturated_mm,
                               double eddy_activity);

}  // namespace geo
