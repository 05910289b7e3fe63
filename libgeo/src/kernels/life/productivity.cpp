#include "geo/kernels/life/productivity.hpp"

#include <algorithm>
#include <cmath>

namespace geo {

double miami_productivity(double temperature_c, double precipitation_mm_yr) {
  const double warmth = 3000.0 / (1.0 + std::exp(1.315 - 0.119 * temperature_c));
  const double water = -3000.0 * std::expm1(-0.000664 * std::max(precipitation_mm_yr, 0.0));
  return std::min(warmth, water);
}

double altitude_factor(double elevation_m) {
  return std::clamp(1.0 - (elevation_m - 500.0) / 4000.0, 0.0, 1.0);
}

}  // namespace geo
