// Coasts that move: floor that belts lift out of the sea, flats that the sea drowns.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "geo/kernels/water/flow_graph.hpp"
#include "geo/kernels/water/sea_parts.hpp"
#include "geo/stages/erosion/landscape.hpp"
#include "geo/stages/erosion/seas.hpp"
#include "geo/stages/erosion/wear_down.hpp"

namespace geo {
namespace {

/// A shallow sea between land, all of which rises by more than the sea is deep.
TEST(Coasts, FloorThatABeltLiftsOutOfTheSeaIsLandBeforeWaterIsRouted) {
  ErosionParameters p;
  p.steps = 1;
  const Grid grid = Grid::sphere(32, 16);
  std::vector<float> z(grid.size(), 300.0F);
  const Index shallow = grid.cell(8, 8), deep = grid.cell(24, 8);
  z[shallow] = -100.0F;
  z[deep] = -4000.0F;
  const std::vector<float> thickening_m_yr(grid.size(), 5e-4F), uplift_m_yr(grid.size(), 1e-4F),
      erodibility{0.0F};
  Landscape<float> landscape(p, {}, grid, z, uplift_m_yr, thickening_m_yr, erodibility,
                             find_outlets(grid, z));
  Drainage drainage;
  bool was_land = false;
  wear_down(p,
            {.route = [&](std::int64_t) -> const Drainage& {
               was_land = landscape.outlets()[shallow] == 0;
               drain(p, grid, z, landscape.outlets(), drainage);
               return drainage;
             },
             .coast =
                 [&](std::int64_t) {
                   landscape.set_outlets(find_outlets(grid, z));
                   return true;
                 }},
            landscape);
  EXPECT_TRUE(was_land);
  EXPECT_GT(z[shallow], 0.0F);
  EXPECT_LT(z[deep], 0.0F);
  EXPECT_NEAR(landscape.rock().uplifted, 1e-4 * p.time_step_yr * grid.total_area_m2(),
              1e-6 * landscape.rock().uplifted);
}

/// A sea to the north of a plain on which its level comes to stand; land to the south.
TEST(Coasts, FlatsDrownFromTheirShoresOn) {
  const Grid grid = Grid::sphere(64, 32);
  constexpr int kPlain = 12, kSea = 18;  // first rows
  std::vector<float> z(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    z[c] = grid.row(c) >= kSea ? -1000.0F : grid.row(c) >= kPlain ? 3.0F : 100.0F;
  }
  const auto area_m2 = [&](int from, int to) {
    double sum = 0.0;
    for (int j = from; j < to; ++j) sum += grid.nx() * grid.area_m2(j);
    return sum;
  };
  constexpr int kShore = 15;  // rows from here on are to drown
  const double share = area_m2(kShore, grid.ny()) / grid.total_area_m2();
  ASSERT_TRUE(keep_sea_share({}, grid, z, share));
  for (Index c = 0; c < grid.size(); ++c) {
    const int j = grid.row(c);
    const float expected_m = j >= kSea     ? -1003.0F
                             : j >= kShore ? -5.0F
                             : j >= kPlain ? 0.0F
                                           : 97.0F;
    ASSERT_FLOAT_EQ(z[c], expected_m) << "row " << j;
  }
}

/// A sea within high land with one low pass, and a shoal off its end. The strait adds to the sea,
/// whose level falls below the shoal.
TEST(Coasts, StraitsStayOpenWhereTheSeaSinksBelowAShoalBeforeThem) {
  const Grid grid = Grid::sphere(96, 48);
  constexpr int kShelf = 4, kColumn = 48, kRow = 24, kSea = 4, kLand = 9;  // rows; from the middle
  std::vector<float> z(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    const int east = std::abs(grid.column(c) - kColumn), north = grid.row(c) - kRow;
    const int away = std::max(east, std::abs(north));
    z[c] = away <= kSea || away > kLand ? -4000.0F : east == 0 && north > 0 ? 50.0F : 2000.0F;
    if (north == kLand + 1 && east <= 1) z[c] = -0.2F;
    if (grid.row(c) < kShelf) z[c] = -10.0F;
  }
  const ErosionParameters p;
  const double share = share_of_sea(grid, z);
  ASSERT_EQ(parts_of_sea(grid, z).size(), 2U);
  std::vector<float> once = z;
  ASSERT_TRUE(join_seas(p, grid, once));
  ASSERT_TRUE(keep_sea_share(p, grid, once, share));
  ASSERT_EQ(parts_of_sea(grid, once).size(), 2U) << "the shoal does not fall dry";

  ASSERT_TRUE(settle_seas(p, grid, z, share));
  EXPECT_EQ(parts_of_sea(grid, z).size(), 1U);
  const double cell = grid.area_m2(kRow) / grid.total_area_m2();
  EXPECT_NEAR(share_of_sea(grid, z), share, cell);
}

}  // namespace
}  // namespace geo
