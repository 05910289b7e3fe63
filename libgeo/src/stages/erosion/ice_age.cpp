#include "ice_age.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "climate_of_land.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/core/release.hpp"
#include "geo/kernels/numerics/area_sum.hpp"
#include "geo/kernels/numerics/smoothing.hpp"

namespace geo {
namespace {

constexpr double kIceOverMantle = 910.0 / 3300.0;
/// Air holds less vapour as it cools, and rains less: about so much per kelvin (Huybrechts 2002).
constexpr double kDrier_1_K = 0.05;
constexpr double kMostMelt_m_yr = 12.0;  ///< of water: where no tongue gets through
constexpr float kThinnest_m = 1.0F, kAshore_m = 1.0F;
constexpr float kLeastShare = 0.02F;

}  // namespace

IceAge::IceAge(const ErosionParameters& parameters, const Grid& grid, const Planet& planet)
    : p_(parameters), grid_(grid) {
  snow_.snow_melt_mm_k_d = p_.snow_melt_mm_k_d;
  snow_.ice_melt_mm_k_d = p_.ice_melt_mm_k_d;
  erosion_.abrasion = p_.abrasion;
  erosion_.overdeepening = p_.overdeepening;
  erosion_.till_share = p_.till_share;
  k_m_ = 1e3 * p_.ice_stress_kpa / (snow_.ice_kg_m3 * planet.gravity_m_s2);
}

double IceAge::years_of_step(double before_today_yr) const {
  return std::clamp(p_.glacial_time_yr - before_today_yr, 0.0, p_.time_step_yr);
}

std::vector<SparseValues<double>> IceAge::work(const LandClimate& climate, double years_yr,
                                               std::span<float> elevation_m) {
  constexpr int kGrowing = 3, kMelting = 2;
  const double cycle_yr = p_.glacial_time_yr / static_cast<double>(p_.glacial_cycles);
  const int cycles = std::max(1, static_cast<int>(std::lround(years_yr / cycle_yr)));
  std::vector<SparseValues<double>> let_out_m3;
  const auto live = [&](const Age& age, double share) {
    if (share <= 0.0) return;
    settle(climate, age, elevation_m);
    let_out_m3.push_back(erode_under_ice(grid_, erosion_, share * years_yr / cycles, surface_,
                                         flux_, ground_, sunk_m_, elevation_m));
    weigh(elevation_m);
    melt_away();
  };
  for (int cycle = 0; cycle < cycles; ++cycle) {
    live({p_.glacial_cooling_k, p_.grounding_m, kGrowing}, p_.glacial_share);
    live({0.0, 0.0, kMelting}, 1.0 - p_.glacial_share);
  }
  return let_out_m3;
}

void IceAge::follow(const LandClimate& climate, double warmer_k, int rounds,
                    std::span<const float> elevation_m) {
  settle(climate, {-warmer_k, 0.0, rounds}, elevation_m);
  measure(elevation_m);
  weigh(elevation_m);
}

void IceAge::settle_today(const LandClimate& climate, std::span<const float> elevation_m) {
  constexpr int kRounds = 3, kTurns = 2;
  lay(climate);
  settle(climate, {0.0, 0.0, kRounds}, elevation_m);
  // The ground sinks under the ice, and the ice changes a little with the ground.
  for (int turn = 0; turn < kTurns; ++turn) {
    weigh(elevation_m);
    settle(climate, {0.0, 0.0, 1}, elevation_m);
  }
  measure(elevation_m);
#pragma omp parallel for schedule(static)
  for (Index c = 0; c < grid_.size(); ++c) {
    if (elevation_m[c] < 0.0F) continue;
    sunk_m_[c] =
        std::clamp(sunk_m_[c], 0.0F, std::max(0.0F, elevation_m[c] + thickness_m_[c] - kAshore_m));
  }
  melt_away();
}

/// Ice begins where the climate has it.
void IceAge::lay(const LandClimate& climate) {
  next_.resize(static_cast<std::size_t>(grid_.size()), IceGround::bare);
  if (climate.ice_m.empty()) return;
  LandClimate::Reader ice(climate, grid_, climate.ice_m);
  for (int j = 0; j < grid_.ny(); ++j) {
    const auto row = ice.row(j);
    for (int i = 0; i < grid_.nx(); ++i) {
      if (row[i] >= kThinnest_m) next_[grid_.cell(i, j)] = IceGround::iced;
    }
  }
}

/// Thickness on land of the ice that has settled.
void IceAge::measure(std::span<const float> elevation_m) {
  thickness_m_.assign(elevation_m.size(), 0.0F);
#pragma omp parallel for schedule(static)
  for (Index c = 0; c < grid_.size(); ++c) {
    if (elevation_m[c] < 0.0F || ground_[c] != IceGround::iced) continue;
    const float mean_m = flux_.share.of(c) * (surface_.height_m.of(c) - bed_m_[c]);
    if (mean_m >= kThinnest_m) thickness_m_[c] = mean_m;
  }
}

std::vector<float> IceAge::surface_m(std::span<const float> elevation_m) const {
  std::vector<float> surface(elevation_m.begin(), elevation_m.end());
  for (std::size_t c = 0; c < thickness_m_.size(); ++c) {
    if (thickness_m_[c] > 0.0F) surface[c] += thickness_m_[c] - sunk_m_[c];
  }
  return surface;
}

/// What only ice that works needs leaves memory; its sums stay.
void IceAge::melt_away() {
  release(ground_);
  release(bed_m_);
  surface_ = {};
  flux_.through_m3_yr = {};
  flux_.share = flux_.melted = {};
}

std::vector<float> IceAge::take_thickness_m() {
  release(next_), release(sunk_m_);
  return std::move(thickness_m_);
}

void IceAge::settle(const LandClimate& climate, const Age& age,
                    std::span<const float> elevation_m) {
  next_.resize(elevation_m.size(), IceGround::bare);
  sunk_m_.resize(elevation_m.size(), 0.0F);
  bed_m_.resize(elevation_m.size());
#pragma omp parallel for schedule(static)
  for (std::size_t c = 0; c < bed_m_.size(); ++c) bed_m_[c] = elevation_m[c] - sunk_m_[c];
  sort_ground(climate, age, elevation_m);
  Cold cold = cold_cells(climate);
  const IceReach reach = ice_reach(grid_, next_);
  SparseValues<float> balance_m_yr(reach.cells);
  for (int round = 0; round < age.rounds; ++round) {
    surface_ = {};
    flux_ = {};
    ground_ = next_;
    surface_ = plastic_ice_surface(grid_, k_m_, bed_m_, ground_, reach);
    balance(cold, age, elevation_m, balance_m_yr);
    flux_ = ice_flux(grid_, bed_m_, ground_, surface_, balance_m_yr);
#pragma omp parallel for schedule(static)
    for (std::size_t n = 0; n < cold.cells.size(); ++n) {
      const Index c = cold.cells[n];
      next_[c] = flux_.share.of(c) > kLeastShare ? IceGround::iced : IceGround::bare;
    }
  }
}

double IceAge::cooling_k(const Age& age, int row) const {
  // The poles cool more than twice as much as the equator, the mean is 1 (Tierney et al. 2020).
  const double sine = std::sin(grid_.latitude_deg(row) * std::numbers::pi / 180.0);
  return age.cooling_k * (0.7 + 0.9 * sine * sine);
}

/// Ice keeps to where it could live.
void IceAge::sort_ground(const LandClimate& climate, const Age& age,
                         std::span<const float> elevation_m) {
  const double warmest = 1e3 * kMostMelt_m_yr / snow_.ice_melt_mm_k_d;
  const auto sort_row = [&](int j, LandClimate::Reader& temperatures, LandClimate::Reader& ranges) {
    const double cooling = cooling_k(age, j);
    const Index row = grid_.cell(0, j);
    const auto temperature_c = temperatures.row(j), range_k = ranges.row(j);
    for (int i = 0; i < grid_.nx(); ++i) {
      const Index c = row + i;
      const bool stands = elevation_m[c] >= -age.grounding_m;
      if (stands) {
        const double mean_c =
            temperature_c[i] - cooling - kLapse_K_m * std::max(0.0F, elevation_m[c]);
        // The mean alone has so many degree-days, twelve warmest months no more than these.
        const double most_c = std::max(0.0, mean_c + 0.5 * range_k[i]) + 0.4 * snow_.scatter_k;
        const bool may_be = snow_.year_d * mean_c <= warmest;
        if (may_be && (snow_.year_d * most_c <= warmest ||
                       frost_of_year(snow_, mean_c, range_k[i]).degree_days <= warmest)) {
          if (next_[c] == IceGround::away) next_[c] = IceGround::bare;
          continue;
        }
      }
      next_[c] = IceGround::away;
    }
  };
  ParallelErrors errors;
#pragma omp parallel
  {
    auto temperatures = errors.make<std::optional<LandClimate::Reader>>(
        std::in_place, climate, grid_, climate.sea_level_temperature_c);
    auto ranges = errors.make<std::optional<LandClimate::Reader>>(std::in_place, climate, grid_,
                                                                  climate.range_k);
#pragma omp for schedule(dynamic, 8)
    for (int j = 0; j < grid_.ny(); ++j) {
      if (!errors.any()) sort_row(j, *temperatures, *ranges);
    }
  }
  errors.rethrow();
}

IceAge::Cold IceAge::cold_cells(const LandClimate& climate) const {
  Cold cold;
  std::vector<std::size_t> first_of_row(static_cast<std::size_t>(grid_.ny()) + 1, 0);
  const auto visit_row = [&](int j, auto&& visit) {
    for (Index c = grid_.cell(0, j); c < grid_.cell(0, j) + grid_.nx(); ++c) {
      if (next_[c] != IceGround::away) visit(c);
    }
  };
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid_.ny(); ++j) visit_row(j, [&](Index) { ++first_of_row[j + 1]; });
  std::partial_sum(first_of_row.begin(), first_of_row.end(), first_of_row.begin());
  cold.cells.resize(first_of_row.back());
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid_.ny(); ++j) {
    std::size_t next = first_of_row[j];
    visit_row(j, [&](Index c) { cold.cells[next++] = c; });
  }
  const auto gather = [&](const std::vector<float>& field) {
    std::vector<float> values(cold.cells.size());
    ParallelErrors errors;
#pragma omp parallel
    {
      auto reader =
          errors.make<std::optional<LandClimate::Reader>>(std::in_place, climate, grid_, field);
#pragma omp for schedule(dynamic, 8)
      for (int j = 0; j < grid_.ny(); ++j) {
        if (errors.any() || first_of_row[j] == first_of_row[j + 1]) continue;
        const auto of_row = reader->row(j);
        for (std::size_t n = first_of_row[j]; n < first_of_row[j + 1]; ++n) {
          values[n] = of_row[grid_.column(cold.cells[n])];
        }
      }
    }
    errors.rethrow();
    return values;
  };
  cold.sea_level_temperature_c = gather(climate.sea_level_temperature_c);
  cold.range_k = gather(climate.range_k);
  cold.precipitation_mm_yr = gather(climate.precipitation_mm_yr);
  cold.summer_rain = gather(climate.summer_rain);
  cold.knows_ice = !climate.ice_m.empty();
  cold.balanced_at_m.assign(cold.cells.size(), std::numeric_limits<float>::quiet_NaN());
  return cold;
}

void IceAge::balance(Cold& cold, const Age& age, std::span<const float> elevation_m,
                     SparseValues<float>& balance_m_yr) const {
  std::vector<double> cooling_of_row(grid_.ny());
  for (int j = 0; j < grid_.ny(); ++j) cooling_of_row[j] = cooling_k(age, j);
#pragma omp parallel for schedule(static)
  for (std::size_t n = 0; n < cold.cells.size(); ++n) {
    const Index c = cold.cells[n];
    const double surface = surface_.height_m.of(c);
    if (surface == cold.balanced_at_m[n]) continue;
    cold.balanced_at_m[n] = surface_.height_m.of(c);
    const double cooling = cooling_of_row[grid_.row(c)];
    const double ground = std::max(0.0F, elevation_m[c]);
    const double mean_c = cold.sea_level_temperature_c[n] - cooling - kLapse_K_m * surface;
    const double higher_m = cold.knows_ice ? 0.0 : std::max(0.0, surface - ground);
    const double colder_k = cooling + kLapse_K_m * higher_m;
    const double rain = cold.precipitation_mm_yr[n] * std::exp(-kDrier_1_K * colder_k);
    balance_m_yr.of(c) = static_cast<float>(
        snow_balance_m_yr(snow_, mean_c, cold.range_k[n], rain, cold.summer_rain[n]));
  }
}

/// How far the ice of this time holds the ground down.
void IceAge::weigh(std::span<const float> elevation_m) {
  const auto part = static_cast<float>(p_.rebound_fraction > 0.0 ? kIceOverMantle : 0.0);
#pragma omp parallel for schedule(static)
  for (Index c = 0; c < grid_.size(); ++c) {
    sunk_m_[c] = 0.0F;
    if (ground_[c] != IceGround::iced || elevation_m[c] < 0.0F) continue;
    sunk_m_[c] = part * flux_.share.of(c) * std::max(0.0F, surface_.height_m.of(c) - bed_m_[c]);
  }
  if (p_.rebound_length_km > 0.0) smooth_broadly(grid_, sunk_m_, 1e3 * p_.rebound_length_km);
#pragma omp parallel for schedule(static)
  for (Index c = 0; c < grid_.size(); ++c) sunk_m_[c] = std::max(0.0F, sunk_m_[c]);
}

void IceAge::report(Budget& budget) const {
  budget["ice_snow_m3_yr"] = flux_.accumulated_m3_yr;
  budget["ice_melt_m3_yr"] = flux_.melted_m3_yr;
  budget["ice_calving_m3_yr"] = flux_.calved_m3_yr;
  budget["ice_closing_error"] =
      (flux_.accumulated_m3_yr - flux_.melted_m3_yr - flux_.calved_m3_yr) /
      std::max(1.0, flux_.accumulated_m3_yr);
  budget["ice_m3"] = area_sum<double>(grid_, [&](Index c) { return thickness_m_[c]; });
}

}  // namespace geo
