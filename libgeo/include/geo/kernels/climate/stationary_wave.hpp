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
  WaveMode internal{109, 3.32, 11, 0};
  double heating_m4_s3_w = 0.000106;  ///< fall of the lower geopotential by 1 W m-2
  /// What mountains set up: the external mode, nearly the same at all heights.
  WaveMode external{200.0, 28.7, 20.0, 0.39};
  double mountain_share = 0.0172;  ///< of the height of mountains that the flow goes over
  double smoothing_km = 291;       ///< waves shorter than this are damped out of both
  int waves = 24;                  ///< zonal wave numbers 1 to this
};

/// What sets waves up, one value per cell.
struct WaveForcing {
  std::span<const float> heating_w_m2;
  std::span<const float> force_east, force_north;  ///< on the lower layer, m s-2
  std::span<const float> height_m;                 ///< of mountains
};

/// Winds of the waves near the ground, one value per cell.
struct WaveWinds {
  std::span<float> east, north;  ///< of both modes together, m s-1
  /// Horizontal divergence that the waves of the internal mode make apart from heating's own:
  /// -(e_T + U d/dx) P / c^2, positive where air sinks.
  std::span<float> descent_1_s;
};

/// Steady, damped, linear response of the lower layer of a rotating atmosphere to heating Q
/// (Matsuno 1966, Gill 1980), to a force (X, Y) on it, such as the drag of rough ground, and to
/// mountains of height h (Held 1983) on the sphere, about a zonal wind U(latitude). For each of the
/// two modes
///   (e + U d/dx) u - f v = -dP/dx + X,   (e + U d/dx) v + f u = -dP/dy + Y,
///   (e_T + U d/dx) P + c^2 div(u, v) = -q Q   or   g U dh/dx,
/// P the geopotential near the ground. Heating and forces act on the internal mode, mountains on
/// the external one. Heating lowers P: air converges below, and waves carry the low to the west,
/// polewards of it, and eastwards along the equator. Where the wind is held back, pressure rises
/// before that place, and air goes round it. Where westerlies climb, pressure rises, and a trough
/// lies behind. Longitudes by Fourier components, each a tridiagonal system in latitude
/// (second-order differences, poles crossed by symmetry). The zonal means of heating, force and
/// height are left out. Cost: linear in cells times waves.
/// @param rotation_rad_s     of the planet, negative if retrograde
/// @param latitude_deg, zonal_wind_m_s   per row, evenly spaced from pole to pole
/// @param forcing, winds     row-major from the southernmost row
/// Throws Bug unless the grid is a sphere and there is one value per row or cell.
void stationary_wave(const Grid& grid, const StationaryWave& model, double rotation_rad_s,
                     std::span<const double> latitude_deg, std::span<const double> zonal_wind_m_s,
                     const WaveForcing& forcing, const WaveWinds& winds);

}  // namespace geo
