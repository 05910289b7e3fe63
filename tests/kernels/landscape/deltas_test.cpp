#include "geo/kernels/landscape/deltas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace geo {
namespace {

/// A straight coast along column 5; the floor falls by a metre in a kilometre.
struct Shore {
  Grid grid = Grid::plane(60, 61, 2e3, 2e3, Edges::closed);
  std::vector<float> z = std::vector<float>(grid.size()), laid = z;
  std::vector<std::uint8_t> sea = std::vector<std::uint8_t>(grid.size());
  std::vector<double> volume = std::vector<double>(grid.size(), 0.0);
  explicit Shore(float fall_m = 0.0F) {
    for (Index c = 0; c < grid.size(); ++c) {
      const int i = grid.column(c);
      z[c] = i < 5 ? 5.0F : -8.0F - fall_m * static_cast<float>(i - 5);
      sea[c] = i < 5 ? 0 : 1;
    }
  }
};

TEST(Deltas, OnAnEvenFloorAreHalfDiscsOfWhatTheRiverBrings) {
  Shore shore;
  const Index mouth = shore.grid.cell(5, 30);
  const double brought = 1e10;  // 10 m of it: 1000 km2
  shore.volume[mouth] = brought;
  const DeltaLaw level{.front_m = 2.0, .slope = 0.0};
  build_deltas(shore.grid, level, shore.sea, shore.z, shore.volume, shore.laid);
  const auto filled =
      std::count_if(shore.laid.begin(), shore.laid.end(), [](float m) { return m > 0.0F; });
  ASSERT_NEAR(static_cast<double>(filled), 250.0, 1.0);
  double laid = 0.0, farthest = 0.0;
  for (Index c = 0; c < shore.grid.size(); ++c) {
    laid += shore.laid[c] * shore.grid.area_m2(0);
    if (shore.laid[c] == 0.0F) continue;
    EXPECT_EQ(shore.z[c] + shore.laid[c], 2.0F);
    EXPECT_NE(shore.sea[c], 0);
    farthest = std::max(farthest, std::hypot(shore.grid.column(c) - 5.0, shore.grid.row(c) - 30.0));
  }
  EXPECT_NEAR((laid + shore.volume[mouth]) / brought, 1.0, 1e-12);
  EXPECT_LT(shore.volume[mouth], 10.0 * shore.grid.area_m2(0));
  // A half disc of 1000 km2 has a radius of 25 km; ways over eight neighbours make it an octagon.
  EXPECT_NEAR(2.0 * farthest, std::sqrt(2e3 / std::numbers::pi), 3.0);
}

// Flats at one height would all drown, or all fall dry, with the least change of the sea's level.
TEST(Deltas, FallFromTheMouthToTheShoreByTheirSlope) {
  Shore shore;
  const int column = 5, row = 30;
  const Index mouth = shore.grid.cell(column, row);
  shore.volume[mouth] = 3e10;
  const DeltaLaw law;
  build_deltas(shore.grid, law, shore.sea, shore.z, shore.volume, shore.laid);
  const auto plain_m = [&](int i) {
    const Index c = shore.grid.cell(i, row);
    return shore.z[c] + shore.laid[c];
  };
  int last = column;
  while (shore.laid[shore.grid.cell(last + 1, row)] > 0.0F) ++last;
  ASSERT_GT(last - column, 10);
  const double step_m = 2e3;
  for (int i = column; i < last; ++i) {
    EXPECT_NEAR(plain_m(i) - plain_m(i + 1), law.slope * step_m, 1e-5);
  }
  EXPECT_NEAR(plain_m(last), law.front_m, 2.0 * law.slope * step_m);
}

TEST(Deltas, AreNoHigherThanTheLandThatTheRiverComesFrom) {
  Shore shore;
  for (float& z : shore.z) z = z > 0.0F ? 1.0F : z;
  const Index mouth = shore.grid.cell(5, 30);
  shore.volume[mouth] = 3e10;
  build_deltas(shore.grid, {}, shore.sea, shore.z, shore.volume, shore.laid);
  EXPECT_EQ(shore.z[mouth] + shore.laid[mouth], 1.0F);
}

TEST(Deltas, StopWhereTheWaterIsDeepAndSmallRiversBuildNone) {
  Shore shore(4.0F);
  const Index mouth = shore.grid.cell(5, 10), brook = shore.grid.cell(5, 50);
  shore.volume[mouth] = 1e13;
  shore.volume[brook] = 8.4 * shore.grid.area_m2(0);
  build_deltas(shore.grid, {}, shore.sea, shore.z, shore.volume, shore.laid);
  EXPECT_EQ(shore.volume[brook], 8.4 * shore.grid.area_m2(0));
  EXPECT_GT(shore.volume[mouth], 0.0);
  for (Index c = 0; c < shore.grid.size(); ++c) {
    if (shore.laid[c] > 0.0F) {
      EXPECT_GE(shore.z[c], -60.0F);
    }
  }
}

}  // namespace
}  // namespace geo
