// Figures of rivers, lakes and what they carry away.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "geo/kernels/figures/drainage_figures.hpp"
#include "geo/kernels/numerics/quantiles.hpp"
#include "score_figures.hpp"
#include "score_grid.hpp"

namespace geo::io {
namespace {

constexpr double kSecondsPerYear = 31557600.0;
constexpr double kRockKgM3 = 2700.0;

/// Sum over the land of an amount per m2 that `amount(cell)` gives.
template <class Amount>
double sum_over_land(const State& state, const Amount& amount) {
  const Grid& grid = state.grid();
  const auto z = state.read(field::elevation);
  double total = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    double row = 0.0;
    for (Index c = grid.cell(0, j); c < grid.cell(0, j) + grid.nx(); ++c) {
      if (z[c] >= 0.0F) row += amount(c);
    }
    total += row * grid.area_m2(j);
  }
  return total;
}

double land_area_m2(const State& state) {
  return sum_over_land(state, [](Index) { return 1.0; });
}

void measure_runoff(const State& state, Figures& figures) {
  const Grid& grid = state.grid();
  const auto z = state.read(field::elevation);
  const auto discharge = state.read(field::discharge);
  const auto receiver = state.read(field::flow_receiver);
  const auto rain = state.read(field::precipitation);
  double to_sea_m3_s = 0.0;
  for (Index c = 0; c < grid.size(); ++c) {
    if (z[c] >= 0.0F && z[receiver[c]] < 0.0F) to_sea_m3_s += discharge[c];
  }
  const double rain_m3_yr =
      sum_over_land(state, [&](Index c) { return 1e-3 * static_cast<double>(rain[c]); });
  if (rain_m3_yr > 0.0) figures["runoff_ratio"] = to_sea_m3_s * kSecondsPerYear / rain_m3_yr;
}

/// Mean thickness of sediment on land and at sea, on cells as large as those of the Earth's.
void measure_sediment_thickness(const State& state, Figures& figures) {
  const CoarseField sediment = coarsen(state, field::sediment_thickness, kCrustStepDeg);
  const CoarseField elevation = coarsen(state, field::elevation, kCrustStepDeg);
  std::vector<std::uint8_t> mask(elevation.values.size());
  for (const bool on_land : {true, false}) {
    for (std::size_t c = 0; c < mask.size(); ++c) {
      mask[c] = (elevation.values[c] >= 0.0F) == on_land ? 1 : 0;
    }
    if (std::find(mask.begin(), mask.end(), 1) == mask.end()) continue;
    figures[on_land ? "sediment_land" : "sediment_sea"] =
        area_mean(*sediment.grid, sediment.values, mask);
  }
}

/// What rivers bring to the cells of the sea.
void measure_sediment(const State& state, Figures& figures) {
  const auto z = state.read(field::elevation);
  const auto flux = state.read(field::sediment_flux);
  double to_sea_m3_yr = 0.0;
  for (std::size_t c = 0; c < z.size(); ++c) {
    if (z[c] < 0.0F) to_sea_m3_yr += flux[c];
  }
  figures["sediment_flux"] = to_sea_m3_yr * kRockKgM3 / 1e12;
}

void measure_basin_areas(const Grid& grid, const DrainedPlanet& drainage,
                         std::span<const std::int32_t> basin_id, double land_m2, Figures& figures) {
  const Basins basins = measure_basins(grid, drainage, basin_id);
  double endorheic_m2 = 0.0;
  for (std::size_t b = 0; b < basins.area_m2.size(); ++b) {
    if (basins.is_endorheic[b] != 0) endorheic_m2 += basins.area_m2[b];
  }
  figures["endorheic"] = 100.0 * endorheic_m2 / land_m2;
  auto areas = basins.area_m2;
  constexpr std::size_t kLargest = 6;
  if (areas.size() < kLargest) return;
  std::partial_sort(areas.begin(), areas.begin() + kLargest, areas.end(), std::greater<>());
  double sum = 0.0;
  for (std::size_t b = 0; b < kLargest; ++b) sum += areas[b];
  figures["largest_basin"] = areas.front() / 1e12;
  figures["largest_basins"] = sum / kLargest / 1e12;
}

/// Basins large enough for a sample of their sand, each counting once.
void measure_basin_denudation(const State& state, const Basins& basins, Figures& figures) {
  constexpr double kLeastM2 = 1e9;
  const auto means = basin_means(state.grid(), state.read(field::elevation),
                                 state.read(field::basin_id), state.read(field::erosion_rate));
  std::vector<double> sample;
  for (std::size_t b = 1; b < means.size(); ++b) {
    if (basins.area_m2[b] >= kLeastM2 && std::isfinite(means[b])) sample.push_back(means[b] * 1e6);
  }
  if (sample.empty()) return;
  double sum = 0.0;
  for (const double rate : sample) sum += rate;
  figures["denudation_mean"] = sum / static_cast<double>(sample.size());
  const auto middle = sample.begin() + static_cast<long>(sample.size() / 2);
  std::nth_element(sample.begin(), middle, sample.end());
  figures["denudation_median"] = *middle;
}

void measure_network(const State& state, double land_m2, Figures& figures) {
  const Grid& grid = state.grid();
  const DrainedPlanet drainage{state.read(field::elevation), state.read(field::flow_receiver),
                               state.read(field::drainage_area)};
  // Smaller basins are a few cells whose shape is the raster's.
  const double least_m2 = std::max(1e10, 100.0 * grid.total_area_m2() / grid.size());
  figures["hack"] = hack_exponent(grid, drainage, least_m2);
  if (state.has(field::stream_order)) {
    const auto ratios = horton_ratios(grid, drainage, state.read(field::stream_order), least_m2);
    figures["horton_bifurcation"] = ratios.bifurcation;
    figures["horton_length"] = ratios.length;
    figures["horton_area"] = ratios.area;
  }
  if (!state.has(field::basin_id)) return;
  measure_basin_areas(grid, drainage, state.read(field::basin_id), land_m2, figures);
  if (state.has(field::erosion_rate)) {
    measure_basin_denudation(state, measure_basins(grid, drainage, state.read(field::basin_id)),
                             figures);
  }
}

}  // namespace

void measure_rivers(const State& state, Figures& figures) {
  if (!state.has(field::elevation)) return;
  const double land_m2 = land_area_m2(state);
  if (!(land_m2 > 0.0)) return;
  if (state.has(field::lake_depth)) {
    const auto depth = state.read(field::lake_depth);
    figures["lakes"] = 100.0 *
                       sum_over_land(state, [&](Index c) { return depth[c] > 0.0F ? 1.0 : 0.0; }) /
                       land_m2;
  }
  if (state.has(field::erosion_rate)) {
    const auto rate = state.read(field::erosion_rate);
    figures["denudation_flux"] =
        sum_over_land(state, [&](Index c) { return std::max(0.0F, rate[c]); }) * kRockKgM3 / 1e12;
  }
  if (state.has(field::sediment_flux)) measure_sediment(state, figures);
  if (state.has(field::sediment_thickness)) measure_sediment_thickness(state, figures);
  if (!state.has(field::flow_receiver)) return;
  if (state.has(field::discharge) && state.has(field::precipitation)) {
    measure_runoff(state, figures);
  }
  if (state.has(field::drainage_area)) measure_network(state, land_m2, figures);
}

}  // namespace geo::io
