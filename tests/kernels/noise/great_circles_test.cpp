#include "geo/kernels/noise/great_circles.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/random.hpp"
#include "geo/kernels/crust/crust_columns.hpp"
#include "geo/kernels/crust/ocean_depth.hpp"

namespace geo {
namespace {

std::vector<Vector3> places(int n) {
  const RandomStream random(3, "great_circles_test");
  std::vector<Vector3> all;
  for (int k = 0; k < n; ++k) all.push_back(random.direction(static_cast<std::uint64_t>(k)));
  return all;
}

TEST(GreatCircles, AreTheSumOfLogisticSteps) {
  for (const double k : {3.0, 50.0, 300.0}) {
    const CircleCuts cuts{.circles = 70, .steepness = k, .offset = 0.4};
    const GreatCircles circles(cuts, 9, "test");
    const auto at = places(500);
    const auto found = great_circle_noise_at(circles, at);
    const RandomStream random(9, "test");
    for (std::size_t i = 0; i < at.size(); ++i) {
      double sum = 0.0;
      for (std::uint64_t c = 0; c < 70; ++c) {
        const double t = dot(random.direction(c), at[i]) + random.uniform(c, 1, -0.4, 0.4);
        sum += 1.0 / (1.0 + std::exp(-2.0 * k * t)) - 0.5;
      }
      // A circle's H is off by no more than 2k rounding errors of a place and 2^-22.
      EXPECT_NEAR(found[i], 2.0 / std::sqrt(70.0) * sum, 2e-7 * (10.0 + k)) << "k " << k;
    }
  }
}

TEST(GreatCircles, GiveAPlaceTheSameValueOnEveryGrid) {
  const GreatCircles circles({.circles = 400, .steepness = 120.0, .offset = 0.2}, 4, "test");
  const Grid coarse = Grid::sphere(90, 44), fine = Grid::sphere(270, 132);
  std::vector<float> on_coarse(coarse.size()), on_fine(fine.size());
  great_circle_noise(coarse, circles, on_coarse);
  great_circle_noise(fine, circles, on_fine);
  std::vector<Vector3> all;
  for (Index c = 0; c < coarse.size(); ++c) {
    all.push_back(coarse.unit_vector(coarse.column(c), coarse.row(c)));
  }
  const auto alone = great_circle_noise_at(circles, all);
  for (Index c = 0; c < coarse.size(); ++c) {
    // The middle of three cells; its position may round differently.
    const Index f = fine.cell(3 * coarse.column(c) + 1, 3 * coarse.row(c) + 1);
    EXPECT_NEAR(on_coarse[c], on_fine[f], 2e-4) << c;
    EXPECT_EQ(on_coarse[c], alone[c]) << c;
  }
}

TEST(GreatCircles, AreOddBetweenAntipodesUnlessOffset) {
  const auto at = places(300);
  std::vector<Vector3> opposite;
  for (const Vector3& unit : at) opposite.push_back(scaled(unit, -1.0));
  const auto asymmetry = [&](double offset) {
    const GreatCircles circles({.circles = 300, .offset = offset}, 2, "test");
    const auto here = great_circle_noise_at(circles, at);
    const auto there = great_circle_noise_at(circles, opposite);
    double most = 0.0;
    for (std::size_t k = 0; k < at.size(); ++k) {
      most = std::max(most, std::abs(static_cast<double>(here[k]) + there[k]));
    }
    return most;
  };
  EXPECT_LT(asymmetry(0.0), 1e-4);
  EXPECT_GT(asymmetry(0.5), 0.5);
}

TEST(GreatCircles, RoughenAsTheRootOfDistance) {
  // Two places a distance d apart (radians) lie on two sides of a circle with probability d / pi.
  const RandomStream random(8, "great_circles_test.pairs");
  for (const double d : {0.05, 0.2, 0.8}) {
    double squares = 0.0;
    int n = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
      const GreatCircles circles({.circles = 60, .steepness = 2000.0}, seed, "test");
      std::vector<Vector3> pairs;
      for (std::uint64_t k = 0; k < 60; ++k) {
        const Vector3 a = random.direction(k);
        const Vector3 aside = normalised(tangent(random.direction(k + 1000), a));
        pairs.push_back(a);
        pairs.push_back(add(scaled(a, std::cos(d)), aside, std::sin(d)));
      }
      const auto h = great_circle_noise_at(circles, pairs);
      for (std::size_t k = 0; k < h.size(); k += 2, ++n) {
        squares += std::pow(static_cast<double>(h[k]) - h[k + 1], 2);
      }
    }
    EXPECT_NEAR(squares / n / (4.0 * d / 3.14159265), 1.0, 0.06) << d;
  }
}

TEST(GreatCircles, GiveTheSameBitsForAnyNumberOfThreads) {
  const Grid grid = Grid::sphere(200, 100);
  const GreatCircles circles({.circles = 200}, 5, "test");
  std::vector<float> one(grid.size()), four(grid.size());
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  great_circle_noise(grid, circles, one);
  omp_set_num_threads(4);
  great_circle_noise(grid, circles, four);
  omp_set_num_threads(threads);
  EXPECT_EQ(one, four);
}

TEST(GreatCircles, RefuseWhatIsNoCut) {
  EXPECT_THROW(GreatCircles({.circles = 0}, 1, "test"), ConfigurationError);
  EXPECT_THROW(GreatCircles({.steepness = 0.0}, 1, "test"), ConfigurationError);
  std::vector<float> few(3);
  EXPECT_THROW(great_circle_noise(Grid::sphere(8, 4), GreatCircles({}, 1, "test"), few),
               InputError);
}

TEST(CrustColumns, AreLinearBetweenThePointsAndConstantBeyond) {
  for (const CrustColumn& point : kCrustColumns) {
    const CrustColumn found = crust_column(point.elevation_m);
    EXPECT_DOUBLE_EQ(found.thickness_m, point.thickness_m);
    EXPECT_DOUBLE_EQ(found.density_kg_m3, point.density_kg_m3);
  }
  EXPECT_DOUBLE_EQ(crust_column(-8500.0).thickness_m, 4650.0);
  EXPECT_DOUBLE_EQ(crust_column(-1940.0).density_kg_m3, 2795.0);
  EXPECT_DOUBLE_EQ(crust_column(-20000.0).thickness_m, 3000.0);
  EXPECT_DOUBLE_EQ(crust_column(20000.0).thickness_m, 70000.0);
  EXPECT_DOUBLE_EQ(continental_share_of(crust_column(-4000.0)), 0.0);
  EXPECT_DOUBLE_EQ(continental_share_of(crust_column(-1940.0)), 0.5);
  EXPECT_DOUBLE_EQ(continental_share_of(crust_column(0.0)), 1.0);
}

TEST(OceanAge, IsThatOfTheDepthThatItGives) {
  for (const double age : {0.5, 7.0, 19.0, 25.0, 60.0, 110.0}) {
    EXPECT_NEAR(ocean_age_of_depth_myr(ocean_depth_m(age), 200.0), age, 0.2) << age;
  }
  EXPECT_EQ(ocean_age_of_depth_myr(1000.0, 150.0), 0.0);
  EXPECT_EQ(ocean_age_of_depth_myr(9000.0, 150.0), 150.0);
}

}  // namespace
}  // namespace geo
