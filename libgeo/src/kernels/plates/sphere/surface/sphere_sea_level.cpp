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

namespace {

/// The sea below a level: its water and its surface.
struct SeaBelow {
  double volume_km3, area_km2;
};

/// Places that no plate stands for are floor of the mean depth of `gap_m`.
SeaBelow sea_below(const SphereTectonics& model, double level_m, double gap_m) {
  const SphereCrust& crust = model.state.crust;
  const auto depth_m = [&](std::int32_t i) {
    if (crust.plate[i] < 0 || model.margins.hidden[i] != 0) return std::max(0.0, level_m - gap_m);
    return std::max(0.0, level_m - crust.elevation_m[i]);
  };
  const double depths_m = sum_over(crust.size(), depth_m);
  const double places =
      sum_over(crust.size(), [&](std::int32_t i) { return depth_m(i) > 0.0 ? 1.0 : 0.0; });
  return {1e-3 * model.sample_km2() * depths_m, model.sample_km2() * places};
}

}  // namespace

double sea_volume_km3(const SphereTectonics& model, double level_m) {
  return sea_below(model, level_m, gap_m(model)).volume_km3;
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

/// Newton's steps: the volume rises with the level, the faster the higher it is, so that from the
/// second on each level lies above the one sought, and nearer.
void keep_water(SphereTectonics& model) {
  SphereState& state = model.state;
  if (state.water_km3 <= 0.0) return;
  constexpr double kReach_m = 12000.0, kClose_m = 1e-4;
  constexpr int kSteps = 60;
  const double wanted_km3 = std::max(0.0, state.water_km3 - state.ice_km3), floor_m = gap_m(model);
  double level_m = state.sea_level_m;
  for (int k = 0; k < kSteps; ++k) {
    const SeaBelow sea = sea_below(model, level_m, floor_m);
    const double missing_km3 = wanted_km3 - sea.volume_km3;
    if (sea.area_km2 == 0.0 && missing_km3 <= 0.0) break;
    // Of dry ground there is no surface to go by.
    const double next_m =
        sea.area_km2 > 0.0 ? level_m + 1e3 * missing_km3 / sea.area_km2 : 0.5 * kReach_m;
    if (std::abs(next_m - level_m) < kClose_m) break;
    level_m = std::clamp(next_m, -kReach_m, kReach_m);
  }
  state.sea_level_m = level_m;
}

}  // namespace geo
