#pragma once

#include <span>

#include "geo/core/grid.hpp"

namespace geo {

/// Constants of the wind-driven circulation of the sea.
struct OceanCurrents {
  double drag_coefficient = 1.3e-3;  ///< of the wind over water (Large & Pond 1981)
  double air_density_kg_m3 = 1.2;
  double water_density_kg_m3 = 1027.0;
  double friction_1_s = 1e-6;  ///< r: western boundary currents are some r / beta wide
  double layer_m = 500.0;      ///< H: depth of the water that moves, above the thermocline
};

/// Stress of a wind on water, Pa, along the wind: rho_a C_d |u| u.
struct WindStress {
  double east_pa, north_pa;
};
[[nodiscard]] WindStress wind_stress(const OceanCurrents& model, double wind_east_m_s,
                                     double wind_north_m_s);

/// Steady currents of a sea of even depth under a mean wind stress, with Sverdrup's balance in the
/// interior of oceans and Stommel's western boundary currents: transports U = (-dPsi/dy, dPsi/dx),
///   div(r grad Psi) + beta dPsi/dx = curl(stress) / rho,   velocity U / H,
/// beta = df/dy (Sverdrup 1947, Stommel 1948). On land r is so large that Psi is the same all round
/// a coast, and as the equation is that of the momentum of all water, each island takes the value
/// that the circulation around it sets (the island rule, Godfrey 1989). Where no land stands in the
/// way, wind and friction balance along the whole parallel. Finite volumes, beta's term upwind; one
/// sparse system, solved directly. Ekman transport and density-driven flow are left out. Near a
/// pole, where cells are narrower than they are high, velocities are means over several. Cost: a
/// direct solver's, as cells to the power 1.5; 0.1 s at 2 degrees, 5 s at half a degree.
///
/// Shapes: latitude_deg one per row; all else one per cell, row-major from the southernmost row.
/// @param rotation_rad_s                   of the planet, negative if retrograde
/// @param stress_east_pa, stress_north_pa  on the water, mean over the year
/// @param[out] current_east_m_s, current_north_m_s  0 on land
/// Throws Bug where sizes differ or the grid is no sphere.
void ocean_currents(const Grid& grid, const OceanCurrents& model, double rotation_rad_s,
                    std::span<const double> latitude_deg, std::span<const float> land_fraction,
                    std::span<const double> stress_east_pa, std::span<const double> stress_north_pa,
                    std::span<float> current_east_m_s, std::span<float> current_north_m_s);

}  // namespace geo
