// Coasts that move: floor that belts lift out of the sea, flats that the sea drowns.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "geo/kernels/water/flow_graph.hpp"
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

}  // namespace
}  // namespace geo
