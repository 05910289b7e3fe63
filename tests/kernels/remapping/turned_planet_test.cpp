#include "geo/kernels/remapping/turned_planet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geo/core/turn.hpp"

namespace geo {
namespace {

/// A smooth field of the sphere.
double wave(const std::array<double, 3>& r) {
  return 3.0 * r[0] * r[1] + 2.0 * r[2] * r[2] - r[0] + 0.5 * r[1] * r[2];
}

std::vector<float> waves_on(const Grid& grid) {
  std::vector<float> values(grid.size());
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      values[grid.cell(i, j)] = static_cast<float>(wave(grid.unit_vector(i, j)));
    }
  }
  return values;
}

TEST(TurnedField, IsThatOfThePlanetAtEachPlaceAtThePolesToo) {
  const Grid source = Grid::sphere(512, 256);
  const std::vector<float> values = waves_on(source);
  for (const Centre pole : {Centre{35.0, -120.0}, Centre{-90.0, 0.0}, Centre{0.5, 179.0}}) {
    const Grid target = Grid::sphere(256, 128, {}, turn_to_pole(pole, 40.0));
    const auto laid = laid_out_turned(source, values, target);
    const auto expected = waves_on(target);
    for (Index c = 0; c < target.size(); ++c) ASSERT_NEAR(laid[c], expected[c], 2e-3) << c;
  }
}

TEST(TurnedField, StaysWithinItsValuesAndLeavesGaps) {
  const Grid source = Grid::sphere(64, 32);
  std::vector<float> values(source.size(), 0.0F);
  for (Index c = 0; c < source.size(); ++c) values[c] = c % 3 == 0 ? 7.0F : 0.0F;
  const Grid target = Grid::sphere(128, 64, {}, turn_to_pole({20.0, 50.0}, 0.0));
  for (const float value : laid_out_turned(source, values, target)) {
    ASSERT_GE(value, 0.0F);
    ASSERT_LE(value, 7.0F);
  }
  values[source.cell(32, 16)] = NAN;
  const auto laid = laid_out_turned(source, values, target);
  const auto gaps = std::count_if(laid.begin(), laid.end(), [](float v) { return std::isnan(v); });
  EXPECT_GT(gaps, 0);
  EXPECT_LT(gaps, 40);
}

}  // namespace
}  // namespace geo
