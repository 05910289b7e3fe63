#include "geo/kernels/numerics/smoothing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/random.hpp"

namespace geo {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kRadius_m = 6371000.0;

double distance_m(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  const double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  return kRadius_m * std::acos(std::clamp(dot, -1.0, 1.0));
}

std::array<double, 3> at(double latitude_deg, double longitude_deg) {
  const double phi = latitude_deg * kDegree, lambda = longitude_deg * kDegree;
  return {std::cos(phi) * std::cos(lambda), std::cos(phi) * std::sin(lambda), std::sin(phi)};
}

// A bump of spread 400 km, smoothed by 600 km; what it differs by from the flat-earth answer, on
// average over rings around its centre. (The plain average would depend on how cells fall into
// rings, which at a pole is a whole row at a time.)
constexpr double kPeak = 1000.0 * 400.0 * 400.0 / (400.0 * 400.0 + 600.0 * 600.0);

std::vector<double> smoothed_profile(int ny, double latitude_deg) {
  const Grid grid = Grid::sphere(2 * ny, ny);
  const auto centre = at(latitude_deg, 17.0);
  std::vector<float> field(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    const double r = distance_m(centre, grid.unit_vector(grid.column(c), grid.row(c))) / 400e3;
    field[c] = static_cast<float>(1000.0 * std::exp(-0.5 * r * r));
  }
  smooth(grid, field, 600e3);
  constexpr double kRing_m = 250e3;
  std::vector<double> sum(8, 0.0), area(8, 0.0);
  for (Index c = 0; c < grid.size(); ++c) {
    const double r = distance_m(centre, grid.unit_vector(grid.column(c), grid.row(c)));
    const auto ring = static_cast<std::size_t>(r / kRing_m);
    if (ring >= sum.size()) continue;
    const double flat = kPeak * std::exp(-0.5 * r * r / (400e3 * 400e3 + 600e3 * 600e3));
    sum[ring] += (field[c] - flat) * grid.area_m2(grid.row(c));
    area[ring] += grid.area_m2(grid.row(c));
  }
  for (std::size_t r = 0; r < sum.size(); ++r) sum[r] /= area[r];
  return sum;
}

TEST(Smoothing, IsTheSameAtEveryLatitude) {
  const auto equator = smoothed_profile(180, 0.0);
  for (const double latitude : {-90.0, 90.0, 87.0, 80.0, 60.0, -35.0}) {
    const auto here = smoothed_profile(180, latitude);
    for (std::size_t r = 0; r < here.size(); ++r) {
      EXPECT_NEAR(here[r], equator[r], 0.015 * kPeak) << "latitude " << latitude << " ring " << r;
    }
  }
}

TEST(Smoothing, BroadlyIsTheSameBlurAtEveryLatitude) {
  const Grid grid = Grid::sphere(1024, 512);  // cells of 39 km
  for (const double latitude : {0.0, 52.0, 78.0, 90.0}) {
    const auto centre = at(latitude, 100.0);
    std::vector<float> field(grid.size());
    double before = 0.0, after = 0.0;
    for (Index c = 0; c < grid.size(); ++c) {
      const double r = distance_m(centre, grid.unit_vector(grid.column(c), grid.row(c))) / 300e3;
      field[c] = static_cast<float>(1000.0 * std::exp(-0.5 * r * r));
      before += field[c] * grid.area_m2(grid.row(c));
    }
    smooth_broadly(grid, field, 500e3);
    constexpr double kSpread_m2 = 300e3 * 300e3 + 500e3 * 500e3;
    double worst = 0.0;
    constexpr double kFlatPeak = 1000.0 * 300e3 * 300e3 / kSpread_m2;
    for (Index c = 0; c < grid.size(); ++c) {
      const double r = distance_m(centre, grid.unit_vector(grid.column(c), grid.row(c)));
      const double flat = kFlatPeak * std::exp(-0.5 * r * r / kSpread_m2);
      worst = std::max(worst, std::abs(field[c] - flat) / kFlatPeak);
      after += field[c] * grid.area_m2(grid.row(c));
    }
    EXPECT_LT(worst, 0.02) << "latitude " << latitude;
    EXPECT_NEAR(after, before, 3e-3 * before) << "latitude " << latitude;
  }
}

TEST(Smoothing, BroadlyFallsBackToCellsWhereTheBellIsNarrow) {
  const Grid grid = Grid::sphere(90, 45);
  std::vector<float> field(grid.size(), 0.0F), same = field;
  field[1234] = same[1234] = 100.0F;
  smooth(grid, field, 900e3);
  smooth_broadly(grid, same, 900e3);
  EXPECT_EQ(field, same);
}

TEST(Smoothing, IsTheSameAtTwoResolutions) {
  for (const double latitude : {0.0, 50.0, 85.0}) {
    const auto coarse = smoothed_profile(90, latitude), fine = smoothed_profile(270, latitude);
    for (std::size_t r = 0; r < fine.size(); ++r) {
      EXPECT_NEAR(coarse[r], fine[r], 0.015 * kPeak) << "latitude " << latitude << " ring " << r;
    }
  }
}

TEST(Smoothing, SpreadsAPointToTheGivenLength) {
  const Grid grid = Grid::plane(201, 161, 1e3, 1.25e3);
  std::vector<float> field(grid.size(), 0.0F);
  field[grid.cell(100, 80)] = 1.0F;
  smooth(grid, field, 8e3);
  double mass = 0.0, xx = 0.0, yy = 0.0;
  for (Index c = 0; c < grid.size(); ++c) {
    mass += field[c];
    xx += field[c] * std::pow(grid.x_m(grid.column(c)), 2);
    yy += field[c] * std::pow(grid.y_m(grid.row(c)), 2);
  }
  EXPECT_NEAR(mass, 1.0, 1e-6);
  EXPECT_NEAR(std::sqrt(xx), 8e3, 5.0);  // the edges cut off a last trace
  EXPECT_NEAR(std::sqrt(yy), 8e3, 5.0);
  // Round, and a Gaussian: every value within 2 % of the peak of the exact one.
  const double peak = 1.25 / (2.0 * std::numbers::pi * 64.0);  // per cell of 1.25 km2
  for (Index c = 0; c < grid.size(); ++c) {
    const double r = std::hypot(grid.x_m(grid.column(c)), grid.y_m(grid.row(c))) / 8e3;
    ASSERT_NEAR(field[c], peak * std::exp(-0.5 * r * r), 0.02 * peak);
  }
  EXPECT_GT(*std::min_element(field.begin(), field.end()), -1e-9F);
}

TEST(Smoothing, NothingCrossesTheMask) {
  const Grid grid = Grid::sphere(120, 60);
  const RandomStream random(1, "smoothing_test");
  std::vector<float> field(grid.size());
  std::vector<std::uint8_t> land(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    const auto p = grid.unit_vector(grid.column(c), grid.row(c));
    land[c] = p[0] + 0.3 * std::sin(5.0 * p[1]) > 0.1;
    field[c] = land[c] != 0 ? static_cast<float>(random.uniform(c, 0, 10.0, 20.0))
                            : static_cast<float>(random.uniform(c, 0, -90.0, -80.0));
  }
  const auto land_mass = [&] {
    double sum = 0.0;
    for (Index c = 0; c < grid.size(); ++c) {
      if (land[c] != 0) sum += field[c] * grid.area_m2(grid.row(c));
    }
    return sum;
  };
  const auto original = field;
  const double before = land_mass();
  smooth(grid, field, 1e6, land);
  double change = 0.0;
  int cells = 0;
  EXPECT_NEAR(land_mass() / before, 1.0, 1e-7);
  for (Index c = 0; c < grid.size(); ++c) {
    if (land[c] == 0) {
      ASSERT_EQ(field[c], original[c]);
    } else {
      ASSERT_TRUE(field[c] > 10.0F && field[c] < 20.0F);
      change += std::abs(field[c] - original[c]);
      ++cells;
    }
  }
  EXPECT_GT(change / cells, 2.0);  // uniform over 10 units: 2.5 when levelled
}

TEST(Smoothing, RefusesANegativeLength) {
  const Grid grid = Grid::plane(5, 5, 1.0, 1.0);
  std::vector<float> field(25, 1.0F);
  EXPECT_THROW(smooth(grid, field, -1.0), InputError);
}

}  // namespace
}  // namespace geo
