#include "geo/kernels/water/lakes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "geo/kernels/water/water_balance.hpp"
#include "support/terrain.hpp"

namespace geo {
namespace {

/// A row of cells of 1 m2 between two walls; water leaves at the first cell, the sea.
struct Valley {
  Grid grid = Grid::plane(6, 3, 1.0, 1.0, Edges::closed);
  std::vector<float> z;
  std::vector<std::uint8_t> outlets;
  std::vector<Index> receiver;
  DepressionHierarchy hierarchy;

  explicit Valley(std::initializer_list<float> profile) : z(grid.size(), 100.0F) {
    int i = 0;
    for (const float height : profile) z[grid.cell(i++, 1)] = height;
    outlets.assign(grid.size(), 0);
    outlets[grid.cell(0, 1)] = 1;
    receiver.resize(grid.size());
    steepest_receivers(grid, z, outlets, receiver);
    hierarchy = build_depression_hierarchy(grid, z, outlets, receiver);
  }
  [[nodiscard]] Lakes balance(double rain_on_a, float loss_per_cell) const {
    std::vector<double> runoff(grid.size(), 0.0);
    runoff[grid.cell(2, 1)] = rain_on_a;
    return balance_lakes(grid, z, hierarchy, runoff,
                         std::vector<float>(grid.size(), loss_per_cell));
  }
};

// 0 (sea) 5 1 3 2 6: pit a at 1 and pit b at 2 meet at 3; together they spill at 5 into the sea.
// Each floods one cell up to 3; the union floods three.
TEST(Lakes, WaterStaysInThePitThatItReaches) {
  const Valley valley({0, 5, 1, 3, 2, 6});
  const Lakes lakes = valley.balance(0.25, 1.0F);
  ASSERT_EQ(lakes.lakes.size(), 1U);
  EXPECT_EQ(lakes.lakes[0].bottom, valley.grid.cell(2, 1));
  EXPECT_EQ(lakes.lakes[0].outlet, kNoCell);
  EXPECT_NEAR(lakes.lakes[0].level_m, 1 + 0.25 * (3 - 1), 1e-6);
  EXPECT_DOUBLE_EQ(lakes.lakes[0].area_m2, 0.25);
}

TEST(Lakes, FullPitSpillsIntoItsNeighbour) {
  const Valley valley({0, 5, 1, 3, 2, 6});
  const Lakes lakes = valley.balance(1.5, 1.0F);
  ASSERT_EQ(lakes.lakes.size(), 2U);
  EXPECT_EQ(lakes.lakes[0].outlet, valley.grid.cell(2, 1) + 1) << "over the cell of height 3";
  EXPECT_EQ(lakes.lakes[0].level_m, 3.0F);
  EXPECT_DOUBLE_EQ(lakes.lakes[1].inflow_m3_s, 0.5);
  EXPECT_NEAR(lakes.lakes[1].level_m, 2.5, 1e-6);
}

TEST(Lakes, TwoFullPitsUnite) {
  const Valley valley({0, 5, 1, 3, 2, 6});
  const Lakes lakes = valley.balance(2.5, 1.0F);
  ASSERT_EQ(lakes.lakes.size(), 1U);
  EXPECT_EQ(lakes.lakes[0].outlet, kNoCell);
  EXPECT_NEAR(lakes.lakes[0].level_m, 3 + 0.5 * (5 - 3), 1e-6);
  EXPECT_DOUBLE_EQ(lakes.lakes[0].area_m2, 2.5);
}

TEST(Lakes, FullUnionRunsToTheSea) {
  const Valley valley({0, 5, 1, 3, 2, 6});
  const Lakes lakes = valley.balance(10.0, 1.0F);
  ASSERT_EQ(lakes.lakes.size(), 1U);
  EXPECT_NE(lakes.lakes[0].outlet, kNoCell);
  EXPECT_EQ(lakes.lakes[0].level_m, 5.0F);
  EXPECT_DOUBLE_EQ(lakes.lakes[0].loss_m3_s, 3.0);
}

TEST(Lakes, WithoutLossAllOverflowAndWithoutRainAllAreDry) {
  const Valley valley({0, 5, 1, 3, 2, 6});
  EXPECT_EQ(valley.balance(1e-9, 0.0F).lakes.at(0).level_m, 5.0F);
  EXPECT_TRUE(valley.balance(0.0, 1.0F).lakes.empty());
}

/// Balances the lakes of a terrain under a climate drawn from the seed, from desert to rain forest:
/// no cycles, all water reaches the sea or evaporates, and the map shows the lakes of the balance.
/// Returns how many depressions spill into the one that takes most of them.
int check_water_balance(const Grid& grid, const std::vector<float>& z, std::uint64_t seed) {
  const auto outlets = find_outlets(grid, z);
  std::vector<Index> receiver(grid.size());
  steepest_receivers(grid, z, outlets, receiver);
  const auto hierarchy = build_depression_hierarchy(grid, z, outlets, receiver);
  const RandomStream random(seed, "rain");
  std::vector<double> runoff(grid.size(), 0.0);
  std::vector<float> loss(grid.size(), 0.0F);
  double total = 0.0;
  for (Index c = 0; c < grid.size(); ++c) {
    if (z[c] < 0) continue;
    total += runoff[c] = random.uniform(c, 0);
    loss[c] = static_cast<float>(5 * (1 + seed % 4) * random.uniform(c, 1));
  }
  const Lakes lakes = balance_lakes(grid, z, hierarchy, runoff, loss);
  FlowGraph graph{receiver, {}};
  connect_lakes(lakes, graph.receiver);
  graph.order = downstream_order(graph.receiver);  // throws on a cycle
  std::vector<double> water = runoff;
  double evaporated = 0.0, to_sea = 0.0;
  for (const Lake& lake : lakes.lakes) {
    water[lake.outlet == kNoCell ? lake.bottom : lake.outlet] -= lake.loss_m3_s;
    evaporated += lake.loss_m3_s;
    EXPECT_LE(lake.loss_m3_s, lake.inflow_m3_s * (1 + 1e-12));
  }
  graph.accumulate(water);
  int negative = 0, kept = 0;
  for (Index c = 0; c < grid.size(); ++c) {
    negative += water[c] < -1e-9 * total;
    if (graph.receiver[c] != c) continue;
    if (outlets[c] != 0) {
      to_sea += water[c];
    } else {
      kept += std::abs(water[c]) > 1e-9 * total;
    }
  }
  EXPECT_EQ(negative, 0) << "cells that pass on less than nothing";
  EXPECT_EQ(kept, 0) << "an endorheic lake keeps nothing";
  EXPECT_NEAR(to_sea + evaporated, total, 1e-9 * total);

  // What the map shows flooded loses what the balance says, up to each lake's last cell.
  std::vector<float> depth(grid.size());
  std::vector<std::int32_t> id(grid.size());
  map_lakes(grid, z, hierarchy, lakes, {}, depth, id);
  std::vector<double> mapped(lakes.lakes.size() + 1, 0.0);
  for (Index c = 0; c < grid.size(); ++c) {
    if (id[c] != 0) mapped[lakes.lake_of_leaf[hierarchy.leaf_of_cell[c]]] += loss[c];
  }
  for (std::size_t n = 0; n < lakes.lakes.size(); ++n) {
    if (lakes.lakes[n].outlet == kNoCell) continue;
    EXPECT_NEAR(mapped[n], lakes.lakes[n].loss_m3_s, 1e-6 * total);
  }

  const auto& nodes = hierarchy.depressions;
  std::vector<int> tributaries(nodes.size(), 0);
  for (const Depression& node : nodes) {
    if (node.parent != kSea || node.spills_into == kSea) continue;
    std::int32_t into = node.spills_into;
    while (nodes[into].parent != kSea) into = nodes[into].parent;
    ++tributaries[into];
  }
  return tributaries.empty() ? 0 : *std::max_element(tributaries.begin(), tributaries.end());
}

// Conservation where it is hardest: rough terrain, climates from desert to rain forest.
TEST(Lakes, WaterBalanceClosesOnAHundredTerrains) {
  for (std::uint64_t seed = 0; seed < 25; ++seed) {
    for (const Grid& grid : test::small_grids()) {
      SCOPED_TRACE(seed);
      std::vector<float> z = test::random_terrain(grid, seed);
      if (seed % 3 == 0) {  // plateaus: many equal heights
        for (float& height : z) height = 40 * std::round(height / 40);
      }
      check_water_balance(grid, z, seed);
      if (HasFailure()) return;
    }
  }
}

/// A closed valley along the columns, 500 m deep at its axis, below slopes with a hollow every
/// `spacing` cells: each spills down the slope into the valley, whose own way out is the sea beyond
/// one end.
std::vector<float> valley_with_hollows(const Grid& grid, int spacing) {
  std::vector<float> z(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    const int i = grid.column(c), j = grid.row(c), from_axis = std::abs(j - grid.ny() / 2);
    z[c] = static_cast<float>(500.0 + 50.0 * from_axis);
    if (from_axis >= 4 && from_axis % spacing == 0 && i % spacing == 0) z[c] -= 200.0F;
    if (i < 3) z[c] = i == 0 ? -100.0F : 900.0F;
  }
  return z;
}

TEST(Lakes, HundredsOfHollowsSpillIntoOneValley) {
  const Grid grid = Grid::plane(1300, 40, 1000.0, 1000.0, Edges::closed);
  EXPECT_GT(check_water_balance(grid, valley_with_hollows(grid, 4), 3), 640);
}

TEST(Lakes, TensOfThousandsOfHollowsSpillIntoOneValley) {
  const Grid grid = Grid::plane(4000, 250, 1000.0, 1000.0, Edges::closed);
  EXPECT_GT(check_water_balance(grid, valley_with_hollows(grid, 5), 2), 30'000);
}

TEST(Lakes, WaterBalanceClosesOnAMillionCells) {
  const Grid grid = Grid::sphere(1440, 720);
  for (const std::uint64_t seed : {1, 2}) {
    SCOPED_TRACE(seed);
    std::vector<float> z = test::random_terrain(grid, seed);
    // Land without a coast but one sea: trees of depressions spill far and into each other.
    for (float& height : z) height += seed == 2 ? 700.0F : 0.0F;
    EXPECT_GT(check_water_balance(grid, z, seed), 8) << "no more than a cell of the grid has";
  }
}

TEST(WaterBalance, BudykoAtEightHundredAndAThousandMillimetres) {
  EXPECT_NEAR(land_evaporation(800, 1000), 615.65, 0.005);
  EXPECT_EQ(land_evaporation(0, 1000), 0.0);
  EXPECT_EQ(land_evaporation(800, 0), 0.0);
  for (double p = 1; p < 1e4; p *= 1.7) {
    for (double potential = 1; potential < 1e4; potential *= 1.7) {
      EXPECT_LE(land_evaporation(p, potential), std::min(p, potential));
    }
  }
}

}  // namespace
}  // namespace geo
