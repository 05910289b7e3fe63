// Figures of air and rain.
#include <fmt/format.h>

#include <array>
#include <vector>

#include "geo/io/files/embedded_data.hpp"
#include "geo/kernels/figures/hypsometry_figures.hpp"
#include "geo/kernels/numerics/quantiles.hpp"
#include "geo/kernels/numerics/zonal_means.hpp"
#include "score_figures.hpp"

namespace geo::io {
namespace {

using Mask = std::vector<std::uint8_t>;

/// Cells of land, or of the sea.
Mask land_mask(const State& state, bool land) {
  const auto z = state.read(field::elevation);
  Mask mask(z.size());
  for (std::size_t c = 0; c < mask.size(); ++c) mask[c] = (z[c] >= 0.0F) == land ? 1 : 0;
  return mask;
}

bool any(const Mask& mask) { return std::find(mask.begin(), mask.end(), 1) != mask.end(); }

constexpr int kBands = 18;

/// Earth's zonal means from the south.
std::vector<double> earth_bands(std::size_t column) {
  std::vector<double> bands;
  const Table table = embedded_table("targets/earth_zonal.csv");
  for (std::size_t row = 0; row < table.rows(); ++row) bands.push_back(table.number(row, column));
  return bands;
}

void measure_temperature(const State& state, Figures& figures) {
  constexpr std::size_t kColumn = 2;
  const auto temperature = state.read(field::temperature);
  figures["temperature"] = area_mean(state.grid(), temperature);
  figures["temperature_bands"] =
      zonal_rms(zonal_means(state.grid(), temperature, kBands), earth_bands(kColumn));
}

void measure_seasons(const State& state, const Mask& mask, const char* where, Figures& figures) {
  const auto bands = zonal_means(state.grid(), state.read(field::temperature_range), kBands, mask);
  constexpr std::array<std::pair<const char*, int>, 4> kPlaces{
      {{"55n", 14}, {"35n", 12}, {"15n", 10}, {"35s", 5}}};
  for (const auto& [name, band] : kPlaces) {
    figures[fmt::format("season_{}_{}", where, name)] = bands[band];
  }
}

void measure_dryness(const State& state, const Mask& land, Figures& figures) {
  const auto rain = state.read(field::precipitation);
  const auto thirst = state.read(field::potential_evapotranspiration);
  constexpr std::array kLevels{0.05, 0.2, 0.5, 0.65};
  constexpr std::array kNames{"hyperarid", "arid", "semiarid", "dry_subhumid"};
  std::vector<float> index(rain.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t c = 0; c < index.size(); ++c) {
    // Where nothing can evaporate no rain is too little.
    if (land[c] != 0) index[c] = thirst[c] > 0.0F ? rain[c] / thirst[c] : 1e30F;
  }
  const auto shares = shares_between(state.grid(), index, kLevels);
  for (std::size_t k = 0; k < kNames.size(); ++k) figures[kNames[k]] = 100.0 * shares[k];
}

}  // namespace

void measure_climate(const State& state, Figures& figures) {
  const Grid& grid = state.grid();
  if (state.has(field::temperature)) measure_temperature(state, figures);
  if (state.has(field::precipitation)) {
    constexpr std::size_t kColumn = 3;
    const auto rain = state.read(field::precipitation);
    figures["precipitation"] = area_mean(grid, rain);
    figures["precipitation_bands"] =
        zonal_rms(zonal_means(grid, rain, kBands), earth_bands(kColumn));
  }
  if (!state.has(field::elevation)) return;
  for (const bool on_land : {true, false}) {
    const Mask mask = land_mask(state, on_land);
    if (!any(mask)) continue;
    const char* const where = on_land ? "land" : "ocean";
    if (state.has(field::precipitation)) {
      figures[fmt::format("precipitation_{}", where)] =
          area_mean(grid, state.read(field::precipitation), mask);
    }
    if (state.has(field::temperature_range)) measure_seasons(state, mask, where, figures);
    if (on_land && state.has(field::precipitation) &&
        state.has(field::potential_evapotranspiration)) {
      measure_dryness(state, mask, figures);
    }
  }
}

}  // namespace geo::io
