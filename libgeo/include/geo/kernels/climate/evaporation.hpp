#pragma once

#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Share of the water supply that evaporates, E/P at dryness phi = PET/P (Budyko 1974):
///   E/P = sqrt(phi tanh(1/phi) (1 - exp(-phi))).
[[nodiscard]] double budyko_evaporated_share(double dryness);

/// Potential evapotranspiration of Oudin et al. (2005), mm d-1: Q (T + 5) / 100 over the heat that
/// a millimetre of water takes up, 0 below -5 degC.
/// @param insolation_w_m2  at the top of the atmosphere
[[nodiscard]] double oudin_evaporation_mm_d(double insolation_w_m2, double temperature_c);

/// How many times the sunlight under half a sky of clouds reaches the ground of a climate with a
/// year's rain P and, under that sky, potential evapotranspiration PET: (0.25 + 0.5 n) / 0.5
/// (Angstrom 1924), where the sun shines for a share n = 0.35 + 0.55 exp(-P / PET)
/// of the day: 0.9 of it in deserts, about 0.5 over rainforests. 1 where PET is 0.
[[nodiscard]] double clearness(double precipitation_mm, double potential_mm);

/// Speed of the air over the sea, m s-1, as evaporation feels it (Fairall et al. 2003): that of the
/// mean wind, of eddies, and of the gusts that there are in calm air,
///   sqrt(u^2 + v^2 + eddies^2 + 4^2).
[[nodiscard]] double wind_over_sea_m_s(double east_m_s, double north_m_s, double eddies_m_s);

/// How fast the air of each cell would cool because it comes from colder places, K s-1: u . grad T,
/// upwind, and 0 where it comes from warmer ones. Arrays have one value per cell; Bug otherwise.
[[nodiscard]] std::vector<float> cold_advection_k_s(const Grid& grid,
                                                    std::span<const float> temperature_c,
                                                    std::span<const float> wind_east,
                                                    std::span<const float> wind_north);

}  // namespace geo
