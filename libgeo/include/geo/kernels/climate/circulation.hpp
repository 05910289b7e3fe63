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
  double drag_ocean_s = 2.29e-05;  ///< r over the sea, s-1
  double drag_land_s = 3.37e-05;
  double displacement_decay = 6;       ///< exponent p of the cells' displacement with the trough
  double subtropical_high_hpa = 3.84;  ///< above the equatorial trough
  double cell_mixing_km = 283;       ///< L, over which eddies mix the momentum of the cells' winds
  double overturning_share = 0.23;   ///< of the cells' meridional wind, as it turns back aloft
  double eddy_wind_m_s = 11.0;       ///< U_0, driven by a source of 1 that does not spread
  double eddy_reach_deg = 33.1;      ///< over which eddies spread before they break, on the Earth
  double stability_1_k = 0.0353;     ///< growth of static stability per kelvin, below 10 C
  double thermal_low_hpa_k = 0.328;  ///< fall of pressure per kelvin of heat anomaly
  double cold_high_share = 1.04;     ///< of it, where the anomaly is cold and shallow

  /// Angular velocity, negative if retrograde.
  [[nodiscard]] double rotation_rad_s() const;
  /// How much wider the cells are than the Earth's: as the root of the length of the day
  /// (Held 2000), until one cell reaches the pole.
  [[nodiscard]] double cell_width() const;
};

/// Pressure that the Hadley cells make at a latitude, hPa relative to the equatorial trough: a half
/// cosine from the trough to the subtropical high at 30 deg, or where wider cells end, and level
/// beyond, where it is the eddies that drive the wind.
/// Cells follow the trough through the year, the subtropical highs by a part of its excursion, the
/// pole not at all: what lies x of the way from the trough to a pole is displaced by
/// trough (1 - x)^p.
/// @param trough_deg  latitude of the trough
[[nodiscard]] double hadley_pressure_hpa(double latitude_deg, const Circulation& model,
                                         double trough_deg = 0.0);

/// Westerlies that eddies drive, m s-1 along the planet's rotation, one value per row. Baroclinic
/// eddies are Rossby waves above: they leave where the ground's temperature falls off towards the
/// pole, by the upward part S of the Eliassen-Palm flux (Edmon, Hoskins & McIntyre 1980), and break
/// some distance L away. Momentum converges where they leave and is lacking where they break:
///   S = h |f T'| exp(s min(T - 10 C, 0)) / (2 Omega_E 5 K per 1000 km),   d U = U_0 (S - B),
///   B - L^2 (cos^2 B')' / cos^2 = S   (' = d/dy),
/// which adds nothing to the planet's angular momentum. T' over some 16 degrees, as wide as an
/// eddy; cold air is stable, which holds them back; Hadley cells end where eddies begin (Held
/// 2000): h grows from 0 at the equator to 1 there with the fourth power of latitude; d is how much
/// rougher a parallel is than the sea. L widens with the cells. O(rows).
/// @param latitude_deg, zonal_temperature_c, roughness  per row, evenly spaced from pole to pole.
/// Throws Bug where sizes differ.
[[nodiscard]] std::vector<double> eddy_driven_wind_m_s(const Grid& grid, const Circulation& model,
                                                       std::span<const double> latitude_deg,
                                                       std::span<const double> zonal_temperature_c,
                                                       std::span<const double> roughness);

/// Winds of the cells, m s-1, one value per row, where the air goes: means over the moist layer.
struct CellWinds {
  std::vector<double> east, north;
};
/// Those that balance the cells' pressure p on a sphere, with drag r as over the sea, while eddies
/// mix momentum over the distance L:
///   r u - f v = r L^2 u'',   r v + f u = -p' / rho + f U + r L^2 v''   (' = d/dy).
/// U is the wind that eddies drive: pressure comes to balance it, as well as rotation does.
/// So trades blow at the equator too, where pressure and rotation alone would leave a calm. In the
/// moist layer the zonal wind changes little with height, but the meridional wind turns back above
/// the boundary layer (Peixoto & Oort 1992): v counts by its overturning share. O(rows).
/// @param latitude_deg, pressure_hpa, eddy_driven_m_s  per row. Throws Bug where sizes differ.
[[nodiscard]] CellWinds cell_winds(const Grid& grid, const Circulation& model,
                                   std::span<const double> latitude_deg,
                                   std::span<const double> pressure_hpa,
                                   std::span<const double> eddy_driven_m_s);

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
