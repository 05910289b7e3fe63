#include <algorithm>
#include <cmath>

#include "geo/kernels/crust/ocean_depth.hpp"
#include "geo/kernels/plates/sphere/surface/sphere_water.hpp"
#include "kernels/plates/sphere/sample_sums.hpp"
#include "kernels/plates/sphere/sphere_steps.hpp"

namespace geo {
namespace {

/// Mean elevation of the floor that has opened since the last resampling, at an even rate.
double gap_m(const SphereTectonics& model) {
  if (!model.settings.floor_by_age) return 1e3 * model.settings.law.ridge_km;
  constexpr int kParts = 16;
  const double open_myr = model.state.time_myr - model.state.resampled_myr;
  double sum = 0.0;
  for (int k = 0; k < kParts; ++k) sum -= ocean_depth_m(open_myr * (k + 0.5) / kParts);
  return sum / kParts;
}

}  // namespace

double level_above(const SphereTectonics& model, double share) {
  constexpr int kLowest_m = -12000, kHighest_m = 12000, kBins = kHighest_m - kLowest_m;
  const SphereCrust& crust = model.state.crust;
  std::vector<std::int32_t> count(kBins, 0);
  for (std::int32_t i = 0; i < crust.size(); ++i) {
    if (crust.plate[i] < 0 || model.margins.hidden[i] != 0) continue;
    const int bin = static_cast<int>(std::floor(crust.elevation_m[i])) - kLowest_m;
    ++count[std::clamp(bin, 0, kBins - 1)];
  }
  const double wanted = share * crust.size();
  double above = 0.0;
  int bin = kBins;
  while (bin > 0 && above < wanted) above += count[--bin];
  return bin + kLowest_m;
}

double sea_volume_km3(const SphereTectonics& model, double level_m) {
  const SphereCrust& crust = model.state.crust;
  const auto is_seen = [&](std::int32_t i) {
    return crust.plate[i] >= 0 && model.margins.hidden[i] == 0;
  };
  const double seen =
      sum_over(crust.size(), [&](std::int32_t i) { return is_seen(i) ? 1.0 : 0.0; });
  const double depths_m = sum_over(crust.size(), [&](std::int32_t i) {
    return is_seen(i) ? std::max(0.0, level_m - crust.elevation_m[i]) : 0.0;
  });
  const double gaps_m = (crust.size() - seen) * std::max(0.0, level_m - gap_m(model));
  return 1e-3 * model.sample_km2() * (depths_m + gaps_m);
}

void exchange_water(SphereTectonics& model) {
  SphereState& state = model.state;
  const SphereSettings& s = model.settings;
  if (state.water_km3 <= 0.0 || s.freeboard_myr <= 0.0) return;
  const double level_m = level_above(model, 1.0 - s.freeboard_ocean_share);
  const double steady_km3 = sea_volume_km3(model, level_m) + state.ice_km3;
  state.water_km3 +=
      (steady_km3 - state.water_km3) * -std::expm1(-s.law.step_myr / s.freeboard_myr);
}

void keep_water(SphereTectonics& model) {
  SphereState& state = model.state;
  if (state.water_km3 <= 0.0) return;
  constexpr double kReach_m = 12000.0;
  constexpr int kHalvings = 30;  // to less than a millimetre
  const double wanted_km3 = std::max(0.0, state.water_km3 - state.ice_km3);
  double low = -kReach_m, high = kReach_m;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (sea_volume_km3(model, middle) > wanted_km3 ? high : low) = middle;
  }
  state.sea_level_m = 0.5 * (low + high);
}

}  // namespace geo
