// Figures of elevation: hypsometry, local relief, seas and spectrum.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "geo/kernels/figures/hypsometry_figures.hpp"
#include "geo/kernels/figures/profile_figures.hpp"
#include "geo/kernels/figures/relief_figures.hpp"
#include "geo/kernels/numerics/quantiles.hpp"
#include "geo/kernels/numerics/spectrum.hpp"
#include "geo/kernels/water/sea_parts.hpp"
#include "score_figures.hpp"
#include "score_grid.hpp"

namespace geo::io {
namespace {

constexpr std::array kPercents{5, 25, 50, 75, 90, 95};
constexpr std::array kLevelsM{-6000.0, -5000.0, -4000.0, -3000.0, -2000.0, -1000.0, -200.0,
                              0.0,     200.0,   500.0,   1000.0,  2000.0,  3000.0};

void measure_quantiles(const CoarseField& elevation, bool land, Figures& figures) {
  std::vector<std::uint8_t> mask(elevation.values.size());
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = (elevation.values[i] >= 0.0F) == land;
  if (std::find(mask.begin(), mask.end(), 1) == mask.end()) return;
  std::vector<double> fractions;
  for (const int percent : kPercents) fractions.push_back(percent / 100.0);
  const auto values = quantiles(*elevation.grid, elevation.values, fractions, mask);
  for (std::size_t i = 0; i < kPercents.size(); ++i) {
    figures[fmt::format("{}_q{:02}", land ? "land" : "ocean", kPercents[i])] = values[i];
  }
}

void measure_shares(const CoarseField& elevation, Figures& figures) {
  const auto shares = shares_between(*elevation.grid, elevation.values, kLevelsM);
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const std::string name = k == 0 ? fmt::format("share_below_{:g}", kLevelsM.front())
                             : k == kLevelsM.size()
                                 ? fmt::format("share_above_{:g}", kLevelsM.back())
                                 : fmt::format("share_{:g}_{:g}", kLevelsM[k - 1], kLevelsM[k]);
    figures[name] = 100.0 * shares[k];
  }
}

void measure_spectrum(const State& state, Figures& figures) {
  // Continents themselves are too few for a law; what is finer than 200 km depends on the grid.
  constexpr int kFirst = 3, kLast = 96;
  constexpr double kStepDeg = 0.5;
  const CoarseField elevation = coarsen(state, field::elevation, kStepDeg);
  if (elevation.grid->ny() < 2 * kLast) return;
  figures["spectral_slope"] =
      spectral_slope(harmonic_power(*elevation.grid, elevation.values, kLast), kFirst, kLast);
}

/// Ranges of height from cell to cell say something only between cells of one size, and straits
/// close on larger ones.
void measure_local_relief(const State& state, Figures& figures) {
  const CoarseField elevation = coarsen(state, field::elevation, kLocalStepDeg);
  const Grid& grid = *elevation.grid;
  if (grid.ny() < std::lround(180.0 / kLocalStepDeg)) return;
  constexpr double kDeepM = 3000.0, kLargeM2 = 2e12, kFlatM = 30.0;
  figures["landlocked_seas"] =
      count_landlocked(parts_of_sea(grid, elevation.values), kDeepM, kLargeM2);
  std::vector<std::uint8_t> land(elevation.values.size());
  std::vector<float> range = local_relief_m(grid, elevation.values);
  for (std::size_t c = 0; c < land.size(); ++c) {
    land[c] = elevation.values[c] >= 0.0F ? 1 : 0;
    if (land[c] == 0) range[c] = std::numeric_limits<float>::quiet_NaN();
  }
  if (std::find(land.begin(), land.end(), 1) == land.end()) return;
  constexpr std::array kFractions{0.1, 0.5, 0.9};
  constexpr std::array kFlat{kFlatM};
  const auto values = quantiles(grid, range, kFractions, land);
  for (std::size_t k = 0; k < kFractions.size(); ++k) {
    figures[fmt::format("local_relief_q{:.0f}", 100.0 * kFractions[k])] = values[k];
  }
  figures["flat_land"] = 100.0 * shares_between(grid, range, kFlat).front();
}

/// What rivers have made of the land, on cells of one size: slopes grow as cells shrink. Poleward
/// of 60 degrees ice sheets cover most of the Earth's high ground.
void measure_profiles(const State& state, Figures& figures) {
  const CoarseField elevation = coarsen(state, field::elevation, kLocalStepDeg);
  const Grid& grid = *elevation.grid;
  if (grid.ny() < std::lround(180.0 / kLocalStepDeg)) return;
  constexpr LatitudeBand kBand{60.0};
  constexpr double kLargeRiverM2 = 1e11, kBasinM2 = 2e10, kFirstM2 = 4e9, kLastM2 = 1e12;
  constexpr double kTheta = 0.45, kChannelM2 = 1e10;
  const LaidRivers rivers = lay_rivers(grid, elevation.values);
  figures["river_slope"] = 1000.0 * river_slope(grid, rivers, kLargeRiverM2, kBand);
  figures["concavity"] = concavity(grid, rivers, kFirstM2, kLastM2, kBand);
  auto integrals = hypsometric_integrals(grid, elevation.values, rivers, kBasinM2, kBand);
  if (!integrals.empty()) {
    const auto middle = integrals.begin() + static_cast<long>(integrals.size() / 2);
    std::nth_element(integrals.begin(), middle, integrals.end());
    figures["hypsometric_integral"] = *middle;
  }
  const auto steepness = channel_steepness(grid, rivers, kTheta, kChannelM2, kBand);
  if (std::all_of(steepness.begin(), steepness.end(), [](float k) { return std::isnan(k); })) {
    return;
  }
  constexpr std::array kFractions{0.5, 0.9};
  const auto values = quantiles(grid, steepness, kFractions);
  figures["steepness_q50"] = values[0];
  figures["steepness_q90"] = values[1];
}

/// Ice frays the coasts that it reaches: fjords and sounds between skerries.
void measure_fjords(const State& state, Figures& figures) {
  constexpr double kStepDeg = 0.4, kLatitudeDeg = 50.0, kReachM = 5e4;
  const CoarseField elevation = coarsen(state, field::elevation, kStepDeg);
  if (elevation.grid->ny() < std::lround(180.0 / kStepDeg)) return;
  const double share = share_of_sounds(*elevation.grid, elevation.values, kLatitudeDeg, kReachM);
  figures["fjords"] = 100.0 * share;
}

}  // namespace

void measure_relief(const State& state, Figures& figures) {
  if (!state.has(field::elevation)) return;
  const CoarseField elevation = coarsen(state, field::elevation, kReliefStepDeg);
  const auto hypsometry = measure_hypsometry(*elevation.grid, elevation.values);
  figures["land_fraction"] = 100.0 * hypsometry.land_fraction;
  figures["land_mean"] = hypsometry.land_mean_m;
  figures["ocean_mean"] = hypsometry.ocean_mean_m;
  figures["water_volume"] = hypsometry.water_volume_m3 / 1e18;
  measure_quantiles(elevation, true, figures);
  measure_quantiles(elevation, false, figures);
  const auto modes = elevation_modes(*elevation.grid, elevation.values);
  figures["ocean_mode"] = modes.ocean_m;
  figures["land_mode"] = modes.land_m;
  figures["antimode"] = modes.antimode_m;
  measure_shares(elevation, figures);
  measure_local_relief(state, figures);
  measure_profiles(state, figures);
  measure_spectrum(state, figures);
  measure_fjords(state, figures);
}

}  // namespace geo::io
