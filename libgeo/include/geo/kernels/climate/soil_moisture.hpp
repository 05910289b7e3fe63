#pragma once

#include <array>

#include "geo/kernels/climate/insolation.hpp"

namespace geo {

/// Water that soil and snow hold from month to month (the bucket of Manabe 1969).
struct SoilMoisture {
  double capacity_mm = 175;
  double stressed_share = 1;      ///< of it, below which evaporation falls with the soil's water
  double melt_mm_k_month = 90.0;  ///< snow that melts per kelvin above freezing
};

/// Evaporation of each month, mm, of a year that repeats itself: water in soil and snow follows
/// rain, melt and evaporation, and what exceeds the capacity runs off. Snow falls where the
/// month's mean lies below -1 degC, rain above 3 degC, both between. The sum over the year is at
/// most that of precipitation.
[[nodiscard]] std::array<double, kMonths> soil_evaporation_mm(
    const SoilMoisture& model, const std::array<double, kMonths>& temperature_c,
    const std::array<double, kMonths>& precipitation_mm,
    const std::array<double, kMonths>& potential_mm);

}  // namespace geo
