// Spherical harmonics, against exact values.
#include "geo/kernels/numerics/spherical_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(SphericalFilter, ScalesEachHarmonicByItsGain) {
  const Grid grid = Grid::sphere(128, 64);
  std::vector<float> field(grid.size()), expected(grid.size());
  for (int j = 0; j < grid.ny(); ++j) {
    const double s = std::sin(grid.latitude_deg(j) * kPi / 180.0), c = std::sqrt(1.0 - s * s);
    for (int i = 0; i < grid.nx(); ++i) {
      const double lon = grid.longitude_deg(i) * kPi / 180.0;
      const double y32 = c * c * s * std::cos(2.0 * lon);              // degree 3
      const double y10 = s, y77 = std::pow(c, 7) * std::sin(7 * lon);  // degrees 1 and 7
      field[grid.cell(i, j)] = static_cast<float>(2.0 + y10 + 5.0 * y32 + 3.0 * y77);
      expected[grid.cell(i, j)] = static_cast<float>(1.0 + 0.5 * y10 + 10.0 * y32);
    }
  }
  filter_degrees(grid, field, std::vector<double>{0.5, 0.5, 9.0, 2.0, 1.0, 1.0, 1.0, 0.0});
  for (Index cell = 0; cell < grid.size(); ++cell) ASSERT_NEAR(field[cell], expected[cell], 2e-5);
}

}  // namespace
}  // namespace geo
