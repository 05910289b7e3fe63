#include "geo/kernels/remapping/healpix.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/random.hpp"

namespace geo {
namespace {

constexpr Ellipsoid kEarth{6378137.0, 1 / 298.257223563};

std::vector<float> random_values(const Grid& grid) {
  const RandomStream random(7, "healpix");
  std::vector<float> values(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    values[cell] = static_cast<float>(1000.0 * random.uniform(cell));
  }
  return values;
}

double sum_on(const Grid& grid, const std::vector<float>& values) {
  double sum = 0.0;
  for (Index cell = 0; cell < grid.size(); ++cell) {
    sum += grid.area_m2(grid.row(cell)) * values[cell];
  }
  return sum;
}

TEST(Healpix, KeepsSumsOverThePlanetWhateverTheGrids) {
  for (const auto& grid :
       {Grid::sphere(64, 32), Grid::sphere(46, 23, kEarth), Grid::sphere(8, 5)}) {
    const auto values = random_values(grid);
    for (const int nside : {1, 2, 8, 64}) {
      const Healpix pixels(nside);
      std::vector<float> mean(pixels.size());
      HealpixRemapping(grid, pixels).mean(values, mean);
      double sum = 0.0;
      for (const float value : mean) sum += value;
      sum *= grid.total_area_m2() / pixels.size();
      // Means are floats: their rounding is what is left.
      EXPECT_NEAR(sum / sum_on(grid, values), 1.0, 1e-7) << grid.nx() << ", nside " << nside;
    }
  }
}

TEST(Healpix, KeepsAConstantExactlyAndLeavesOutGaps) {
  const Grid grid = Grid::sphere(36, 18);
  std::vector<float> values(grid.size(), 273.15F);
  const Healpix pixels(16);
  std::vector<float> mean(pixels.size());
  const HealpixRemapping remapping(grid, pixels);
  remapping.mean(values, mean);
  for (const float value : mean) ASSERT_FLOAT_EQ(value, 273.15F);
  for (Index cell = 0; cell < grid.size() / 2; ++cell) {
    values[cell] = std::numeric_limits<float>::quiet_NaN();
  }
  remapping.mean(values, mean);
  for (std::int32_t pixel = 0; pixel < pixels.size(); ++pixel) {
    const double sine = pixels.centre(pixel).sine;
    if (sine > 0.0) ASSERT_FLOAT_EQ(mean[pixel], 273.15F) << pixel;
    // Pixels at the equator reach 2 / 3 / nside beyond their centre.
    if (sine < -2.0 / 3.0 / 16.0 - 1e-9) ASSERT_TRUE(std::isnan(mean[pixel])) << pixel;
  }
}

TEST(Healpix, MeansOfSineAreThoseOfPixels) {
  // The mean of sine of latitude over a pixel whose cells are fine: that of its centre in the
  // equatorial zone, where pixels are diamonds.
  const Grid grid = Grid::sphere(720, 360);
  std::vector<float> values(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const double south = (grid.row(cell) - 180) * std::numbers::pi / 360.0;
    values[cell] =
        static_cast<float>(0.5 * (std::sin(south) + std::sin(south + std::numbers::pi / 360.0)));
  }
  const Healpix pixels(8);
  std::vector<float> mean(pixels.size());
  HealpixRemapping(grid, pixels).mean(values, mean);
  for (std::int32_t pixel = 0; pixel < pixels.size(); ++pixel) {
    const double sine = pixels.centre(pixel).sine;
    // Within a cell of 1/2 degree the sine is taken for its mean: second order in its height.
    if (std::abs(sine) < 2.0 / 3.0 - 1.0 / 8.0) EXPECT_NEAR(mean[pixel], sine, 1e-4) << pixel;
  }
}

TEST(Healpix, DominantIsWhatCoversMost) {
  const Grid grid = Grid::sphere(36, 18);
  std::vector<std::int32_t> values(grid.size(), 3);
  for (Index cell = 0; cell < grid.size(); ++cell) {
    if (grid.row(cell) >= 9) values[cell] = 5;
  }
  const Healpix pixels(4);
  std::vector<std::int32_t> result(pixels.size());
  HealpixRemapping(grid, pixels).dominant(values, result);
  for (std::int32_t pixel = 0; pixel < pixels.size(); ++pixel) {
    const double sine = pixels.centre(pixel).sine;
    if (std::abs(sine) < 1e-9) continue;  // half and half
    EXPECT_EQ(result[pixel], sine > 0.0 ? 5 : 3) << pixel;
  }
}

TEST(Healpix, RefusesSidesThatAreNoPowersOfTwoAndPartsOfPlanets) {
  for (const int nside : {-1, 0, 3, 16384})
    EXPECT_THROW(Healpix{nside}, ConfigurationError) << nside;
  EXPECT_THROW(HealpixRemapping(Grid::torus(16, 8, 1e3, 1e3), Healpix(1)), InputError);
}

}  // namespace
}  // namespace geo
