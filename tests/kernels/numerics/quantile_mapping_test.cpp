#include "geo/kernels/numerics/quantile_mapping.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/kernels/numerics/quantiles.hpp"

namespace geo {
namespace {

const std::vector<double> kFraction{0.0, 0.1, 0.4, 0.7, 1.0};
const std::vector<double> kValue{-9000.0, -5500.0, -3800.0, 0.0, 6000.0};

double wanted(double fraction) {
  std::size_t i = 1;
  while (kFraction[i] < fraction) ++i;
  return std::lerp(kValue[i - 1], kValue[i],
                   (fraction - kFraction[i - 1]) / (kFraction[i] - kFraction[i - 1]));
}

std::vector<float> relief(const Grid& grid) {
  std::vector<float> z(grid.size());
  for (Index c = 0; c < grid.size(); ++c) z[c] = static_cast<float>(std::sin(1.7 * c) + 1e-7 * c);
  return z;
}

TEST(QuantileMapping, QuantilesByAreaAreTheTargets) {
  const Grid grid = Grid::sphere(1024, 512);
  std::vector<float> z = relief(grid);
  map_quantiles(grid, {kFraction, kValue}, z);
  std::vector<double> fractions;
  for (int permille = 0; permille <= 1000; ++permille) fractions.push_back(permille / 1000.0);
  const std::vector<float> found = quantiles(grid, z, fractions);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i], wanted(fractions[i]), 1.0) << fractions[i];
  }
}

TEST(QuantileMapping, KeepsTheOrderOfCells) {
  const Grid grid = Grid::sphere(128, 64);
  const std::vector<float> before = relief(grid);
  std::vector<float> after = before;
  map_quantiles(grid, {kFraction, kValue}, after);
  for (Index c = 1; c < grid.size(); ++c) {
    if (before[c] == before[c - 1]) {
      EXPECT_EQ(after[c], after[c - 1]);
    } else {
      EXPECT_EQ(before[c] > before[c - 1], after[c] > after[c - 1]) << c;
    }
  }
}

TEST(QuantileMapping, EqualCellsStayEqual) {
  const Grid grid = Grid::sphere(16, 8);
  std::vector<float> z(grid.size(), 7.0F);
  map_quantiles(grid, {kFraction, kValue}, z);
  for (const float value : z) EXPECT_FLOAT_EQ(value, static_cast<float>(wanted(0.5)));
}

TEST(QuantileMapping, RefusesWhatIsNoDistribution) {
  const Grid grid = Grid::sphere(16, 8);
  std::vector<float> z(grid.size(), 7.0F);
  const std::vector<double> half{0.0, 0.5}, falling{1.0, 0.0}, whole{0.0, 1.0};
  EXPECT_THROW(map_quantiles(grid, {half, whole}, z), InputError);
  EXPECT_THROW(map_quantiles(grid, {whole, falling}, z), InputError);
  z[5] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(map_quantiles(grid, {whole, whole}, z), InputError);
}

}  // namespace
}  // namespace geo
