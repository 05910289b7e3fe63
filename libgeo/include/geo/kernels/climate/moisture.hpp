#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Constants of the moisture budget.
struct MoistureBudget {
  double rain_time_d = 6.2;            ///< rain-out time of a saturated column
  std::int64_t humidity_exponent = 2;  ///< how sharply rain follows the column's relative humidity
  double evaporation_velocity_1_d = 1.56;  ///< v under 8 m s-1 where energy does not limit it
  double evaporating_share = 0.95;         ///< of the annual insolation, at most
  int sweeps = 44;
};

/// One season's air; spans of one value per cell.
struct MoistureSeason {
  std::span<const float> wind_east, wind_north;  ///< u, m s-1
  std::span<const float> diffusivity;            ///< K, m2 s-1
  std::span<const float> activity;               ///< a, of ascent
  std::span<const float> eddies;                 ///< e
  std::span<const float> saturated_mm;           ///< W_s
  std::span<const float> open_water_1_d;         ///< v times the fraction of water
  /// mm d-1, averaged over the cell: that of land, and of the sea under cold air.
  std::span<const float> land_evaporation;
  std::span<double> column_mm;  ///< in: first guess; out: W
};

/// Steady moisture budgets of the air column on a sphere or torus:
///   div(u W - K grad W) = E - P,   P = W (a (W/W_s)^n + e W/W_s) / tau,
///   E = water v (W_s - W)+ + what land, and the sea under cold air, give whatever W is,
/// W column water (mm), W_s what the column holds at saturation, a the activity of large-scale
/// ascent, whose rain grows steeply with relative humidity, and e that of eddies, which lift moist
/// air of their own wherever they are. Finite volumes, upwind; nonlinear Gauss-Seidel in four
/// alternating directions, which leaves some thousandths of the water unaccounted for, then
/// Newton's method with a sparse solver, which leaves none. Sequential: seasons are independent, a
/// few are swept side by side in the lanes of vector registers, and more by threads. Bits do not
/// depend on which seasons are solved together.
class SteadyMoisture {
 public:
  static constexpr int kSeasons = 4;

  /// Of one to kSeasons seasons, which stay where they are; what moves water and makes it rain is
  /// taken over now, evaporation from land and the columns when solved.
  /// Throws Bug where an array has not one value per cell.
  SteadyMoisture(const Grid& grid, const MoistureBudget& model,
                 std::span<const MoistureSeason> seasons);
  /// Gauss-Seidel alone: near enough while evaporation from land is still sought.
  void solve();
  /// Newton's method for one season, from the column that it has. All that evaporates rains: the
  /// sum of |E - P - div| over the cells is at most `closed` of the rain. Different seasons may be
  /// closed at the same time.
  void close(std::size_t lane, double closed = 1e-7) const;

 private:
  /// A value of each season.
  struct alignas(16) Lanes : std::array<float, kSeasons> {};
  struct alignas(32) DoubleLanes : std::array<double, kSeasons> {};
  /// Exchange of one cell with its neighbours, per day: out W_here - sum from_k W_k; and its air.
  struct Air {
    DoubleLanes rain_rate_1_d, eddy_rate_1_d, out, from_east, from_west, from_north, from_south;
    Lanes saturated_mm, open_water_1_d;
  };
  struct Field;

  [[nodiscard]] const MoistureSeason& season(int lane) const;
  void take_exchange(int lane);
  static void sweep(const Field& field, bool northward, bool eastward);

  const Grid& grid_;
  MoistureBudget model_;
  std::vector<MoistureSeason> seasons_;
  std::vector<Air> air_;
  std::vector<DoubleLanes> land_evaporation_, column_;
};

/// Water that the sea gives to a column, mm d-1.
[[nodiscard]] double sea_evaporation_mm_d(double column_mm, double saturated_mm,
                                          double open_water_1_d);

/// Rain of a column, mm d-1.
[[nodiscard]] double rain_mm_d(const MoistureBudget& model, double column_mm, double saturated_mm,
                               double activity, double eddies);

}  // namespace geo
