#include "geo/kernels/landscape/sea_level.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "geo/core/error.hpp"

namespace geo {
namespace {

TEST(SeaLevel, OverAFlatFloorIsVolumeByArea) {
  const Grid grid = Grid::sphere(64, 32);
  const std::vector<float> floor_m(grid.size(), -4000.0F);
  const double volume_m3 = 2700.0 * grid.total_area_m2();
  EXPECT_NEAR(sea_level_for_volume(grid, floor_m, volume_m3), -1300.0, 1e-6);
}

TEST(SeaLevel, TheWaterBelowTheLevelIsTheVolumeAskedFor) {
  const Grid grid = Grid::sphere(256, 128);
  std::vector<float> relief_m(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    relief_m[c] = static_cast<float>(4000.0 * std::sin(0.37 * c) - 1500.0);
  }
  double before_m = -1e9;
  for (const double volume_m3 : {1e10, 1e17, 1.334e18, 2e19}) {
    const double level_m = sea_level_for_volume(grid, relief_m, volume_m3);
    double held_m3 = 0.0;
    for (Index c = 0; c < grid.size(); ++c) {
      held_m3 += grid.area_m2(grid.row(c)) * std::max(0.0, level_m - relief_m[c]);
    }
    EXPECT_NEAR(held_m3 / volume_m3, 1.0, 1e-6) << volume_m3;
    EXPECT_GT(level_m, before_m);
    before_m = level_m;
  }
}

TEST(SeaLevel, RefusesWhatHasNoLevel) {
  const Grid grid = Grid::sphere(8, 4);
  std::vector<float> relief_m(grid.size(), 0.0F);
  EXPECT_THROW(sea_level_for_volume(grid, relief_m, 0.0), InputError);
  EXPECT_THROW(sea_level_for_volume(grid, std::vector<float>(3), 1e18), InputError);
  relief_m[3] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(sea_level_for_volume(grid, relief_m, 1e18), InputError);
}

}  // namespace
}  // namespace geo
