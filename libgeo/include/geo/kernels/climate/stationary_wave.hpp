#pragma once

#include <span>

#include "geo/core/grid.hpp"

namespace geo {

/// Waves of one vertical structure.
struct WaveMode {
  double speed_m_s;           ///< c of free gravity waves
  double momentum_damping_d;  ///< 1 / e
  double thermal_damping_d;   ///< 1 / e_T
  double wind_share;          ///< of the given zonal wind that carries the waves along
};

/// Constants of the response of an atmosphere to stationary heating and mountains.
struct StationaryWave {
  /// What heating sets up: the first baroclinic mode, whose winds turn with height.
  WaveMode internal{88.6, 4.35, 8.48, 0};
  double heating_m4_s3_w = 6.02e-05;  ///< fall of the lower geopotential by 1 W m-2
  /// What mountains set up: the external mode, nearly the same at all heights.
  WaveMode external{200.0, 39.5, 20.0, 0.485};
  double mountain_share = 0.0216;  ///< of the height of mountains that the flow goes over
  double smoothing_km = 74.2;      ///< waves shorter than this are damped out of both
  int waves = 24;                  ///< zonal wave numbers 1 to this
};

/// Steady, damped, linear response of the lower layer of a rotating atmosphere to heating Q
/// (Matsuno 1966, Gill 1980) and to mountains of height h (Held 1983) on the sphere, about a zonal
/// wind U(latitude). For each of the two modes
///   (e + U d/dx) u - f v = -dP/dx,   (e + U d/dx) v + f u = -dP/dy,
///   (e_T + U d/dx) P + c^2 div(u, v) = -q Q   or   g U dh/dx,
/// P the geopotential near the ground. Heating lowers it: air converges below, and waves carry the
/// low to the west, polewards of it, and eastwards along the equator. Where westerlies climb,
/// pressure rises, and a trough lies behind. Longitudes by Fourier components, each a tridiagonal
/// system in latitude (second-order differences, poles crossed by symmetry). The zonal means of
/// heating and height are left out. Cost: linear in cells times waves.
/// @param rotation_rad_s     of the planet, negative if retrograde
/// @param latitude_deg, zonal_wind_m_s   per row, evenly spaced from pole to pole
/// @param heating_w_m2, height_m   per cell, row-major from the southernmost row
/// @param[out] wind_east, wind_north   u and v of both modes together, m s-1
/// @param[out] descent_1_s   horizontal divergence near the ground that the waves of heating make
///                           apart from heating's own: -(e_T + U d/dx) P / c^2, positive where air
///                           sinks
/// Throws Bug unless the grid is a sphere.
void stationary_wave(const Grid& grid, const StationaryWave& model, double rotation_rad_s,
                     std::span<const double> latitude_deg, std::span<const double> zonal_wind_m_s,
                     std::span<const float> heating_w_m2, std::span<const float> height_m,
                     std::span<float> wind_east, std::span<float> wind_north,
                     std::span<float> descent_1_s);

}  // namespace geo
