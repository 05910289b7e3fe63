#include "geo/kernels/life/whittaker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geo/core/array_sizes.hpp"

namespace geo {
namespace {

struct Centroid {
  Biome biome;
  double temperature_c, precipitation_mm;
};
constexpr std::array kCentroids{
    Centroid{Biome::tundra, -8, 250},
    Centroid{Biome::boreal_forest, 2, 600},
    Centroid{Biome::temperate_forest, 12, 1200},
    Centroid{Biome::temperate_grassland, 10, 500},
    Centroid{Biome::mediterranean_scrub, 16, 550},
    Centroid{Biome::tropical_rainforest, 25, 2500},
    Centroid{Biome::tropical_savanna, 25, 1000},
    Centroid{Biome::hot_desert, 25, 150},
    Centroid{Biome::subtropical_forest, 20, 1400},
    Centroid{Biome::steppe, 8, 350},
};

constexpr int kSweeps = 2;
constexpr auto kOcean = static_cast<std::int8_t>(Biome::ocean);

// Cells a number of rows and columns away; rows wrap or cross the pole as the topology says.
// kNoCell beyond the edge of a plane.
Index displaced(const Grid& grid, int column, int row, int columns, int rows) {
  int i = column + columns, j = row + rows;
  if (grid.topology() == Topology::plane) {
    return i < 0 || i >= grid.nx() || j < 0 || j >= grid.ny() ? kNoCell : grid.cell(i, j);
  }
  if (grid.topology() == Topology::torus) {
    j = (j % grid.ny() + grid.ny()) % grid.ny();
  } else if (j < 0 || j >= grid.ny()) {
    j = j < 0 ? -1 - j : 2 * grid.ny() - 1 - j;
    i += grid.nx() / 2;
  }
  i = (i % grid.nx() + grid.nx()) % grid.nx();
  return grid.cell(i, j);
}

std::int8_t majority(const std::array<std::int8_t, 4>& around, std::int8_t own) {
  std::array<int, kBiomes> count{};
  for (const std::int8_t b : around) ++count[b];
  if (count[own] >= 2) return own;
  const auto best = std::max_element(count.begin() + 1, count.end());  // 0 is the sea
  return *best == 0 ? own : static_cast<std::int8_t>(best - count.begin());
}

}  // namespace

Biome nearest_biome(double temperature_c, double precipitation_mm_yr, BiomeSet among) {
  double nearest = 1e300;
  Biome biome = Biome::tundra;
  for (const Centroid& c : kCentroids) {
    if (!among.has(c.biome)) continue;
    const double t = (temperature_c - c.temperature_c) / 15;
    const double p = (precipitation_mm_yr - c.precipitation_mm) / 500;
    const double distance = t * t + p * p;
    if (distance < nearest) {
      nearest = distance;
      biome = c.biome;
    }
  }
  return biome;
}

BiomeSet biomes_in_season(const KoppenSeasons& seasons) {
  if (seasons.tropical) {
    return {Biome::tropical_rainforest, Biome::tropical_savanna, Biome::hot_desert};
  }
  const BiomeSet cooler = kClimaticBiomes.without(Biome::tropical_rainforest);
  return seasons.dry_summers ? cooler : cooler.without(Biome::mediterranean_scrub);
}

Biome seasonal_biome(double temperature_c, double precipitation_mm_yr, const KoppenSeasons& seasons,
                     bool with_tundra) {
  const BiomeSet among = biomes_in_season(seasons);
  const Biome nearest = nearest_biome(temperature_c, precipitation_mm_yr,
                                      with_tundra ? among : among.without(Biome::tundra));
  if (nearest == Biome::boreal_forest || nearest == Biome::temperate_forest) {
    return seasons.short_summers ? Biome::boreal_forest : Biome::temperate_forest;
  }
  const bool canopy = seasons.tropical && seasons.rainforest;
  return canopy && nearest == Biome::tropical_savanna ? Biome::tropical_rainforest : nearest;
}

GrowingSeason growing_season(double mean_c, double range_k, double threshold_c) {
  constexpr double kYear_days = 365.25;
  const double half = 0.5 * range_k;
  if (mean_c - half >= threshold_c) return {mean_c, kYear_days};
  if (mean_c + half <= threshold_c) return {mean_c + half, 0.0};
  const double cosine = (threshold_c - mean_c) / half;
  const double angle = std::acos(cosine);
  const double sine = std::sqrt(1 - cosine * cosine);
  return {mean_c + half * sine / angle, kYear_days * angle / std::numbers::pi};
}

double treeline_deficit_k(double mean_c, double range_k) {
  const GrowingSeason season = growing_season(mean_c, range_k, kSeasonThreshold_c);
  // Warming that makes the season long enough: its ends lie at the angle of 47 days.
  static const double kCosine = std::cos(std::numbers::pi * kSeasonLength_days / 365.25);
  const double by_length = kSeasonThreshold_c - 0.5 * range_k * kCosine - mean_c;
  return std::max(kTreelineSeason_c - season.mean_c, by_length);
}

void smooth_biomes(const Grid& grid, double length_m, std::span<std::int8_t> biome,
                   std::span<std::int8_t> scratch) {
  check_sizes("smooth_biomes", grid.size(), {{"biome", biome.size()}, {"scratch", scratch.size()}});
  // At most a quarter of the grid, however small its planet is.
  const auto cells_in = [&](double spacing_m, int all) {
    return static_cast<int>(std::min(std::round(length_m / spacing_m), std::max(1.0, all / 4.0)));
  };
  const int rows = cells_in(grid.spacing_north_m(0), grid.ny());
  if (rows == 0) return;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    std::copy(biome.begin(), biome.end(), scratch.begin());
#pragma omp parallel for schedule(dynamic, 16)
    for (int j = 0; j < grid.ny(); ++j) {
      const int columns = std::max(1, cells_in(grid.spacing_east_m(j), grid.nx()));
      for (int i = 0; i < grid.nx(); ++i) {
        const Index c = grid.cell(i, j);
        const std::int8_t own = scratch[c];
        if (own == kOcean) continue;
        std::array<std::int8_t, 4> around;
        const bool inside =
            i >= columns && i < grid.nx() - columns && j >= rows && j < grid.ny() - rows;
        if (inside) {
          const Index up = rows * grid.nx();
          around = {scratch[c + up], scratch[c + columns], scratch[c - up], scratch[c - columns]};
        } else {
          const std::array<Index, 4> cells{
              displaced(grid, i, j, 0, rows), displaced(grid, i, j, columns, 0),
              displaced(grid, i, j, 0, -rows), displaced(grid, i, j, -columns, 0)};
          for (int k = 0; k < 4; ++k) around[k] = cells[k] == kNoCell ? own : scratch[cells[k]];
        }
        biome[c] = majority(around, own);
      }
    }
  }
}

}  // namespace geo
