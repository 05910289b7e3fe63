#include "geo/stages/biomes/biomes.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "geo/core/random.hpp"
#include "geo/kernels/life/settlement.hpp"

namespace geo {
namespace {

// A planet whose climate goes from pole to pole and whose height goes round the equator.
State make_planet(int nx, int ny) {
  State state(std::make_shared<Grid>(Grid::sphere(nx, ny)));
  const Grid& grid = state.grid();
  const auto z = state.update(field::elevation), t = state.update(field::temperature);
  const auto r = state.update(field::temperature_range), p = state.update(field::precipitation);
  const auto s = state.update(field::precipitation_seasonality);
  const auto river = state.update(field::river_intensity);
  const auto lake = state.update(field::lake_depth);
  for (int j = 0; j < ny; ++j) {
    const double latitude = grid.latitude_deg(j);
    for (int i = 0; i < nx; ++i) {
      const Index c = grid.cell(i, j);
      const double around = 2 * std::numbers::pi * i / nx;
      z[c] = static_cast<float>(1500 + 2500 * std::sin(3 * around));
      t[c] = static_cast<float>(28 - 0.007 * latitude * latitude - 0.006 * std::max(z[c], 0.0F));
      r[c] = static_cast<float>(0.5 * std::abs(latitude));
      p[c] = static_cast<float>(900 + 800 * std::cos(around));
      s[c] = static_cast<float>(std::sin(around));
      river[c] = i % 17 == 0 ? 0.5F : 0.0F;
      lake[c] = i % 29 == 0 && z[c] >= 0 ? 10.0F : 0.0F;
    }
  }
  return state;
}

void run(State& state, BiomesParameters parameters = {}) {
  const auto stage = make_biomes_stage(std::move(parameters));
  StageIo io(state, stage->info());
  Context context;
  stage->run(io, context);
}

TEST(Biomes, LandHasABiomeAndTheSeaHasNone) {
  State state = make_planet(360, 180);
  run(state);
  const auto z = state.read(field::elevation);
  const auto biome = state.read(field::biome), koppen = state.read(field::koppen_class);
  const auto npp = state.read(field::net_primary_productivity);
  const auto settlement = state.read(field::settlement_suitability);
  for (Index c = 0; c < state.grid().size(); ++c) {
    ASSERT_EQ(biome[c] != 0, z[c] >= 0);
    ASSERT_EQ(koppen[c] != 0, z[c] >= 0);
    ASSERT_LT(biome[c], kBiomes);
    ASSERT_LE(koppen[c], 30);
    ASSERT_TRUE(npp[c] >= 0 && npp[c] <= 3000);
    ASSERT_TRUE(settlement[c] >= 0 && settlement[c] <= 1);
  }
}

TEST(Biomes, AlpineStandsOnMountainsAndTundraNearThePoles) {
  State state = make_planet(720, 360);
  BiomesParameters parameters;
  parameters.treeline_noise_m = 0;
  run(state, parameters);
  const Grid& grid = state.grid();
  const auto z = state.read(field::elevation);
  const auto biome = state.read(field::biome);
  double lowest_at_equator = 1e9, lowest_at_45 = 1e9;
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      const Index c = grid.cell(i, j);
      const double latitude = std::abs(grid.latitude_deg(j));
      if (biome[c] == static_cast<int>(Biome::tundra)) {
        ASSERT_GT(latitude, 55);
      }
      if (biome[c] != static_cast<int>(Biome::alpine)) continue;
      if (latitude < 1) lowest_at_equator = std::min<double>(lowest_at_equator, z[c]);
      if (latitude > 44 && latitude < 46) lowest_at_45 = std::min<double>(lowest_at_45, z[c]);
    }
  }
  EXPECT_NEAR(lowest_at_equator, (28 - 6.4) / 0.006, 60);  // about 3600 m
  EXPECT_NEAR(lowest_at_45, 2600, 300);  // between the Alps and the Rocky Mountains
}

TEST(Biomes, BorderOfAlpineLandAndTundraFollowsTheRelief) {
  State state = make_planet(720, 360);
  BiomesParameters parameters;
  parameters.treeline_noise_m = 0;
  parameters.smoothing_km = 0;
  run(state, parameters);
  const Grid& grid = state.grid();
  const auto z = state.read(field::elevation);
  const auto biome = state.read(field::biome);
  double poleward_most_alpine = 0, equatorward_most_tundra = 90;
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      const Index c = grid.cell(i, j);
      const double latitude = std::abs(grid.latitude_deg(j));
      if (biome[c] == static_cast<int>(Biome::alpine)) {
        ASSERT_GE(z[c], parameters.mountain_m);
        poleward_most_alpine = std::max(poleward_most_alpine, latitude);
      } else if (biome[c] == static_cast<int>(Biome::tundra)) {
        equatorward_most_tundra = std::min(equatorward_most_tundra, latitude);
      }
    }
  }
  // Low treeless land is tundra, high land alpine, over a belt that no parallel cuts.
  EXPECT_GT(poleward_most_alpine, equatorward_most_tundra + 5);
}

TEST(Biomes, FixedTreelineIsTwoThousandMetresAndSoftFromSeventeenHundred) {
  State state = make_planet(1440, 720);
  BiomesParameters parameters;
  parameters.treeline = "fixed";
  parameters.treeline_noise_m = 0;
  parameters.smoothing_km = 0;
  parameters.riparian_threshold = 1;
  run(state, parameters);
  const auto z = state.read(field::elevation);
  const auto biome = state.read(field::biome);
  int inside = 0, alpine_inside = 0, alpine_below = 0, forest_above = 0;
  for (Index c = 0; c < state.grid().size(); ++c) {
    const bool alpine = biome[c] == static_cast<int>(Biome::alpine);
    const bool forest = biome[c] == static_cast<int>(Biome::subtropical_forest) ||
                        biome[c] == static_cast<int>(Biome::temperate_forest) ||
                        biome[c] == static_cast<int>(Biome::temperate_grassland) ||
                        biome[c] == static_cast<int>(Biome::boreal_forest);
    if (z[c] > 1700 && z[c] < 2000 && (alpine || forest)) ++inside, alpine_inside += alpine;
    if (z[c] < 1690) alpine_below += alpine;
    if (z[c] > 2010) forest_above += forest;
  }
  EXPECT_GT(alpine_inside, 0.2 * inside);
  EXPECT_LT(alpine_inside, 0.8 * inside);
  EXPECT_EQ(alpine_below, 0);
  EXPECT_EQ(forest_above, 0);
}

TEST(Biomes, RiversCarryTreesThroughDryLand) {
  State with = make_planet(360, 180), without = make_planet(360, 180);
  run(with);
  without.erase(field::river_intensity);
  run(without);
  const auto wet = with.read(field::biome), dry = without.read(field::biome);
  const auto t = with.read(field::temperature), river = with.read(field::river_intensity);
  int changed = 0;
  for (Index c = 0; c < with.grid().size(); ++c) {
    if (dry[c] == wet[c]) continue;
    ++changed;
    ASSERT_GT(river[c], 0.12);
    ASSERT_EQ(wet[c] == static_cast<int>(Biome::tropical_savanna), t[c] >= 18);
  }
  EXPECT_GT(changed, 100);
}

TEST(Biomes, SettlementByLimitsFallsWithSlopeAndIsWateredByRivers) {
  State state = make_planet(360, 180), flat = make_planet(360, 180);
  for (float& z : flat.update(field::elevation)) z = z < 0.0F ? z : 10.0F;
  const auto steps = state.update(field::elevation);  // from cell to cell, 2 km
  for (std::size_t c = 0; c < steps.size(); c += 2) steps[c] += steps[c] < 0.0F ? 0.0F : 2000.0F;
  run(state);
  run(flat);
  const auto z = state.read(field::elevation), t = state.read(field::temperature);
  const auto river = state.read(field::river_intensity), lake = state.read(field::lake_depth);
  const auto steep = state.read(field::settlement_suitability);
  const auto even = flat.read(field::settlement_suitability);
  const auto range = state.read(field::temperature_range), rain = state.read(field::precipitation);
  const auto seasonality = state.read(field::precipitation_seasonality);
  int watered = 0, lower = 0;
  for (Index c = 0; c < state.grid().size(); ++c) {
    if (z[c] < 0 || lake[c] > 0) continue;
    const SettlementLimits limits =
        settlement_limits(harmonic_months(t[c], range[c], rain[c], seasonality[c]));
    ASSERT_LE(steep[c], even[c] + 1e-6);
    ASSERT_GE(even[c], limits.product() - 1e-5);
    if (river[c] > 0.12F) {
      ASSERT_NEAR(even[c], limits.warmth * limits.heat * limits.soil, 1e-5);
      watered += limits.water < 0.5 ? 1 : 0;
    }
    lower += steep[c] < even[c] - 0.01F ? 1 : 0;
  }
  EXPECT_GT(watered, 10);
  EXPECT_GT(lower, 100);
}

TEST(Biomes, SettlementFollowsProductivityAltitudeAndRivers) {
  State state = make_planet(360, 180), bonus = make_planet(360, 180);
  BiomesParameters parameters;
  parameters.settlement = "productivity";
  run(state, parameters);
  parameters.river_weight = 0.25;
  run(bonus, parameters);
  const auto z = state.read(field::elevation), npp = state.read(field::net_primary_productivity);
  const auto plain = state.read(field::settlement_suitability);
  const auto rich = bonus.read(field::settlement_suitability);
  const auto river = state.read(field::river_intensity), lake = state.read(field::lake_depth);
  for (Index c = 0; c < state.grid().size(); ++c) {
    const double height = std::max(1 - std::max(z[c] - 500.0, 0.0) / 4000, 0.0);
    ASSERT_NEAR(plain[c], std::clamp(npp[c] / 2500 * height, 0.0, 1.0), 1e-6);
    if (z[c] < 0 || lake[c] > 0) {
      ASSERT_EQ(rich[c], 0);
    } else {
      ASSERT_NEAR(rich[c], std::min(plain[c] + 0.25 * river[c], 1.0), 1e-6);
    }
  }
}

TEST(Biomes, SameBitsForAnyNumberOfThreads) {
  State one = make_planet(360, 180), four = make_planet(360, 180);
  omp_set_num_threads(1);
  run(one);
  omp_set_num_threads(4);
  run(four);
  omp_set_num_threads(omp_get_num_procs());
  const auto a = one.read(field::biome), b = four.read(field::biome);
  EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin()));
}

}  // namespace
}  // namespace geo
