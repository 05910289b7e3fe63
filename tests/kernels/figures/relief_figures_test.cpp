#include "geo/kernels/figures/relief_figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "geo/core/error.hpp"

namespace geo {
namespace {

TEST(LocalRelief, OfAnEvenSlopeIsTwoStepsAndOfACoastThatOfItsLand) {
  const Grid grid = Grid::plane(7, 5, 1000.0, 1000.0);
  std::vector<float> z(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    const int i = grid.column(c);
    z[c] = i == 0 ? -4000.0F : 10.0F * static_cast<float>(i);
  }
  const auto relief = local_relief_m(grid, z);
  EXPECT_EQ(relief[grid.cell(0, 2)], 0.0F);   // sea
  EXPECT_EQ(relief[grid.cell(1, 2)], 20.0F);  // from the surface of the sea to 20 m
  EXPECT_EQ(relief[grid.cell(3, 2)], 20.0F);
  EXPECT_EQ(relief[grid.cell(6, 2)], 10.0F);  // at the edge
  EXPECT_THROW(local_relief_m(grid, std::vector<float>(3)), InputError);
}

TEST(ReliefFigures, SoundsAreSeaBetweenLandWithinReach) {
  const Grid grid = Grid::sphere(360, 180);
  std::vector<float> z(grid.size(), -100.0F);
  const auto land = [&](int i, int j) { z[grid.cell(i, j)] = 100.0F; };
  // Two walls a cell apart along a meridian, 60 to 69 degrees north: cells of 111 km by 50 km.
  for (int j = 150; j < 160; ++j) land(100, j), land(102, j);
  const double between = share_of_sounds(grid, z, 50.0, 6e4);
  // Beside each wall one cell is coast, between them each cell is a sound; north and south of the
  // walls the sea is 111 km away.
  EXPECT_NEAR(between, 1.0 / 3.0, 1e-12);
  EXPECT_TRUE(std::isnan(share_of_sounds(grid, z, 75.0, 6e4))) << "no coast";
}

}  // namespace
}  // namespace geo
