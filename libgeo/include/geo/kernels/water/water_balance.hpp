#pragma once

#include <cstdint>
#include <span>

#include "geo/core/grid.hpp"

namespace geo {

inline constexpr double kSecondsPerYear = 365.25 * 86400.0;

/// Evaporation from land, mm/yr, of a climate with precipitation P and potential evapotranspiration
/// PET: Budyko's share of P (see evaporation.hpp). Never above P or PET.
double land_evaporation(double precipitation_mm_yr, double potential_mm_yr);

/// Sums of a water balance over land, m3/s.
struct LandWater {
  double precipitation_m3_s = 0.0;
  double evaporation_m3_s = 0.0;
};

/// What each land cell yields, P - E >= 0, and what it would lose beside that if it were flooded,
/// PET - E >= 0 (so that its balance becomes P - PET); both in m3/s over the cell's true area, 0
/// where `sea` is non-zero. Shapes: one value per cell. Cost: linear, threaded over rows.
/// Arrays have one value per cell (`check_sizes`); Bug otherwise.
LandWater land_water(const Grid& grid, std::span<const std::uint8_t> sea,
                     std::span<const float> precipitation_mm_yr,
                     std::span<const float> potential_mm_yr, std::span<double> runoff_m3_s,
                     std::span<float> flooding_loss_m3_s);

}  // namespace geo
