#include "geo/kernels/landscape/straits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "geo/kernels/water/sea_parts.hpp"

namespace geo {
namespace {

/// Ocean to the west; a sea, and a pond further east, in land that rises away from one pass.
struct Coast {
  Grid grid = Grid::plane(40, 21, 1e4, 1e4, Edges::closed);
  std::vector<float> z = std::vector<float>(grid.size());
  explicit Coast(float pass_m = 100.0F) {
    for (Index c = 0; c < grid.size(); ++c) {
      const int i = grid.column(c), j = grid.row(c);
      const bool sea = i >= 18 && i < 26 && j >= 6 && j < 15, pond = i >= 30 && i < 33 && j == 10;
      z[c] =
          i < 10 || sea || pond ? -500.0F : pass_m + 60.0F * static_cast<float>(std::abs(j - 10));
    }
  }
  [[nodiscard]] std::size_t seas() const { return parts_of_sea(grid, z).size(); }
};

StraitLaw small_law() {
  return {.sill_m = 150.0, .land_m = 2e5, .depth_m = 60.0, .width_m = 25e3, .least_m2 = 1e8};
}

TEST(Straits, JoinSeasOverTheLowestSillAndLowerNothingElse) {
  Coast coast;
  const auto before = coast.z;
  EXPECT_EQ(coast.seas(), 3U);
  EXPECT_EQ(open_straits(coast.grid, small_law(), coast.z), 2);
  EXPECT_EQ(coast.seas(), 1U);
  for (Index c = 0; c < coast.grid.size(); ++c) {
    if (coast.z[c] == before[c]) continue;
    const int j = coast.grid.row(c);
    EXPECT_TRUE(j >= 9 && j <= 11) << j;  // half the width is one cell
    EXPECT_LT(coast.z[c], 0.0F);
    EXPECT_GE(coast.z[c], -60.0F);
    EXPECT_EQ(coast.z[c] == -60.0F, j == 10);
  }
  const auto once = coast.z;
  EXPECT_EQ(open_straits(coast.grid, small_law(), coast.z), 0);
  EXPECT_EQ(coast.z, once);
}

TEST(Straits, KeepTheLimits) {
  const auto ways = [](StraitLaw law, float pass_m = 100.0F) {
    Coast coast(pass_m);
    const auto before = coast.z;
    const int number = open_straits(coast.grid, law, coast.z);
    if (number == 0) EXPECT_EQ(coast.z, before);
    return number;
  };
  EXPECT_EQ(ways(small_law(), 151.0F), 0);
  auto deep = small_law();
  deep.drawdown = 0.31;  // of seas 500 m deep: 155 m
  EXPECT_EQ(ways(deep, 151.0F), 2);
  EXPECT_EQ(ways(deep, 156.0F), 0);
  auto law = small_law();
  law.land_m = 7e4;  // eight cells of land to the ocean, four from the pond to the sea
  EXPECT_EQ(ways(law), 0);
  law = small_law();
  law.least_m2 = 1e9;  // the pond stays
  EXPECT_EQ(ways(law), 1);
}

TEST(Straits, LeadThroughTheSeasOnTheWay) {
  Coast coast;
  auto law = small_law();
  law.land_m = 1.3e5;
  // The pond comes first when it is larger, and its way leads through the sea.
  for (int i = 30; i < 40; ++i) {
    for (int j = 0; j < 21; ++j) coast.z[coast.grid.cell(i, j)] = -500.0F;
  }
  EXPECT_EQ(open_straits(coast.grid, law, coast.z), 1);
  EXPECT_EQ(coast.seas(), 1U);
}

}  // namespace
}  // namespace geo
