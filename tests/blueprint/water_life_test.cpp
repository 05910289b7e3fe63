// Sections 6 to 8: rivers, biomes, settlement.
#include <gtest/gtest.h>

#include "blueprint.hpp"
#include "geo/kernels/climate/blueprint_climate.hpp"
#include "geo/kernels/life/whittaker.hpp"
#include "geo/kernels/water/rivers.hpp"

namespace geo {
namespace {

using test::planet;

TEST(BlueprintHydrology, RiversAreAsStrongAsTheirAreaOverTheLargest) {
  const Grid& grid = planet().grid();
  const auto z = planet().read("hydrology", field::elevation);
  const auto area = planet().read("hydrology", field::drainage_area);
  const auto slope = planet().read("hydrology", field::slope);
  const auto river = planet().read("hydrology", field::river_intensity);
  // (6.4): the share of all cells from which rivers show, after one round of carving; 4 pi R2 is
  // the area of all cells.
  const double sphere_m2 = 4.0 * std::numbers::pi * std::pow(1e3 * test::kRadius_km, 2);
  const double threshold = (0.00018 + 1 * 0.00007) * sphere_m2;
  double a_max = 0.0;
  for (Index c = 0; c < grid.size(); ++c) {
    if (z[c] >= 0.0F) a_max = std::max(a_max, area[c]);
  }
  int rivers = 0;
  float strongest = 0.0F;
  for (Index c = 0; c < grid.size(); ++c) {
    double expected = 0.0;
    if (z[c] >= 0.0F && area[c] > threshold) {
      const double drop_m = 9770.0 * slope[c];  // from cell to cell of the document's grid
      expected = std::pow((area[c] - threshold) / (a_max - threshold), 0.45) *  // (6.5)
                 (0.34 + 0.86 * drop_m / (drop_m + 35.0));
      ++rivers;
    }
    ASSERT_NEAR(river[c], std::min(1.0, expected), 1e-4) << "cell " << c;
    strongest = std::max(strongest, river[c]);
  }
  EXPECT_GT(rivers, 50);
  EXPECT_GT(strongest, 0.3F);
}

TEST(BlueprintHydrology, ValleysAreThoseOfOneRunoffEverywhere) {
  // (6.6a): 400 mm/yr whatever the climate: no rain, and the same valleys.
  const auto carved = [&](float rain_mm_yr) {
    State state = planet().after.at("climate");
    state.set(field::elevation,
              std::vector<float>(planet().read("erosion", field::elevation).begin(),
                                 planet().read("erosion", field::elevation).end()));
    std::ranges::fill(state.update(field::precipitation), rain_mm_yr);
    const auto made = test::go_on(std::move(state), "hydrology", "hydrology");
    const auto z = made.read("hydrology", field::elevation);
    return std::vector<float>(z.begin(), z.end());
  };
  const auto wet = carved(3000.0F), dry = carved(30.0F);
  EXPECT_EQ(wet, dry);
  const auto before = planet().read("erosion", field::elevation);
  double deepest = 0.0;
  for (std::size_t c = 0; c < wet.size(); ++c) {
    deepest = std::max<double>(deepest, before[c] - wet[c]);
  }
  EXPECT_GT(deepest, 20.0);
}

TEST(BlueprintHydrology, AValleyIsSixteenTimesQToThe036) {
  // (6.6b), (6.6c): 80 bankfull depths of 0.2 Q^0.36; 23 % of the height at most; above 1600 m 42 %
  // of the cut is held back.
  const Grid grid = Grid::plane(4, 3, 1e4, 1e4);
  std::vector<std::uint8_t> sea(12, 0);
  sea[0] = 1;
  for (const auto& [height_m, q] : {std::pair(1500.0, 800.0), {1500.0, 1e5}, {3000.0, 800.0}}) {
    std::vector<float> z(12, static_cast<float>(height_m));
    z[0] = -10.0F;
    FlowGraph graph;
    graph.receiver = {0, 0, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
    graph.order = {11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0};
    std::vector<double> discharge(12, 0.0);
    discharge[1] = q;
    carve_valleys(grid, graph, sea, discharge,
                  {.factor = 1.0, .rounds = 1.0, .threshold_m3_s = 1.0, .side_blend = 0.0}, z);
    const double cut = std::min(80.0 * 0.2 * std::pow(q, 0.36), 0.23 * height_m);
    EXPECT_NEAR(z[1], height_m > 1600.0 ? height_m - cut + 0.42 * cut : height_m - cut, 0.01);
  }
}

struct Centroid {
  int id;
  double t, p;
};
constexpr std::array<Centroid, 10> kCentroids{{{1, -8, 250},
                                               {2, 2, 600},
                                               {3, 12, 1200},
                                               {4, 10, 500},
                                               {5, 16, 550},
                                               {6, 25, 2500},
                                               {7, 25, 1000},
                                               {8, 25, 150},
                                               {9, 20, 1400},
                                               {11, 8, 350}}};

int nearest(double t, double p) {  // (7.1)
  int best = 0;
  double least = 1e300;
  for (const Centroid& k : kCentroids) {
    const double d = std::pow(t / 15 - k.t / 15, 2) + std::pow(p / 500 - k.p / 500, 2);
    if (d < least) {
      least = d;
      best = k.id;
    }
  }
  return best;
}
bool is_forest_or_grass(int biome) {
  return biome == 2 || biome == 3 || biome == 4 || biome == 6 || biome == 9;
}

TEST(BlueprintBiomes, AreTheNearestCentroids) {
  const Grid& grid = planet().grid();
  const auto z = planet().read("hydrology", field::elevation);
  const auto t = planet().read("climate", field::temperature);
  const auto p = planet().read("climate", field::precipitation);
  const auto river = planet().read("hydrology", field::river_intensity);
  const auto biome = planet().read("biomes", field::biome);
  int alpine = 0, corridors = 0;
  for (Index c = 0; c < grid.size(); ++c) {
    if (z[c] < 0.0F) {
      ASSERT_EQ(biome[c], 0);
      continue;
    }
    int expected = nearest(t[c], p[c]);
    if (is_forest_or_grass(expected) && z[c] > 1700.0F) {
      if (z[c] < 2300.0F) continue;  // (7.2): 2000 +- 300 m, soft from 1700 m on
      expected = 10;
      ++alpine;
    }
    const bool dry = expected == 4 || expected == 5 || expected == 8 || expected == 11;
    if (dry && river[c] > 0.12F) {  // (7.3)
      ASSERT_TRUE(biome[c] == 7 || biome[c] == 3 || biome[c] == 2) << "cell " << c;
      ++corridors;
      continue;
    }
    ASSERT_EQ(biome[c], expected) << "cell " << c << " at " << z[c] << " m";
  }
  EXPECT_GT(alpine + corridors, 0);
}

TEST(BlueprintBiomes, SmoothingTakesLonelyTreesAwayAfterTheRivers) {
  // 7.5: a river of single cells through a desert is what the filter removes.
  State state = test::bare(128);
  const Grid& grid = state.grid();
  std::ranges::fill(state.update(field::elevation), 300.0F);
  std::ranges::fill(state.update(field::temperature), 25.0F);
  std::ranges::fill(state.update(field::temperature_range), 5.0F);
  std::ranges::fill(state.update(field::precipitation), 150.0F);
  (void)state.update(field::precipitation_seasonality);
  const auto river = state.update(field::river_intensity);
  const Index lonely = grid.cell(40, 32);
  river[lonely] = 0.5F;
  for (int i = 60; i < 100; ++i) {
    for (int j = 30; j < 34; ++j) river[grid.cell(i, j)] = 0.5F;  // as broad as a delta
  }
  const auto one_cell = "biomes.smoothing_km=" + std::to_string(1e-3 * grid.spacing_north_m(0));
  const auto made = test::go_on(std::move(state), "biomes", "biomes", {one_cell});
  const auto biome = made.read("biomes", field::biome);
  EXPECT_EQ(biome[lonely], static_cast<int>(Biome::hot_desert));
  EXPECT_EQ(biome[grid.cell(80, 32)], static_cast<int>(Biome::tropical_savanna));
}

double npp_g_m2_yr(double t, double p) {
  const double by_t = 3000 / (1 + std::exp(1.315 - 0.119 * t));  // (8.1)
  const double by_p = 3000 * (1 - std::exp(-0.000664 * p));      // (8.2)
  return std::min(by_t, by_p);
}

TEST(BlueprintSettlement, IsProductivityTimesTheElevationFactor) {
  const Grid& grid = planet().grid();
  const auto z = planet().read("hydrology", field::elevation);
  const auto lake = planet().read("hydrology", field::lake_depth);
  const auto t = planet().read("climate", field::temperature);
  const auto p = planet().read("climate", field::precipitation);
  const auto npp = planet().read("biomes", field::net_primary_productivity);
  const auto settlement = planet().read("biomes", field::settlement_suitability);
  for (Index c = 0; c < grid.size(); ++c) {
    if (z[c] < 0.0F || lake[c] > 0.0F) continue;
    ASSERT_NEAR(npp[c], npp_g_m2_yr(t[c], p[c]), 0.05);
    const double elev_factor = std::max(1.0 - std::max(z[c] - 500.0, 0.0) / 4000.0, 0.0);
    ASSERT_NEAR(settlement[c], std::clamp(npp[c] / 2500.0 * elev_factor, 0.0, 1.0), 1e-5);  // (8.3)
  }
}

TEST(BlueprintSettlement, IslandsAddRiversAndTheSeaAround) {
  // (8.5) on a plain with a straight shore: 0.25 river + 0.15 exposure within 60 km.
  State state = test::bare(512);
  const Grid& grid = state.grid();
  const auto z = state.update(field::elevation);
  for (Index c = 0; c < grid.size(); ++c) z[c] = grid.column(c) < 256 ? -100.0F : 100.0F;
  std::ranges::fill(state.update(field::temperature), 2.0F);
  (void)state.update(field::temperature_range);
  std::ranges::fill(state.update(field::precipitation), 400.0F);
  (void)state.update(field::precipitation_seasonality);
  const auto river = state.update(field::river_intensity);
  const Index shore = grid.cell(256, 128), inland = grid.cell(300, 128), bank = grid.cell(310, 128);
  river[bank] = 0.6F;
  const auto made = test::go_on(std::move(state), "biomes", "biomes",
                                {"biomes.river_weight=0.25", "biomes.coast_weight=0.15"});
  const auto settlement = made.read("biomes", field::settlement_suitability);
  const double base = npp_g_m2_yr(2.0, 400.0) / 2500.0;
  EXPECT_NEAR(settlement[inland], base, 1e-5);
  EXPECT_NEAR(settlement[bank], base + 0.25 * 0.6, 1e-5);
  // The shore's cell is 78 km wide: its middle has its sea 39 km to the west, which is the segment
  // beyond 39 of 60 km of a disc: acos(0.65) / pi - 0.65 sqrt(1 - 0.65^2) / pi = 0.117. The shares
  // of land are interpolated between cells.
  EXPECT_NEAR(settlement[shore], base + 0.15 * 0.117, 0.15 * 0.1);
  EXPECT_GT(settlement[shore], base + 0.005);
}

}  // namespace
}  // namespace geo
