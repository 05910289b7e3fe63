#include "geo/kernels/climate/ocean_heat.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/kernels/numerics/area_sum.hpp"
#include "kernels/climate/zonal.hpp"

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

/// What a walk along a closed parallel has met, each cell's part forgotten by its own factor:
/// x <- left(i) x + met(i), the walk's first value such that it comes round to itself. `column`
/// gives the steps of the walk, `left` and `met` are of the cells.
std::vector<double> round_parallel(int nx, const std::function<int(int)>& column,
                                   const std::function<double(int)>& left,
                                   const std::function<double(int)>& met) {
  double once = 0.0, left_over = 1.0;
  for (int step = 0; step < nx; ++step) {
    const int i = column(step);
    once = left(i) * once + met(i);
    left_over *= left(i);
  }
  std::vector<double> before(nx);
  double value = once / (1.0 - left_over);
  for (int step = 0; step < nx; ++step) {
    const int i = column(step);
    before[i] = value;
    value = left(i) * value + met(i);
  }
  return before;
}

/// Share of land that lies against the direction of a walk along a parallel, each cell weighted by
/// exp(-distance / reach), which is `keep` for one cell.
std::vector<double> land_behind(int nx, double keep, const std::function<int(int)>& column,
                                const std::function<double(int)>& land) {
  return round_parallel(
      nx, column, [=](int) { return keep; }, [&](int i) { return (1.0 - keep) * land(i); });
}

/// exp(-distance / reach) to the last coast that a walk has passed.
std::vector<double> nearness_of_coast(int nx, double keep, const std::function<int(int)>& column,
                                      const std::function<double(int)>& land) {
  return round_parallel(
      nx, column, [&](int i) { return (1.0 - land(i)) * keep; }, land);
}

/// The currents of one parallel.
class Parallel {
 public:
  Parallel(const Grid& grid, int row, bool retrograde, std::span<const float> land_fraction)
      : grid_(grid), row_(row), retrograde_(retrograde), land_fraction_(land_fraction) {}

  [[nodiscard]] double land(int i) const { return land_fraction_[grid_.cell(i, row_)]; }

  /// Land to the west of every cell less land to the east of it.
  [[nodiscard]] std::vector<double> land_west_less_east(double reach_km) const {
    std::vector<double> west = walked(true, reach_km, land_behind);
    const std::vector<double> east = walked(false, reach_km, land_behind);
    for (std::size_t i = 0; i < west.size(); ++i) west[i] -= east[i];
    return west;
  }
  [[nodiscard]] std::vector<double> nearness_of_eastern_coast(double reach_km) const {
    return walked(false, reach_km, nearness_of_coast);
  }
  [[nodiscard]] std::vector<double> nearness_of_western_coast(double reach_km) const {
    return walked(true, reach_km, nearness_of_coast);
  }

 private:
  using Walk = std::vector<double> (*)(int, double, const std::function<int(int)>&,
                                       const std::function<double(int)>&);

  /// A walk with the planet's rotation, which is eastward unless that is retrograde, or against it.
  [[nodiscard]] std::vector<double> walked(bool eastward, double reach_km, Walk walk) const {
    const int nx = grid_.nx();
    const bool rising = eastward != retrograde_;
    return walk(
        nx, std::exp(-grid_.spacing_east_m(row_) / (1000.0 * reach_km)),
        [=](int step) { return rising ? step : nx - 1 - step; }, [this](int i) { return land(i); });
  }

  const Grid& grid_;
  int row_;
  bool retrograde_;
  std::span<const float> land_fraction_;
};

/// Currents move heat and make none: what they release too much is taken from all water, and what
/// they take too much is given to it, less and less towards the poles.
void close_budget(const Grid& grid, std::span<const double> latitude_deg,
                  std::span<const float> land_fraction, std::span<double> heat_w_m2) {
  const auto share = [&](Index cell) {
    const double cosine = std::cos(latitude_deg[grid.row(cell)] * kRadians);
    return cosine * cosine * (1.0 - land_fraction[cell]);
  };
  const double water_m2 = area_sum<double>(grid, share);
  if (water_m2 <= 0.0) return;
  const double excess_w_m2 =
      area_sum<double>(grid, [&](Index cell) { return heat_w_m2[cell]; }) / water_m2;
  for (std::size_t cell = 0; cell < heat_w_m2.size(); ++cell) {
    heat_w_m2[cell] -= excess_w_m2 * share(static_cast<Index>(cell));
  }
}

/// Of each column of the equator, how far the winds there are trades.
std::vector<double> share_of_trades(int nx, const EnergyBalance& model, bool retrograde,
                                    std::span<const double> wind_m_s) {
  constexpr double kCalm_m_s = 1.0;
  std::vector<double> share(nx, 1.0);
  for (std::size_t i = 0; i < wind_m_s.size(); ++i) {
    const double forward_m_s = retrograde ? -wind_m_s[i] : wind_m_s[i];
    share[i] = std::clamp((kCalm_m_s - forward_m_s) / model.upwelling_trades_m_s, 0.0, 1.0);
  }
  return share;
}

}  // namespace

void ocean_heat(const Grid& grid, const EnergyBalance& model, bool retrograde,
                std::span<const double> latitude_deg, std::span<const float> land_fraction,
                std::span<double> heat_w_m2, std::span<const double> equatorial_wind_m_s) {
  check_sizes("ocean_heat", grid.ny(), {{"latitude_deg", latitude_deg.size()}});
  check_sizes("ocean_heat", grid.size(),
              {{"land_fraction", land_fraction.size()}, {"heat_w_m2", heat_w_m2.size()}});
  check_sizes("ocean_heat", grid.nx(),
              {{"equatorial_wind_m_s", equatorial_wind_m_s.size(), ArraySize::May::be_empty}});
  const std::vector<double> trades =
      share_of_trades(grid.nx(), model, retrograde, equatorial_wind_m_s);
  const std::vector<double> always(grid.nx(), 1.0);
  constexpr double kHighs_deg = 22.0, kNone = 1e-6;
  for (int j = 0; j < grid.ny(); ++j) {
    const Parallel parallel(grid, j, retrograde, land_fraction);
    const double curl = std::sin(4.0 * std::abs(latitude_deg[j]) * kRadians);
    const bool subtropical = curl > 0.0;
    const double gyre = curl * (subtropical ? model.gyre_heat_w_m2 : model.subpolar_heat_w_m2);
    const auto contrast =
        parallel.land_west_less_east(subtropical ? model.gyre_reach_km : model.subpolar_reach_km);
    for (int i = 0; i < grid.nx(); ++i) {
      heat_w_m2[grid.cell(i, j)] = gyre * contrast[i] * (1.0 - parallel.land(i));
    }
    const double from_equator = latitude_deg[j] / model.upwelling_width_deg;
    const auto upwell = [&](double upwelling_w_m2, double reach_km, std::span<const double> share) {
      if (upwelling_w_m2 < kNone) return;
      const auto east = parallel.nearness_of_eastern_coast(reach_km);
      const auto west = parallel.nearness_of_western_coast(reach_km);
      for (int i = 0; i < grid.nx(); ++i) {
        heat_w_m2[grid.cell(i, j)] -=
            upwelling_w_m2 * share[i] * east[i] * (1.0 - west[i]) * (1.0 - parallel.land(i));
      }
    };
    upwell(model.upwelling_w_m2 * std::exp(-from_equator * from_equator), model.upwelling_reach_km,
           trades);
    const double high = std::clamp(std::abs(latitude_deg[j]) / kHighs_deg, 0.0, 2.0);
    upwell(model.coastal_upwelling_w_m2 * std::pow(std::sin(0.5 * std::numbers::pi * high), 2),
           model.coastal_upwelling_reach_km, always);
  }
  close_budget(grid, latitude_deg, land_fraction, heat_w_m2);
}

std::vector<float> sea_warmth_k(const Grid& grid, const EnergyBalance& model, bool retrograde,
                                std::span<const double> latitude_deg,
                                std::span<const float> land_fraction,
                                std::span<const double> annual_mean_c,
                                std::span<const double> equatorial_wind_m_s) {
  check_sizes("sea_warmth_k", grid.size(), {{"annual_mean_c", annual_mean_c.size()}});
  std::vector<double> heat_w_m2(annual_mean_c.size());
  ocean_heat(grid, model, retrograde, latitude_deg, land_fraction, heat_w_m2, equatorial_wind_m_s);
  std::vector<float> warmer_k(annual_mean_c.size(), 0.0F);
  for (std::size_t cell = 0; cell < warmer_k.size(); ++cell) {
    const double water = 1.0 - land_fraction[cell];
    if (!(water > 0.0)) continue;
    const double open = 1.0 - sea_ice_share(model, annual_mean_c[cell]);
    warmer_k[cell] = static_cast<float>(open * heat_w_m2[cell] / water /
                                        sea_exchange_w_m2_k(model, annual_mean_c[cell]));
  }
  return warmer_k;
}

std::vector<double> open_channels(const Grid& grid, std::span<const double> latitude_deg,
                                  std::span<const float> land_fraction) {
  check_sizes("open_channels", grid.ny(), {{"latitude_deg", latitude_deg.size()}});
  check_sizes("open_channels", grid.size(), {{"land_fraction", land_fraction.size()}});
  constexpr double kReach_deg = 8.0, kGyres_deg = 30.0, kNoGyres_deg = 50.0;
  std::vector<double> open(latitude_deg.size());
  for (int j = 0; j < grid.ny(); ++j) {
    const auto row = land_fraction.subspan(grid.cell(0, j), grid.nx());
    open[j] = std::none_of(row.begin(), row.end(), [](float land) { return land > 0.5F; });
  }
  open = smooth_rows(latitude_deg, open, kReach_deg);
  for (int j = 0; j < grid.ny(); ++j) {
    open[j] *= std::clamp((std::abs(latitude_deg[j]) - kGyres_deg) / (kNoGyres_deg - kGyres_deg),
                          0.0, 1.0);
  }
  return open;
}

}  // namespace geo
