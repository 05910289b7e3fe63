#include "geo/kernels/water/rivers.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geo/kernels/water/breaching.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "support/terrain.hpp"

namespace geo {
namespace {

int count_pits(const Grid& grid, std::span<const float> z, std::span<const std::uint8_t> outlets) {
  std::vector<Index> receiver(grid.size());
  steepest_receivers(grid, z, outlets, receiver);
  int pits = 0;
  for (Index c = 0; c < grid.size(); ++c) pits += receiver[c] == c && outlets[c] == 0;
  return pits;
}

TEST(Rivers, ValleyDepthIsSixteenTimesDischargeToThePowerThirtySixHundredths) {
  EXPECT_DOUBLE_EQ(valley_depth(1.0), 16.0);
  EXPECT_NEAR(valley_depth(1000.0), 192.4, 0.1);
  EXPECT_EQ(valley_depth(0.0), 0.0);
}

TEST(Rivers, ProminenceGrowsWithDischargeAndSlopeAndStaysWithinOne) {
  const RiverScale scale{100, 20000};
  EXPECT_EQ(river_prominence(100, 0.01, scale), 0.0F);
  EXPECT_NEAR(river_prominence(20000, 0.0, scale), 0.34, 1e-6);
  EXPECT_NEAR(river_prominence(20000, 0.0035, scale), 0.77, 1e-6);
  EXPECT_EQ(river_prominence(1e6, 1.0, scale), 1.0F);
  EXPECT_LT(river_prominence(500, 0.001, scale), river_prominence(600, 0.001, scale));
}

TEST(Rivers, SlopeIsSteepestDescentByTrueDistance) {
  const Grid grid = Grid::plane(5, 5, 100, 200);
  std::vector<float> z(25);
  for (int j = 0; j < 5; ++j) {
    for (int i = 0; i < 5; ++i) z[grid.cell(i, j)] = 10.0F * i + 1;
  }
  std::vector<float> slope(25);
  steepest_slope(grid, z, std::vector<std::uint8_t>(25, 0), slope);
  EXPECT_NEAR(slope[grid.cell(2, 2)], 0.1, 1e-6);
  EXPECT_EQ(slope[grid.cell(0, 2)], 0.0F);
}

TEST(Rivers, DirectionsLeadToReceiversAcrossThePoles) {
  const Grid grid = Grid::sphere(32, 16);
  const auto z = test::random_terrain(grid, 3);
  const auto graph = route_water(grid, z, find_outlets(grid, z)).graph;
  std::vector<std::int8_t> direction(grid.size());
  flow_directions(grid, graph.receiver, direction);
  for (Index c = 0; c < grid.size(); ++c) {
    const Index to = direction[c] == 0 ? c : grid.neighbour(c, direction[c] - 1);
    ASSERT_EQ(to, graph.receiver[c]);
  }
}

TEST(Carving, OnlyLowersKeepsLandAndMakesNoPits) {
  int lowered = 0;
  for (std::uint64_t seed = 0; seed < 25; ++seed) {
    for (const Grid& grid : test::small_grids()) {
      SCOPED_TRACE(seed);
      const auto before = test::random_terrain(grid, seed);
      auto z = before;
      const auto outlets = find_outlets(grid, z);
      std::vector<std::uint8_t> sea(grid.size());
      for (Index c = 0; c < grid.size(); ++c) sea[c] = z[c] < 0;
      const auto graph = route_water(grid, z, outlets).graph;
      std::vector<double> discharge(grid.size(), 50.0);
      graph.accumulate(discharge);
      const int pits = count_pits(grid, z, outlets);
      carve_valleys(grid, graph, sea, discharge, {1.0, 2.0, 300.0, 0.2}, z);
      EXPECT_LE(count_pits(grid, z, outlets), pits);
      for (Index c = 0; c < grid.size(); ++c) {
        ASSERT_LE(z[c], before[c]);
        if (sea[c] != 0) {
          ASSERT_EQ(z[c], before[c]);
        } else {
          ASSERT_GE(z[c], 0);
        }
        lowered += z[c] < before[c];
      }
    }
  }
  EXPECT_GT(lowered, 1000);
}

TEST(Carving, CutsToValleyDepthAndLessInBedrock) {
  const Grid grid = Grid::plane(5, 3, 1e4, 1e4, Edges::closed);
  std::vector<float> z(15, 5000.0F);
  const float profile[]{-10, 900, 1500, 1700, 2600};
  for (int i = 0; i < 5; ++i) z[grid.cell(i, 1)] = profile[i];
  const auto outlets = find_outlets(grid, z);
  std::vector<std::uint8_t> sea(15, 0);
  sea[grid.cell(0, 1)] = 1;
  const auto graph = route_water(grid, z, outlets).graph;
  std::vector<double> discharge(15, 0.0);
  for (int i = 1; i < 5; ++i) discharge[grid.cell(i, 1)] = 1000.0;
  carve_valleys(grid, graph, sea, discharge, {1.0, 1.0, 10.0, 0.0}, z);
  const double depth = 16 * std::pow(1000.0, 0.36);
  EXPECT_NEAR(z[grid.cell(1, 1)], 900 - depth, 1e-3);
  EXPECT_NEAR(z[grid.cell(2, 1)], 1500 - depth, 1e-3);
  EXPECT_NEAR(z[grid.cell(3, 1)], 1700 - 0.58 * depth, 1e-3);
}

TEST(Carving, ACoarseGridLosesAsMuchRockAsAFineOne) {
  // A ramp 320 km long with a river down the middle, on cells as wide as a valley and wider.
  constexpr double kWidth_m = 10e3, kDischarge_m3_s = 1000.0;
  const auto carved_m3 = [&](double cell_m) {
    const int nx = static_cast<int>(320e3 / cell_m);
    const Grid grid = Grid::plane(nx, 3, cell_m, cell_m, Edges::closed);
    std::vector<float> z(grid.size(), 2000.0F);
    std::vector<std::uint8_t> sea(grid.size(), 0);
    std::vector<double> discharge(grid.size(), 0.0);
    for (int i = 0; i < nx; ++i) {
      const double x_m = (i + 0.5) * cell_m;
      z[grid.cell(i, 1)] = static_cast<float>(i == 0 ? -10.0 : 600.0 + 2e-3 * x_m);
      discharge[grid.cell(i, 1)] = kDischarge_m3_s;
    }
    sea[grid.cell(0, 1)] = 1;
    const auto before = z;
    const auto graph = route_water(grid, z, find_outlets(grid, z)).graph;
    carve_valleys(grid, graph, sea, discharge, {1.0, 1.0, 10.0, 0.0, kWidth_m}, z);
    double sum = 0.0;
    for (Index c = 0; c < grid.size(); ++c) sum += (before[c] - z[c]) * cell_m * cell_m;
    return sum / (320e3 - cell_m);
  };
  const double section_m2 = kWidth_m * std::min(valley_depth(kDischarge_m3_s), 0.23 * 600.0);
  EXPECT_NEAR(carved_m3(10e3) / section_m2, 1.0, 0.35) << "the head of the ramp is higher";
  for (const double cell_m : {20e3, 40e3, 80e3}) {
    EXPECT_NEAR(carved_m3(cell_m) / carved_m3(10e3), 1.0, 0.05) << cell_m;
  }
}

// A dam of 150 m and 30 km above a pit at 100 m.
struct Dam {
  Grid grid = Grid::plane(8, 3, 1e4, 1e4, Edges::closed);
  std::vector<float> z;
  std::vector<std::uint8_t> outlets;
  Dam() : z(24, 5000.0F) {
    const float profile[]{-10, 40, 90, 250, 150, 100, 300, 400};
    for (int i = 0; i < 8; ++i) z[grid.cell(i, 1)] = profile[i];
    outlets = find_outlets(grid, z);
  }
};

TEST(Breaching, KeepsItsLimitsOfDepthAndLength) {
  const Dam dam;
  for (const auto& [limits, cuts] : {std::pair{BreachLimits{160, 35e3, 0}, 1},
                                     {BreachLimits{140, 35e3, 0}, 0},
                                     {BreachLimits{160, 15e3, 0}, 0}}) {
    auto z = dam.z;
    EXPECT_EQ(breach_depressions(dam.grid, dam.outlets, limits, z), cuts);
    EXPECT_EQ(count_pits(dam.grid, z, dam.outlets), 1 - cuts);
    if (cuts == 0) {
      EXPECT_EQ(z, dam.z);
    } else {
      EXPECT_NEAR(z[dam.grid.cell(3, 1)], 100, 0.5) << "no deeper than needed";
    }
  }
}

// A plateau between a hollow and a ditch, and a strip of soft ground that leads across it in a
// bend.
TEST(Breaching, GoesWhereTheGroundIsSoft) {
  constexpr int kColumns = 20, kRows = 15, kMiddle = 7, kBend = 3;
  const Grid grid = Grid::plane(kColumns, kRows, 1e3, 1e3, Edges::closed);
  std::vector<float> level(grid.size(), 60.0F), toughness(grid.size(), 1.0F);
  level[grid.cell(0, kMiddle)] = -10.0F;
  level[grid.cell(kColumns - 1, kMiddle)] = 20.0F;
  for (int i = 0; i < kColumns; ++i) {
    const int away = std::min({i, kColumns - 1 - i, kBend});
    toughness[grid.cell(i, kMiddle + away)] = 0.2F;
  }
  const auto outlets = find_outlets(grid, level);
  const auto cells_cut = [&](std::span<const float> tough, int row) {
    auto z = level;
    EXPECT_EQ(breach_depressions(grid, outlets, {100.0, 1e5, 0.0}, z, tough), 1);
    int cut = 0;
    for (int i = kBend; i < kColumns - kBend; ++i) cut += z[grid.cell(i, row)] < 60.0F;
    return cut;
  };
  constexpr int kAcross = kColumns - 2 * kBend;
  EXPECT_EQ(cells_cut({}, kMiddle), kAcross);
  EXPECT_EQ(cells_cut(toughness, kMiddle), 0);
  EXPECT_EQ(cells_cut(toughness, kMiddle + kBend), kAcross);
}

TEST(GradeRivers, CutADamThatTheRiverCouldHaveCutAndNoOther) {
  const Dam dam;
  const auto graph = route_water(dam.grid, dam.z, dam.outlets).graph;
  for (const double q : {1000.0, 100.0}) {  // valleys of 192 and 84 m
    auto z = dam.z;
    const std::vector<double> discharge(24, q);
    const int cuts = grade_rivers(dam.grid, graph, dam.outlets, discharge, {1.0, 1e5}, z);
    EXPECT_EQ(cuts, q > 500 ? 1 : 0);
    EXPECT_EQ(count_pits(dam.grid, z, dam.outlets), q > 500 ? 0 : 1);
  }
  auto z = dam.z;
  const std::vector<double> discharge(24, 1000.0);
  EXPECT_EQ(grade_rivers(dam.grid, graph, dam.outlets, discharge, {1.0, 1.5e4}, z), 0)
      << "too long";
}

TEST(Breaching, AndGradingMakeNoPitsAndKeepLand) {
  int cuts = 0;
  for (std::uint64_t seed = 0; seed < 25; ++seed) {
    for (const Grid& grid : test::small_grids()) {
      SCOPED_TRACE(seed);
      auto z = test::random_terrain(grid, seed);
      const auto before = z;
      const auto outlets = find_outlets(grid, z);
      const int pits = count_pits(grid, z, outlets);
      cuts += breach_depressions(grid, outlets, {60.0, 1e6, 0.0}, z);
      const int fewer = count_pits(grid, z, outlets);
      EXPECT_LE(fewer, pits);
      const auto graph = route_water(grid, z, outlets).graph;
      grade_rivers(grid, graph, outlets, std::vector<double>(grid.size(), 100.0), {1.0, 1e6}, z);
      EXPECT_LE(count_pits(grid, z, outlets), fewer);
      for (Index c = 0; c < grid.size(); ++c) {
        ASSERT_LE(z[c], before[c]);
        if (before[c] >= 0) {
          ASSERT_GE(z[c], 0);
        }
      }
    }
  }
  EXPECT_GT(cuts, 100);
}

}  // namespace
}  // namespace geo
