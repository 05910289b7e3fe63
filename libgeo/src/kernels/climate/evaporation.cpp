#include "geo/kernels/climate/evaporation.hpp"

#include <algorithm>
#include <cmath>

namespace geo {

double budyko_evaporated_share(double dryness) {
  if (!(dryness > 0.0)) return 0.0;
  return std::sqrt(dryness * std::tanh(1.0 / dryness) * -std::expm1(-dryness));
}

double oudin_evaporation_mm_d(double insolation_w_m2, double temperature_c) {
  constexpr double kSecondsPerDay = 86400.0, kLatentHeat_j_kg = 2.45e6;
  return insolation_w_m2 * kSecondsPerDay / kLatentHeat_j_kg * std::max(0.0, temperature_c + 5.0) /
         100.0;
}

double clearness(double precipitation_mm, double potential_mm) {
  if (!(potential_mm > 0.0)) return 1.0;
  const double sunshine = 0.35 + 0.55 * std::exp(-precipitation_mm / potential_mm);
  return (0.25 + 0.5 * sunshine) / 0.5;
}

}  // namespace geo
