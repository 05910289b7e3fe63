// Rivers laid over reliefs whose slopes, concavity and basins are known beforehand.
#include "geo/kernels/figures/profile_figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geo/core/error.hpp"

namespace geo {
namespace {

constexpr double kCell_m = 10e3;

/// A river from east to west into the sea, in the middle row of three, whose other rows are sea;
/// `height_m` of its cells by their distance from the sea. Its cells drain none but their own.
struct River {
  template <class Height>
  explicit River(const Height& height_m)
      : grid(Grid::plane(60, 3, kCell_m, kCell_m, Edges::closed, Centre{10.0, 0.0})),
        z(grid.size(), -10.0F) {
    rivers.receiver.resize(grid.size());
    rivers.area_m2.assign(grid.size(), kCell_m * kCell_m);
    rivers.basin.assign(grid.size(), 0);
    rivers.fall_m.assign(grid.size(), 0.0F);
    rivers.length_m.assign(grid.size(), 0.0F);
    for (Index c = 0; c < grid.size(); ++c) rivers.receiver[c] = c;
    for (int i = 1; i < 60; ++i) {
      const Index c = cell(i);
      z[c] = static_cast<float>(height_m(i * kCell_m));
      rivers.receiver[c] = c - 1;
      rivers.area_m2[c] = (60 - i) * kCell_m * kCell_m;
      rivers.basin[c] = 1;
      rivers.fall_m[c] = z[c] - std::max(0.0F, z[c - 1]);
      rivers.length_m[c] = static_cast<float>(kCell_m);
    }
  }
  [[nodiscard]] Index cell(int column) const { return grid.cell(column, 1); }
  Grid grid;
  std::vector<float> z;
  LaidRivers rivers;
};

TEST(ProfileFigures, SlopeOfRiversIsTheirWholeFallOverTheirWholeLength) {
  // An even river of 2 m/km, whose cells stand up to 15 m above or below that.
  const River bumpy([](double x) { return 2e-3 * x + 15.0 * std::sin(x / 7e3); });
  const LaidRivers& rivers = bumpy.rivers;
  const double least = 10.0 * kCell_m * kCell_m;
  EXPECT_NEAR(river_slope(bumpy.grid, rivers, least, {}), 2e-3, 1e-4);
  EXPECT_TRUE(std::isnan(river_slope(bumpy.grid, rivers, 1e15, {})));
  EXPECT_TRUE(std::isnan(river_slope(bumpy.grid, rivers, least, {5.0}))) << "poleward of the band";
}

TEST(ProfileFigures, ConcavityAndSteepnessAreThoseOfTheProfile) {
  // The cell at x drains A = c (L - x), and falls by k A^-theta c to the next.
  constexpr double kSteepness = 80.0;
  for (const double theta : {0.45, 0.3}) {
    const River river([&](double x) {
      double z = 0.0;
      for (double at = kCell_m; at <= x + 1.0; at += kCell_m) {
        z += kCell_m * kSteepness * std::pow(kCell_m * (60.0 * kCell_m - at), -theta);
      }
      return z;
    });
    const LaidRivers& rivers = river.rivers;
    const double cell_m2 = kCell_m * kCell_m;
    EXPECT_NEAR(concavity(river.grid, rivers, 10.0 * cell_m2, 60.0 * cell_m2, {}), theta, 0.02);
    EXPECT_TRUE(std::isnan(concavity(river.grid, rivers, 1.0, 2.0, {}))) << "too few cells";
    const auto steepness = channel_steepness(river.grid, rivers, theta, 30.0 * cell_m2, {});
    for (int i = 0; i < 60; ++i) {
      if (i == 0 || i > 30) {
        EXPECT_TRUE(std::isnan(steepness[river.cell(i)])) << "column " << i;
      } else {
        EXPECT_NEAR(steepness[river.cell(i)] / kSteepness, 1.0, 1e-3) << "column " << i;
      }
    }
  }
}

TEST(ProfileFigures, IntegralOfAPlaneIsAHalfAndOfATableNearlyOne) {
  const auto integral = [&](auto&& height_m) {
    const River river([&](double x) { return height_m(x / kCell_m); });
    const auto all = hypsometric_integrals(river.grid, river.z, river.rivers, 1e9, {});
    EXPECT_EQ(all.size(), 1U);
    return all.empty() ? -1.0 : all.front();
  };
  EXPECT_NEAR(integral([](double i) { return 10.0 * i; }), 0.5, 0.01);
  EXPECT_NEAR(integral([](double i) { return i < 2 ? 0.0 : 100.0 + 0.1 * i; }), 0.95, 0.03);
  EXPECT_NEAR(integral([](double i) { return 0.1 * i * i * i; }), 0.25, 0.02);
  const River level([](double) { return 5.0; });
  EXPECT_TRUE(hypsometric_integrals(level.grid, level.z, level.rivers, 1e9, {}).empty());
}

TEST(ProfileFigures, RiversCrossDepressionsAndBasinsHaveOneNumberEach) {
  const Grid grid = Grid::plane(12, 3, kCell_m, kCell_m, Edges::closed, Centre{10.0, 0.0});
  std::vector<float> z(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    const int i = grid.column(c);
    z[c] = i == 0 || i == 11 ? -5.0F : i == 5 ? 500.0F : i == 3 ? 10.0F : 100.0F;
  }
  const LaidRivers rivers = lay_rivers(grid, z);
  for (Index c = 0; c < grid.size(); ++c) {
    const int i = grid.column(c);
    EXPECT_EQ(rivers.basin[c] == 0, i == 0 || i == 11);
    Index at = c;
    for (int k = 0; k < 40 && z[at] >= 0.0F; ++k) at = rivers.receiver[at];
    EXPECT_LT(z[at], 0.0F) << "from column " << i;
    if (z[c] >= 0.0F && z[rivers.receiver[c]] >= 0.0F) {
      EXPECT_EQ(rivers.basin[c], rivers.basin[rivers.receiver[c]]);
    }
  }
  EXPECT_THROW(lay_rivers(grid, std::vector<float>(3)), InputError);
}

}  // namespace
}  // namespace geo
