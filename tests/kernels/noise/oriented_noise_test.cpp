#include "geo/kernels/noise/oriented_noise.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <functional>
#include <vector>

namespace geo {
namespace {

/// Crests at an angle from east, everywhere.
Orientation at_angle(const Grid& grid, double degrees) {
  const double twice = 2.0 * degrees * 3.14159265358979 / 180.0;
  return {std::vector<float>(grid.size(), static_cast<float>(std::cos(twice))),
          std::vector<float>(grid.size(), static_cast<float>(std::sin(twice)))};
}

std::vector<float> noise_on(const Grid& grid, const Grid& on, const Orientation& crests,
                            const OrientedBand& band, std::uint64_t seed = 1) {
  std::vector<float> values(grid.size(), 0.0F);
  add_oriented_noise(grid, on, crests, band, 1.0, seed, "test", values);
  return values;
}

constexpr OrientedBand kBroad{.wavelength_km = 900.0, .width_km = 800.0, .length_km = 2400.0};

double mean_square(const Grid& grid, const std::function<double(int, int)>& value) {
  double sum = 0.0, area = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    if (std::abs(grid.latitude_deg(j)) > 60.0) continue;  // where east turns little
    for (int i = 0; i < grid.nx(); ++i) {
      const double v = value(i, j);
      sum += v * v * grid.area_m2(j);
      area += grid.area_m2(j);
    }
  }
  return sum / area;
}

TEST(OrientedNoise, HasUnitDeviation) {
  const Grid grid = Grid::sphere(180, 90);
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto z = noise_on(grid, grid, at_angle(grid, 30.0), kBroad, seed);
    sum += mean_square(grid, [&](int i, int j) { return z[grid.cell(i, j)]; });
  }
  EXPECT_NEAR(std::sqrt(sum / 8.0), 1.0, 0.1);
}

TEST(OrientedNoise, VariesAcrossItsCrestsAndLittleAlongThem) {
  const Grid grid = Grid::sphere(240, 120);
  for (const bool along_east : {true, false}) {
    const auto z = noise_on(grid, grid, at_angle(grid, along_east ? 0.0 : 90.0), kBroad);
    const auto slope = [&](Direction ahead, Direction back) {
      return mean_square(grid, [&](int i, int j) {
        const double rise = z[grid.neighbour(i, j, ahead)] - z[grid.neighbour(i, j, back)];
        return rise / grid.distances_m(j)[ahead];
      });
    };
    const double east = slope(kEast, kWest), north = slope(kNorth, kSouth);
    EXPECT_GT(along_east ? north / east : east / north, 8.0) << along_east;
  }
}

TEST(OrientedNoise, IsNotWhereThereIsNoDirection) {
  const Grid grid = Grid::sphere(120, 60);
  Orientation crests = at_angle(grid, 0.0);
  for (Index cell = 0; cell < grid.size() / 2; ++cell) {
    crests.cosine[cell] = crests.sine[cell] = 0.0F;
  }
  const auto z = noise_on(grid, grid, crests, kBroad);
  for (Index cell = 0; cell < grid.size() / 2; ++cell) EXPECT_EQ(z[cell], 0.0F);
  EXPECT_NE(z[grid.cell(10, 45)], 0.0F);
}

TEST(OrientedNoise, IsTheSameOnEveryGridThatShowsIt) {
  const Grid coarse = Grid::sphere(144, 72), fine = Grid::sphere(432, 216);
  const Orientation crests = at_angle(coarse, 60.0);
  const auto on_coarse = noise_on(coarse, coarse, crests, kBroad);
  const auto on_fine = noise_on(fine, coarse, crests, kBroad);
  for (Index c = 0; c < coarse.size(); ++c) {
    if (std::abs(coarse.latitude_deg(coarse.row(c))) > 75.0) continue;
    EXPECT_NEAR(on_coarse[c], on_fine[fine.cell(3 * coarse.column(c) + 1, 3 * coarse.row(c) + 1)],
                0.02);
  }
}

TEST(OrientedNoise, LeavesOutWhatAGridCannotShow) {
  const Grid grid = Grid::sphere(36, 18);  // cells of 1100 km
  for (const float z : noise_on(grid, grid, at_angle(grid, 0.0), kBroad)) EXPECT_EQ(z, 0.0F);
}

TEST(OrientedNoise, IsTheSameForAnyNumberOfThreads) {
  const Grid grid = Grid::sphere(120, 60);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const auto one = noise_on(grid, grid, at_angle(grid, 20.0), kBroad);
  omp_set_num_threads(4);
  const auto four = noise_on(grid, grid, at_angle(grid, 20.0), kBroad);
  omp_set_num_threads(threads);
  EXPECT_EQ(one, four);
}

TEST(Orientation, OfLevelLinesIsAcrossTheGradient) {
  const Grid grid = Grid::sphere(90, 46);
  std::vector<float> zonal(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    zonal[c] = static_cast<float>(grid.latitude_deg(grid.row(c)));
  }
  const Orientation east = level_lines(grid, zonal);
  const Orientation north = across(east);
  for (int j = 2; j < grid.ny() - 2; ++j) {
    EXPECT_NEAR(east.cosine[grid.cell(5, j)], 1.0F, 1e-5F);
    EXPECT_NEAR(north.cosine[grid.cell(5, j)], -1.0F, 1e-5F);
  }
}

}  // namespace
}  // namespace geo
