#pragma once

#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Direction of the three-cell winds at a latitude, as where the air goes: easterlies to 30 deg,
/// westerlies to 60 deg, polar easterlies beyond, blended linearly over `blend_deg` centred on each
/// boundary; `north` is the part that friction turns towards low pressure, 0.35 |sin(lat)| (towards
/// the equator in easterlies, away from it in westerlies). Peixoto & Oort (1992).
struct WindDirection {
  double east, north;
};
[[nodiscard]] WindDirection three_cell_wind(double latitude_deg, double deflection = 0.35,
                                            double blend_deg = 10.0);

/// Near-surface winds from pressure with linear drag (Lindzen & Nigam 1987):
///   r u - f v = -dp/dx / rho,   r v + f u = -dp/dy / rho.
struct Circulation {
  double rotation_period_h = 23.934;
  bool retrograde = false;
  double air_density_kg_m3 = 1.2;
  double drag_ocean_s = 2.34e-05;  ///< r over the sea, s-1
  double drag_land_s = 2.61e-05;
  double displacement_decay = 6;       ///< exponent p of the cells' displacement with the trough
  double subtropical_high_hpa = 4.86;  ///< above the equatorial trough
  double subpolar_low_hpa = 5.69;      ///< below the subtropical high
  double polar_high_hpa = 2.02;        ///< above the subpolar low
  double cell_mixing_km = 371;       ///< L, over which eddies mix the momentum of the cells' winds
  double overturning_share = 0.249;  ///< of the cells' meridional wind, as it turns back aloft
  double thermal_low_hpa_k = 0.328;  ///< fall of pressure per kelvin of heat anomaly
  double cold_high_share = 1.19;     ///< of it, where the anomaly is cold and shallow

  /// Angular velocity, negative if retrograde.
  [[nodiscard]] double rotation_rad_s() const;
  /// How much wider the cells are than the Earth's: as the root of the length of the day
  /// (Held 2000), until one cell reaches the pole.
  [[nodiscard]] double cell_width() const;
};

/// Pressure of the three cells at a latitude, hPa relative to the equatorial trough: half cosines
/// between the trough, the high at 30, the low at 60 and the high at 90 deg; wider cells end at
/// the pole, narrower ones are followed by more, like the polar one.
/// Cells follow the trough through the year, the subtropical highs by a part of its excursion, the
/// pole not at all: what lies x of the way from the trough to a pole is displaced by
/// trough (1 - x)^p.
/// @param trough_deg  latitude of the trough
[[nodiscard]] double three_cell_pressure_hpa(double latitude_deg, const Circulation& model,
                                             double trough_deg = 0.0);

/// Winds of the cells, m s-1, one value per row, where the air goes: means over the moist layer.
struct CellWinds {
  std::vector<double> east, north;
};
/// Those that balance the cells' pressure p on a sphere, with drag r as over the sea, while eddies
/// mix momentum over the distance L:
///   r u - f v = r L^2 u'',   r v + f u = -p' / rho + r L^2 v''   (' = d/dy).
/// So trades blow at the equator too, where pressure and rotation alone would leave a calm. In the
/// moist layer the zonal wind changes little with height, but the meridional wind turns back above
/// the boundary layer (Peixoto & Oort 1992): v counts by its overturning share. O(rows).
/// @param latitude_deg, pressure_hpa  per row. Throws Bug where sizes differ.
[[nodiscard]] CellWinds cell_winds(const Grid& grid, const Circulation& model,
                                   std::span<const double> latitude_deg,
                                   std::span<const double> pressure_hpa);

/// Winds of one month on a sphere or torus.
/// @param latitude_deg     per row
/// @param pressure_hpa     per cell
/// @param[out] wind_east, wind_north  m s-1, where the air goes
/// Throws Bug where sizes differ.
void balanced_winds(const Grid& grid, const Circulation& model,
                    std::span<const double> latitude_deg, std::span<const float> land_fraction,
                    std::span<const float> pressure_hpa, std::span<float> wind_east,
                    std::span<float> wind_north);

}  // namespace geo
