#include "geo/kernels/climate/ocean_heat.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "geo/core/array_sizes.hpp"

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

/// Share of land that lies against the direction of a walk along a parallel, each cell weighted by
/// exp(-distance / reach). `column` gives the steps of the walk.
template <class Column, class Land>
std::vector<double> land_behind(int nx, double keep, Column&& column, Land&& land) {
  std::vector<double> share(nx);
  double behind = 0.0;
  // The second turn round the parallel starts from what the first one found.
  for (int step = 0; step < 2 * nx; ++step) {
    const int i = column(step % nx);
    share[i] = behind;
    behind = keep * behind + (1.0 - keep) * land(i);
  }
  return share;
}

/// exp(-distance / reach) to the last coast that a walk has passed.
template <class Column, class Land>
std::vector<double> nearness_of_coast(int nx, double keep, Column&& column, Land&& land) {
  std::vector<double> nearness(nx);
  double near = 0.0;
  for (int step = 0; step < 2 * nx; ++step) {
    const int i = column(step % nx);
    nearness[i] = near;
    near = land(i) + (1.0 - land(i)) * keep * near;
  }
  return nearness;
}

}  // namespace

void ocean_heat(const Grid& grid, const EnergyBalance& model, bool retrograde,
                std::span<const double> latitude_deg, std::span<const float> land_fraction,
                std::span<double> heat_w_m2) {
  check_sizes("ocean_heat", grid.ny(), {{"latitude_deg", latitude_deg.size()}});
  check_sizes("ocean_heat", grid.size(),
              {{"land_fraction", land_fraction.size()}, {"heat_w_m2", heat_w_m2.size()}});
  constexpr double kUpwelling_deg = 5.0, kNone = 1e-6;
  const int nx = grid.nx();
  const auto eastward = [](int step) { return step; };
  const auto westward = [nx](int step) { return nx - 1 - step; };
  for (int j = 0; j < grid.ny(); ++j) {
    const auto land = [&](int i) { return land_fraction[grid.cell(i, j)]; };
    const auto kept = [&](double reach_km) {
      return std::exp(-grid.spacing_east_m(j) / (1000.0 * reach_km));
    };
    const double keep = kept(model.gyre_reach_km);
    const auto west = land_behind(nx, keep, eastward, land);
    const auto east = land_behind(nx, keep, westward, land);
    const double gyre = (retrograde ? -1.0 : 1.0) * model.gyre_heat_w_m2 *
                        std::cos(2.0 * latitude_deg[j] * kRadians);
    for (int i = 0; i < nx; ++i) {
      heat_w_m2[grid.cell(i, j)] = gyre * (west[i] - east[i]) * (1.0 - land(i));
    }
    const double from_equator = latitude_deg[j] / kUpwelling_deg;
    const double upwelling = model.upwelling_w_m2 * std::exp(-from_equator * from_equator);
    if (upwelling < kNone) continue;
    const double far = kept(model.upwelling_reach_km);
    const auto coast = retrograde ? nearness_of_coast(nx, far, eastward, land)
                                  : nearness_of_coast(nx, far, westward, land);
    for (int i = 0; i < nx; ++i) {
      heat_w_m2[grid.cell(i, j)] -= upwelling * coast[i] * (1.0 - land(i));
    }
  }
}

}  // namespace geo
