#include "calibration/result.hpp"

#include <limits>

namespace geo::calibration {
namespace {

double mean_of(const std::vector<SeedMisfit>& seeds, double SeedMisfit::*figure) {
  if (seeds.empty()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0;
  for (const SeedMisfit& seed : seeds) sum += seed.*figure;
  return sum / static_cast<double>(seeds.size());
}

}  // namespace

bool has_collapsed(const SeedSpread& spread) {
  constexpr double kAlike = 0.5;
  return spread.after_m < kAlike * spread.before_m;
}

double mean_before_m(const std::vector<SeedMisfit>& seeds) {
  return mean_of(seeds, &SeedMisfit::before_m);
}

double mean_after_m(const std::vector<SeedMisfit>& seeds) {
  return mean_of(seeds, &SeedMisfit::after_m);
}

}  // namespace geo::calibration
