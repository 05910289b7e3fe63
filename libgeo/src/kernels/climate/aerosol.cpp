#include "geo/kernels/climate/aerosol.hpp"

#include <algorithm>
#include <cmath>

namespace geo {
namespace {

/// Answer of one heat capacity to a forcing that decays: L / (L - R) (e^(-t/L) - e^(-t/R)).
double response(double lifetime, double relaxation, double t) {
  const double ratio = relaxation / lifetime;
  if (std::abs(ratio - 1.0) < 1e-6) return t / lifetime * std::exp(-t / lifetime);
  return (std::exp(-t / lifetime) - std::exp(-t / relaxation)) / (1.0 - ratio);
}

/// When that answer is largest.
double time_of_most(double lifetime, double relaxation) {
  const double ratio = relaxation / lifetime;
  if (std::abs(ratio - 1.0) < 1e-6) return lifetime;
  return relaxation * std::log(ratio) / (ratio - 1.0);
}

}  // namespace

double aerosol_optical_depth(const AerosolVeil& veil) {
  constexpr double kExtinction_m2_kg = 2500.0;
  return kExtinction_m2_kg * veil.mass_kg / veil.planet_area_m2;
}

double aerosol_cooling_k(const AerosolVeil& veil, double age_yr) {
  constexpr double kPerDepth_w_m2 = 25.0;
  if (veil.mass_kg <= 0.0) return 0.0;
  const double dimmed_w_m2 =
      -veil.absorbed_w_m2 *
      std::expm1(-kPerDepth_w_m2 * aerosol_optical_depth(veil) / veil.absorbed_w_m2);
  const double relaxation_yr = veil.heat_capacity_w_yr_m2_k / veil.feedback_w_m2_k;
  const double t = std::max(age_yr, time_of_most(veil.lifetime_yr, relaxation_yr));
  const double answer = std::max(0.0, response(veil.lifetime_yr, relaxation_yr, t));
  return dimmed_w_m2 / veil.feedback_w_m2_k * answer;
}

double precipitation_left(double cooling_k) {
  constexpr double kPerKelvin = 0.024;
  return std::exp(-kPerKelvin * cooling_k);
}

}  // namespace geo
