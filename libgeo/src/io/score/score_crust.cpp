// Figures of continental crust and of the sea floor.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "geo/kernels/numerics/quantiles.hpp"
#include "geo/kernels/numerics/regression.hpp"
#include "score_figures.hpp"
#include "score_grid.hpp"

namespace geo::io {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kContinentalM = 18000.0F;  // the least thickness of continental crust
// Older crust at sea is stretched continent: subduction leaves no older floor.
constexpr float kOldestFloorMyr = 250.0F;

using Mask = std::vector<std::uint8_t>;

template <class Test>
Mask mask_where(std::size_t cells, const Test& test) {
  Mask mask(cells);
  for (std::size_t c = 0; c < cells; ++c) mask[c] = test(c) ? 1 : 0;
  return mask;
}

double area_share(const Grid& grid, const Mask& mask) {
  double area_m2 = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    double cells = 0.0;
    for (Index c = grid.cell(0, j); c < grid.cell(0, j) + grid.nx(); ++c) cells += mask[c];
    area_m2 += cells * grid.area_m2(j);
  }
  return area_m2 / grid.total_area_m2();
}

double mean_or_nan(const Grid& grid, std::span<const float> values, const Mask& mask) {
  return area_share(grid, mask) > 0.0 ? area_mean(grid, values, mask) : kNaN;
}

void measure_continents(const CoarseField& crust, Figures& figures) {
  const auto& thickness = crust.values;
  const Mask continental =
      mask_where(thickness.size(), [&](std::size_t c) { return thickness[c] > kContinentalM; });
  const Mask oceanic =
      mask_where(thickness.size(), [&](std::size_t c) { return thickness[c] <= kContinentalM; });
  const double share = area_share(*crust.grid, continental);
  figures["continental_area"] = 100.0 * share;
  figures["oceanic_thickness"] = mean_or_nan(*crust.grid, thickness, oceanic) / 1000.0;
  if (share == 0.0) return;
  figures["continental_thickness"] = area_mean(*crust.grid, thickness, continental) / 1000.0;
  constexpr std::array kFractions{0.05, 0.25, 0.5, 0.75, 0.95};
  const auto values = quantiles(*crust.grid, thickness, kFractions, continental);
  for (std::size_t i = 0; i < kFractions.size(); ++i) {
    figures[fmt::format("continental_thickness_q{:02.0f}", 100.0 * kFractions[i])] =
        values[i] / 1000.0;
  }
}

void measure_crust_and_relief(const CoarseField& crust, const CoarseField& relief,
                              Figures& figures) {
  const Grid& grid = *crust.grid;
  const auto& thickness = crust.values;
  const auto& z = relief.values;
  const std::size_t cells = z.size();
  const double continental = area_share(
      grid, mask_where(cells, [&](std::size_t c) { return thickness[c] > kContinentalM; }));
  const double submerged = area_share(grid, mask_where(cells, [&](std::size_t c) {
                                        return thickness[c] > kContinentalM && z[c] < 0.0F;
                                      }));
  if (continental > 0.0) figures["continental_submerged"] = 100.0 * submerged / continental;
  figures["land_thickness"] =
      mean_or_nan(grid, thickness, mask_where(cells, [&](std::size_t c) { return z[c] >= 0.0F; })) /
      1000.0;
  figures["thickness_slope"] = area_regression_slope(
      grid, thickness, z,
      mask_where(cells, [&](std::size_t c) { return thickness[c] > kContinentalM; }));
  const auto slope_between = [&](float low_m, float high_m) {
    return area_regression_slope(grid, thickness, z, mask_where(cells, [&](std::size_t c) {
                                   return z[c] >= 0.0F && thickness[c] >= low_m &&
                                          thickness[c] < high_m;
                                 }));
  };
  figures["thickness_slope_land"] = slope_between(30000.0F, 50000.0F);
  figures["thickness_slope_plateau"] = slope_between(50000.0F, 1e6F);
}

struct AgeClass {
  int from_myr, to_myr;
};
constexpr std::array kAgeClasses{AgeClass{0, 2}, AgeClass{10, 20}, AgeClass{40, 60},
                                 AgeClass{80, 100}, AgeClass{120, 140}};

void measure_depths(const State& state, std::span<const float> age_myr, Figures& figures) {
  const Grid& grid = state.grid();
  const auto z = state.read(field::elevation);
  for (const auto& [from, to] : kAgeClasses) {
    const Mask mask = mask_where(z.size(), [&, low = from, high = to](std::size_t c) {
      return age_myr[c] >= static_cast<float>(low) && age_myr[c] < static_cast<float>(high) &&
             z[c] < 0.0F;
    });
    if (area_share(grid, mask) == 0.0) continue;
    figures[fmt::format("depth_{}_{}", from, to)] = -quantile(grid, z, 0.5, mask);
  }
}

}  // namespace

void measure_crust(const State& state, Figures& figures) {
  if (state.has(field::crust_thickness)) {
    CoarseField crust = coarsen(state, field::crust_thickness, kCrustStepDeg);
    if (state.has(field::crust_thickness_change)) {
      const CoarseField change = coarsen(state, field::crust_thickness_change, kCrustStepDeg);
      std::transform(crust.values.begin(), crust.values.end(), change.values.begin(),
                     crust.values.begin(), std::plus<>());
    }
    measure_continents(crust, figures);
    if (state.has(field::elevation)) {
      measure_crust_and_relief(crust, coarsen(state, field::elevation, kCrustStepDeg), figures);
    }
  }
  if (!state.has(field::crust_age) || !state.has(field::continental_fraction)) return;
  // On continents the age is that of another event.
  const Grid& grid = state.grid();
  const auto age = state.read(field::crust_age);
  const auto continent = state.read(field::continental_fraction);
  std::vector<float> floor_myr(age.size());
  for (std::size_t c = 0; c < age.size(); ++c) {
    floor_myr[c] = continent[c] < 0.5F && age[c] <= kOldestFloorMyr ? age[c] : kNaN;
  }
  const Mask floor =
      mask_where(age.size(), [&](std::size_t c) { return floor_myr[c] == floor_myr[c]; });
  const double share = area_share(grid, floor);
  figures["floor_share"] = 100.0 * share;
  if (share == 0.0) return;
  figures["floor_age_mean"] = area_mean(grid, floor_myr);
  constexpr std::array kFractions{0.1, 0.5, 0.9};
  const auto values = quantiles(grid, floor_myr, kFractions);
  for (std::size_t i = 0; i < kFractions.size(); ++i) {
    figures[fmt::format("floor_age_q{:02.0f}", 100.0 * kFractions[i])] = values[i];
  }
  constexpr double kRecentMyr = 10.0;
  figures["floor_growth"] = fraction_below(grid, floor_myr, kRecentMyr) * share *
                            grid.total_area_m2() / 1e6 / (kRecentMyr * 1e6);
  if (state.has(field::elevation)) measure_depths(state, floor_myr, figures);
}

}  // namespace geo::io
