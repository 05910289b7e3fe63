#include "geo/kernels/landscape/marine_deposition.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/terrain.hpp"

namespace geo {
namespace {

std::vector<std::uint8_t> sea_of(const std::vector<float>& z) {
  std::vector<std::uint8_t> sea;
  for (const float height : z) sea.push_back(height < 0.0F ? 1 : 0);
  return sea;
}

double volume(const Grid& grid, const std::vector<double>& thickness_m) {
  return area_sum<double>(grid, [&](Index c) { return thickness_m[c]; });
}

TEST(MarineDeposition, KeepsMassWithinItsRoom) {
  for (const Grid& grid : test::small_grids()) {
    const auto z = test::random_terrain(grid, 6);
    const auto sea = sea_of(z);
    std::vector<double> room(grid.size(), 0.0), supply(grid.size(), 0.0);
    for (Index c = 0; c < grid.size(); ++c) {
      if (sea[c] == 0) continue;
      room[c] = std::max(0.0, -10.0 - z[c]);
      supply[c] = c % 5 == 0 ? 90.0 : 0.0;
    }
    const double brought = volume(grid, supply);
    ASSERT_LT(brought, volume(grid, room));
    lay_at_sea<double>(grid, sea, 2e3, room, supply);
    EXPECT_NEAR(volume(grid, supply) / brought, 1.0, 1e-12);
    for (Index c = 0; c < grid.size(); ++c) {
      ASSERT_GE(supply[c], 0.0);
      ASSERT_LE(supply[c], room[c] * (1.0 + 1e-12));
    }
  }
}

TEST(MarineDeposition, SpreadsByItsLengthAndNotAcrossLand) {
  const Grid grid = Grid::plane(101, 101, 10e3, 10e3);
  std::vector<std::uint8_t> sea(grid.size(), 1);
  for (int j = 0; j < grid.ny(); ++j) sea[grid.cell(75, j)] = 0;
  std::vector<double> room(grid.size(), 1e9), laid(grid.size(), 0.0);
  laid[grid.cell(40, 50)] = 1.0;
  lay_at_sea<double>(grid, sea, 60e3, room, laid);
  double east2 = 0.0, north2 = 0.0, sum = 0.0;
  for (Index c = 0; c < grid.size(); ++c) {
    const double east = 10e3 * (grid.column(c) - 40), north = 10e3 * (grid.row(c) - 50);
    east2 += laid[c] * east * east;
    north2 += laid[c] * north * north;
    sum += laid[c];
    if (grid.column(c) >= 75) {
      ASSERT_EQ(laid[c], 0.0);
    }
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  // The wall of land is more than five lengths away.
  EXPECT_NEAR(std::sqrt(east2) / 60e3, 1.0, 0.01);
  EXPECT_NEAR(std::sqrt(north2) / 60e3, 1.0, 0.01);
}

TEST(MarineDeposition, FullShelvesPassOnWhatTheyGet) {
  // Shelf of 20 m of room, then a deep sea: the shelf fills, the rest lies behind its edge.
  const Grid grid = Grid::plane(60, 9, 10e3, 10e3);
  std::vector<std::uint8_t> sea(grid.size(), 1);
  std::vector<double> room(grid.size()), laid(grid.size(), 0.0);
  for (Index c = 0; c < grid.size(); ++c) room[c] = grid.column(c) < 10 ? 20.0 : 3000.0;
  for (int j = 0; j < grid.ny(); ++j) laid[grid.cell(0, j)] = 4000.0;
  lay_at_sea<double>(grid, sea, 50e3, room, laid);
  EXPECT_EQ(laid[grid.cell(2, 4)], 20.0);
  EXPECT_GT(laid[grid.cell(12, 4)], 60.0);
  EXPECT_GT(laid[grid.cell(12, 4)], laid[grid.cell(40, 4)]);
}

TEST(MarineDeposition, WhatNoSeaHasRoomForStaysAtTheMouth) {
  const Grid grid = Grid::plane(20, 20, 10e3, 10e3);
  const std::vector<std::uint8_t> sea(grid.size(), 1);
  const std::vector<double> room(grid.size(), 1.0);
  std::vector<double> laid(grid.size(), 0.0);
  laid[grid.cell(3, 3)] = 1000.0;
  const double brought = volume(grid, laid);
  lay_at_sea<double>(grid, sea, 20e3, room, laid);
  EXPECT_NEAR(volume(grid, laid) / brought, 1.0, 1e-12);
  EXPECT_GT(laid[grid.cell(3, 3)], 1.0);
}

}  // namespace
}  // namespace geo
