#include "geo/kernels/remapping/resample.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geo/core/error.hpp"
#include "geo/core/random.hpp"

namespace geo {
namespace {

std::vector<float> random_values(const Grid& grid, std::uint64_t seed) {
  const RandomStream random(seed, "resample");
  std::vector<float> values(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    values[cell] = static_cast<float>(random.uniform(cell, 0, -5000.0, 5000.0));
  }
  return values;
}

double mean(const Grid& grid, const std::vector<float>& values) {
  double sum = 0.0;
  for (Index cell = 0; cell < grid.size(); ++cell) {
    sum += values[cell] * grid.area_m2(grid.row(cell));
  }
  return sum / grid.total_area_m2();
}

std::vector<float> resampled(const Grid& from, const std::vector<float>& values, const Grid& to) {
  std::vector<float> result(to.size());
  resample_raster(raster_of(from), values, raster_of(to), result, to.figure());
  return result;
}

TEST(Resample, CoarserGridKeepsTheMeanForAnySizes) {
  const Ellipsoid mars{3.3962e6, 0.00589};
  for (const Ellipsoid figure : {Ellipsoid{}, mars}) {
    const Grid from = Grid::sphere(120, 61, figure);
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const auto values = random_values(from, seed);
      for (const auto& [nx, ny] : {std::pair{60, 30}, {118, 59}, {120, 61}, {34, 17}, {120, 5}}) {
        const Grid to = Grid::sphere(nx, ny, figure);
        EXPECT_NEAR(mean(to, resampled(from, values, to)), mean(from, values), 1e-3)
            << "seed " << seed << ", " << nx << " x " << ny;
      }
    }
  }
}

TEST(Resample, ConstantsStayConstant) {
  const Grid from = Grid::sphere(36, 18);
  const std::vector<float> values(from.size(), 1234.5F);
  for (const auto& [nx, ny] : {std::pair{12, 7}, {36, 18}, {100, 51}, {100, 9}, {10, 99}}) {
    for (const float value : resampled(from, values, Grid::sphere(nx, ny))) {
      EXPECT_FLOAT_EQ(value, 1234.5F);
    }
  }
}

TEST(Resample, SameGridIsCopiedBitForBit) {
  const Grid grid = Grid::sphere(64, 32);
  const auto values = random_values(grid, 7);
  EXPECT_EQ(resampled(grid, values, grid), values);
}

TEST(Resample, CoarseCellHoldsTheAreaMeanOfFineOnes) {
  const Grid fine = Grid::sphere(8, 6), coarse = Grid::sphere(4, 3);
  const auto values = random_values(fine, 3);
  const auto result = resampled(fine, values, coarse);
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 4; ++i) {
      double sum = 0.0, area = 0.0;
      for (int b = 2 * j; b < 2 * j + 2; ++b) {
        for (int a = 2 * i; a < 2 * i + 2; ++a) {
          sum += values[fine.cell(a, b)] * fine.area_m2(b);
          area += fine.area_m2(b);
        }
      }
      EXPECT_NEAR(result[coarse.cell(i, j)], sum / area, 1e-3);
    }
  }
}

TEST(Resample, FinerGridConvergesAtSecondOrderAcrossPolesAndDateLine) {
  // A polynomial of the unit vector: smooth everywhere on the sphere.
  const auto smooth = [](const Grid& grid) {
    std::vector<float> values(grid.size());
    for (Index cell = 0; cell < grid.size(); ++cell) {
      const auto p = grid.unit_vector(grid.column(cell), grid.row(cell));
      values[cell] = static_cast<float>(1000.0 * (p[0] * p[2] + p[1] + 0.5 * p[2]));
    }
    return values;
  };
  const Grid to = Grid::sphere(512, 256);
  const auto exact = smooth(to);
  const auto error = [&](int ny) {
    const Grid from = Grid::sphere(2 * ny, ny);
    const auto result = resampled(from, smooth(from), to);
    double greatest = 0.0;
    for (Index cell = 0; cell < to.size(); ++cell) {
      greatest = std::max(greatest, std::abs(double{result[cell]} - exact[cell]));
    }
    return greatest;
  };
  const double order = std::log2(error(16) / error(32));
  EXPECT_GT(order, 1.7) << "errors " << error(16) << ", " << error(32);
}

TEST(Resample, PlaneMeansAreExactAndKeptWithin) {
  const Grid from = Grid::plane(30, 20, 100.0, 50.0), to = Grid::plane(7, 9, 400.0, 100.0);
  // Linear in x: its mean over any cell is its value in the middle.
  std::vector<float> values(from.size());
  for (Index cell = 0; cell < from.size(); ++cell) {
    values[cell] = static_cast<float>(from.x_m(from.column(cell)));
  }
  const auto result = resampled(from, values, to);
  for (Index cell = 0; cell < to.size(); ++cell) {
    EXPECT_NEAR(result[cell], to.x_m(to.column(cell)), 1e-3);
  }
  EXPECT_THROW(resampled(from, values, Grid::plane(31, 20, 100.0, 50.0)), InputError);
  EXPECT_THROW(resampled(from, values, Grid::sphere(8, 4)), InputError);
}

}  // namespace
}  // namespace geo
