#pragma once

#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/kernels/climate/circulation.hpp"

/// What parallels and meridians say of one month: means, thermal wind, trough, eddies.
namespace geo {

template <class T>
std::vector<double> row_means(const Grid& grid, std::span<const T> values) {
  std::vector<double> means(grid.ny(), 0.0);
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) means[j] += values[grid.cell(i, j)];
    means[j] /= grid.nx();
  }
  return means;
}

/// Mean of the rows within `reach_deg` of each, weighted by their length.
std::vector<double> smooth_rows(std::span<const double> latitude_deg,
                                std::span<const double> values, double reach_deg);

/// Annual mean wind near the ground that the Hadley cells' pressure makes over the sea, eastwards.
double trade_wind_m_s(double latitude_deg, const Circulation& model, double radius_m);

/// Zonal wind half-way up the troposphere over that near the ground, per row: the thermal wind of
/// the zonal mean temperature, held down within some 10 degrees of the equator.
std::vector<double> thermal_wind_m_s(const Grid& grid, const Circulation& model,
                                     std::span<const double> latitude_deg,
                                     std::span<const double> zonal_temperature_c);

/// Latitude of the warmest parallels, weighted by exp(T / 1.5 K), for each meridian: `locality`
/// (0 to 1) of the way from the zonal mean's to its own surroundings' (a quarter of the globe).
std::vector<double> trough_latitudes_deg(const Grid& grid, std::span<const double> latitude_deg,
                                         std::span<const float> temperature_c,
                                         std::span<const double> zonal_temperature_c,
                                         double locality);

/// Strength of eddies: the temperature gradient over some 10 degrees as a share of the reference
/// one, `locality` of it the cell's own, the rest the parallel's, to the power `exponent`.
std::vector<float> eddy_strength(const Grid& grid, std::span<const double> latitude_deg,
                                 std::span<const float> temperature_c,
                                 std::span<const double> zonal_temperature_c,
                                 double reference_k_1000km, double exponent, double locality);

/// Horizontal convergence of the winds, s-1, from face-normal velocities.
std::vector<float> convergence(const Grid& grid, std::span<const float> wind_east,
                               std::span<const float> wind_north);

}  // namespace geo
