// Curves of heights, against exact values.
#include "geo/kernels/landscape/hypsometric_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/numerics/quantiles.hpp"

namespace geo {
namespace {

TEST(Hypsometry, PowerLawBringsTheMedianOfLandToItsAim) {
  const Grid grid = Grid::sphere(256, 128);
  const Noise noise(5, "heights");
  std::vector<float> height(grid.size());
  std::vector<std::uint8_t> land(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const auto p = grid.unit_vector(grid.column(cell), grid.row(cell));
    height[cell] = 9000.0F * noise.fbm(p, 2.0, 6) - 200.0F;
    land[cell] = height[cell] > 0.0F;
  }
  const auto before = height;
  const double alpha = bend_hypsometry(grid, height, 400.0, 25e3);
  EXPECT_GT(alpha, 1.0);
  EXPECT_LE(alpha, 5.0);
  EXPECT_NEAR(quantile(grid, height, 0.5, land), 400.0, 8.0);
  for (Index cell = 0; cell < grid.size(); ++cell) {
    if (land[cell] != 0) {
      ASSERT_GT(height[cell], 0.0F);
    } else {
      ASSERT_EQ(height[cell], before[cell]);
    }
  }
  // Without smoothing it is the formula itself.
  height = before;
  const double most = quantile(grid, before, 1.0, land), median = quantile(grid, before, 0.5, land);
  const double exact = std::log(400.0 / most) / std::log(median / most);
  EXPECT_NEAR(bend_hypsometry(grid, height, 400.0, 0.0), exact, 1e-3);
  for (Index cell = 0; cell < grid.size(); ++cell) {
    if (land[cell] == 0 || before[cell] < 50.0F) continue;
    ASSERT_NEAR(height[cell], most * std::pow(before[cell] / most, exact), 0.2);
  }
}

}  // namespace
}  // namespace geo
