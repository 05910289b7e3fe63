#pragma once

#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

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
