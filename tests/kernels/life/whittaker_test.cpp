#include "geo/kernels/life/whittaker.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "geo/kernels/life/productivity.hpp"

namespace geo {
namespace {

TEST(Productivity, MiamiModelAtTenDegreesAndEightHundredMillimetres) {
  EXPECT_NEAR(miami_productivity(10, 800), 1236.3, 0.05);
  EXPECT_NEAR(miami_productivity(30, 800), 1236.3, 0.05) << "water limits";
  EXPECT_NEAR(miami_productivity(-10, 800), 3000 / (1 + std::exp(1.315 + 1.19)), 1e-9);
  EXPECT_EQ(miami_productivity(25, 0), 0.0);
}

TEST(Productivity, FarmingEndsAtFourAndAHalfKilometres) {
  EXPECT_EQ(altitude_factor(-100), 1.0);
  EXPECT_EQ(altitude_factor(500), 1.0);
  EXPECT_DOUBLE_EQ(altitude_factor(2500), 0.5);
  EXPECT_EQ(altitude_factor(5000), 0.0);
}

TEST(Whittaker, CentroidsAreTheirOwnBiomes) {
  EXPECT_EQ(nearest_biome(-8, 250), Biome::tundra);
  EXPECT_EQ(nearest_biome(2, 600), Biome::boreal_forest);
  EXPECT_EQ(nearest_biome(12, 1200), Biome::temperate_forest);
  EXPECT_EQ(nearest_biome(10, 500), Biome::temperate_grassland);
  EXPECT_EQ(nearest_biome(16, 550), Biome::mediterranean_scrub);
  EXPECT_EQ(nearest_biome(25, 2500), Biome::tropical_rainforest);
  EXPECT_EQ(nearest_biome(25, 1000), Biome::tropical_savanna);
  EXPECT_EQ(nearest_biome(25, 150), Biome::hot_desert);
  EXPECT_EQ(nearest_biome(20, 1400), Biome::subtropical_forest);
  EXPECT_EQ(nearest_biome(8, 350), Biome::steppe);
  EXPECT_EQ(nearest_biome(-9, 240, kClimaticBiomes.without(Biome::tundra)), Biome::boreal_forest)
      << "Yakutsk: taiga";
  EXPECT_EQ(nearest_biome(25, 2500, {}), Biome::tundra);
}

// Annual means, ranges and sums from climate tables; rain in summer positive.
TEST(Whittaker, SeasonsTellClimatesOfLikeMeansApart) {
  const auto biome = [](double mean_c, double range_k, double annual_mm, double seasonality) {
    const KoppenIndices climate = harmonic_indices(mean_c, range_k, annual_mm, seasonality);
    return nearest_biome(mean_c, annual_mm, biomes_in_season(seasons_of(climate)));
  };
  EXPECT_EQ(nearest_biome(28, 560), Biome::mediterranean_scrub) << "by means alone";
  EXPECT_EQ(biome(28, 9, 620, 0.9), Biome::tropical_savanna) << "the Sahel";
  EXPECT_EQ(biome(28, 9, 180, 0.9), Biome::hot_desert) << "north of it";
  EXPECT_EQ(biome(27, 3, 1450, 0.6), Biome::tropical_savanna) << "Darwin";
  EXPECT_EQ(biome(26.5, 1.5, 2300, 0.2), Biome::tropical_rainforest) << "Manaus";
  EXPECT_EQ(biome(17.5, 14, 460, -0.9), Biome::mediterranean_scrub) << "Athens, Los Angeles";
  EXPECT_NE(biome(15.5, 22, 560, 0.7), Biome::mediterranean_scrub) << "rain in summer";
  EXPECT_NE(biome(12, 8, 2600, 0.0), Biome::tropical_rainforest) << "wet west coasts";
}

Biome biome_of(const KoppenIndices& climate) {
  return seasonal_biome(climate.mean_c, climate.annual_mm, seasons_of(climate), false);
}

TEST(Whittaker, SummersTellBorealFromTemperateForest) {
  // Both 3 °C and 600 mm: Moscow's and Tromsø's year.
  const auto inland = harmonic_indices(3.0, 32.0, 600.0, 0.3);
  const auto at_sea = harmonic_indices(3.0, 15.0, 600.0, 0.0);
  ASSERT_GE(inland.months_above_10c, 4);
  ASSERT_LE(at_sea.months_above_10c, 3);
  EXPECT_EQ(biome_of(inland), Biome::temperate_forest);
  EXPECT_EQ(biome_of(at_sea), Biome::boreal_forest);
  EXPECT_EQ(nearest_biome(3.0, 600.0), Biome::boreal_forest);
}

TEST(Whittaker, RainforestGrowsWhereTheDrySeasonIsShort) {
  // 1500 mm: all through the year, and in one half of it.
  EXPECT_EQ(biome_of(harmonic_indices(26.0, 2.0, 1500.0, 0.2)), Biome::tropical_rainforest);
  EXPECT_EQ(biome_of(harmonic_indices(26.0, 2.0, 1500.0, 0.9)), Biome::tropical_savanna);
  // 2400 mm outlast a dry month of 20 mm, which would be a savanna's with less rain.
  EXPECT_EQ(biome_of(harmonic_indices(26.0, 2.0, 2400.0, 0.9)), Biome::tropical_rainforest);
  EXPECT_EQ(biome_of(harmonic_indices(16.0, 20.0, 2400.0, 0.0)), Biome::subtropical_forest);
}

TEST(Whittaker, GrowingSeasonMatchesDailySums) {
  for (const auto& [mean, range] : {std::pair{-5.0, 40.0}, {3.0, 20.0}, {0.95, 0.2}, {8.0, 5.0}}) {
    constexpr int kSteps = 200000;
    double sum = 0, warm = 0;
    for (int n = 0; n < kSteps; ++n) {
      const double t = mean + range / 2 * std::cos(2 * std::numbers::pi * (n + 0.5) / kSteps);
      if (t > 0.9) sum += t, ++warm;
    }
    const GrowingSeason season = growing_season(mean, range, 0.9);
    EXPECT_NEAR(season.mean_c, sum / warm, 1e-3);
    EXPECT_NEAR(season.days, 365.25 * warm / kSteps, 0.01);
  }
  EXPECT_EQ(growing_season(-20, 10, 0.9).days, 0.0);
}

TEST(Whittaker, TreelineStandsWhereSeasonIsTooColdOrTooShort) {
  EXPECT_NEAR(treeline_deficit_k(6.4, 0.0), 0.0, 1e-12) << "tropical mountain: annual mean";
  EXPECT_LT(treeline_deficit_k(-9, 58), 0) << "Yakutsk has trees";
  EXPECT_GT(treeline_deficit_k(-12, 33), 0) << "Barrow has none";
  EXPECT_NEAR(treeline_deficit_k(1.3, 17), 0, 0.5) << "Alps at 2200 m";
  // A season of exactly 94 days with a hot summer: the length decides.
  const double mean = 0.9 - 40 * std::cos(std::numbers::pi * 94 / 365.25);
  EXPECT_NEAR(treeline_deficit_k(mean, 80), 0.0, 1e-9);
}

TEST(SmoothBiomes, RemovesLonePatchesAndKeepsBordersAndCoasts) {
  const Grid grid = Grid::plane(30, 20, 10e3, 10e3);
  std::vector<std::int8_t> biome(grid.size(), 4), scratch(grid.size());
  for (int j = 0; j < 20; ++j) {
    for (int i = 0; i < 30; ++i) {
      if (i < 5) biome[grid.cell(i, j)] = 0;
      if (i > 15) biome[grid.cell(i, j)] = 8;
    }
  }
  auto expected = biome;
  biome[grid.cell(10, 10)] = 3;
  biome[grid.cell(5, 7)] = 7;  // on the coast: the sea may not win
  smooth_biomes(grid, 10e3, biome, scratch);
  EXPECT_EQ(biome, expected);
}

TEST(SmoothBiomes, LengthActsAlikeOnFineGridsAndNotOnCoarseOnes) {
  const Grid fine = Grid::plane(120, 80, 2.5e3, 2.5e3);
  std::vector<std::int8_t> biome(fine.size(), 4), scratch(fine.size());
  for (int j = 40; j < 43; ++j) {  // 7.5 km wide
    for (int i = 60; i < 63; ++i) biome[fine.cell(i, j)] = 3;
  }
  smooth_biomes(fine, 10e3, biome, scratch);
  EXPECT_EQ(biome, std::vector<std::int8_t>(fine.size(), 4));

  const Grid coarse = Grid::plane(30, 20, 40e3, 40e3);
  std::vector<std::int8_t> alone(coarse.size(), 4), space(coarse.size());
  alone[coarse.cell(9, 9)] = 3;
  const auto before = alone;
  smooth_biomes(coarse, 10e3, alone, space);
  EXPECT_EQ(alone, before);
}

TEST(SmoothBiomes, ReachesAcrossThePole) {
  const Grid grid = Grid::sphere(64, 32);
  std::vector<std::int8_t> biome(grid.size(), 1), scratch(grid.size());
  biome[grid.cell(5, 31)] = 3;
  smooth_biomes(grid, grid.spacing_north_m(0), biome, scratch);
  EXPECT_EQ(biome, std::vector<std::int8_t>(grid.size(), 1));
}

TEST(SmoothBiomes, ReachesNoFurtherThanAQuarterRoundASmallPlanet) {
  const Grid grid = Grid::sphere(64, 32);
  std::vector<std::int8_t> biome(grid.size(), 1), scratch(grid.size());
  for (Index cell = 0; cell < grid.size() / 2; ++cell) biome[cell] = 3;
  auto quarter = biome;
  smooth_biomes(grid, 16.0 * grid.spacing_north_m(0), quarter, scratch);
  smooth_biomes(grid, 1e12, biome, scratch);
  EXPECT_EQ(biome, quarter);
}

}  // namespace
}  // namespace geo
