#include "geo/kernels/numerics/quantiles.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "geo/core/error.hpp"
#include "geo/core/random.hpp"

namespace geo {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::vector<float> rough_field(const Grid& grid, std::uint64_t seed) {
  const RandomStream random(seed, "quantiles_test");
  std::vector<float> field(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    // Values of both signs and all sizes, many of them equal, some missing.
    const double v = random.normal(c);
    field[c] = static_cast<float>(c % 3 == 0 ? std::round(v) : v * std::pow(10.0, c % 7 - 3));
    if (c % 31 == 0) field[c] = kNan;
    if (c % 37 == 0) field[c] = -0.0F;
  }
  return field;
}

struct Sorted {
  std::vector<std::pair<float, double>> cells;  // value, area
  double area = 0.0;
};

Sorted sort_cells(const Grid& grid, const std::vector<float>& field,
                  const std::vector<std::uint8_t>& mask) {
  Sorted sorted;
  for (Index c = 0; c < grid.size(); ++c) {
    if ((!mask.empty() && mask[c] == 0) || std::isnan(field[c])) continue;
    sorted.cells.emplace_back(field[c], grid.area_m2(grid.row(c)));
    sorted.area += sorted.cells.back().second;
  }
  std::stable_sort(sorted.cells.begin(), sorted.cells.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  return sorted;
}

float brute_quantile(const Sorted& sorted, double fraction) {
  double sum = 0.0;
  for (const auto& [value, area] : sorted.cells) {
    sum += area;
    if (sum >= fraction * sorted.area) return value;
  }
  return sorted.cells.back().first;
}

TEST(Quantiles, MatchBruteForceOnEveryTopology) {
  for (const Grid& grid : {Grid::sphere(62, 31), Grid::plane(40, 33, 10.0, 20.0),
                           Grid::window(30, 50, {20.0, 80.0, 10.0, 40.0})}) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const auto field = rough_field(grid, seed);
      std::vector<std::uint8_t> mask;
      if (seed % 2 == 1) {
        for (Index c = 0; c < grid.size(); ++c) mask.push_back(c % 5 != 0);
      }
      const Sorted sorted = sort_cells(grid, field, mask);
      // Irrational fractions: no cumulative area comes within round-off of them.
      std::vector<double> fractions{0.0, 1.0};
      for (int i = 1; i < 30; ++i) fractions.push_back(std::fmod(i * std::numbers::phi, 1.0));
      const auto values = quantiles(grid, field, fractions, mask);
      for (std::size_t i = 0; i < fractions.size(); ++i) {
        ASSERT_EQ(values[i], brute_quantile(sorted, fractions[i]))
            << "seed " << seed << " fraction " << fractions[i];
      }
    }
  }
}

TEST(Quantiles, WeighCellsByTheirAreaOnTheSphere) {
  const Grid grid = Grid::sphere(360, 180);
  std::vector<float> latitude(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    latitude[c] = static_cast<float>(grid.latitude_deg(grid.row(c)));
  }
  // Below latitude p lies (1 + sin p) / 2 of a sphere.
  for (const double degrees : {-60.0, -30.0, 0.0, 45.0, 80.0}) {
    const double fraction = 0.5 * (1.0 + std::sin(degrees * std::numbers::pi / 180.0));
    EXPECT_NEAR(quantile(grid, latitude, fraction), degrees, 0.5001);
    EXPECT_NEAR(fraction_below(grid, latitude, static_cast<float>(degrees)), fraction, 1e-12);
  }
}

TEST(Quantiles, LevelForFractionIsTheNearestPossible) {
  const Grid grid = Grid::sphere(24, 12);
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const auto field = rough_field(grid, seed);
    const RandomStream random(seed, "fractions");
    for (int i = 0; i < 20; ++i) {
      const double wanted = random.uniform(i);
      const double found =
          fraction_below(grid, field, level_for_fraction(grid, field, wanted)) - wanted;
      double best = std::min(wanted, 1.0 - wanted);
      for (const float value : field) {
        if (std::isnan(value)) continue;
        best = std::min(best, std::abs(fraction_below(grid, field, value) - wanted));
      }
      ASSERT_NEAR(std::abs(found), best, 1e-12) << "seed " << seed << " wanted " << wanted;
    }
    EXPECT_EQ(fraction_below(grid, field, level_for_fraction(grid, field, 1.0)), 1.0);
    EXPECT_EQ(fraction_below(grid, field, level_for_fraction(grid, field, 0.0)), 0.0);
  }
}

TEST(Quantiles, SameForAnyNumberOfThreads) {
  const Grid grid = Grid::sphere(200, 100);
  const auto field = rough_field(grid, 5);
  const std::vector<double> fractions{0.05, 0.25, 0.5, 0.71, 0.95};
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const auto one = quantiles(grid, field, fractions);
  const double mean = area_mean(grid, field);
  omp_set_num_threads(4);
  EXPECT_EQ(quantiles(grid, field, fractions), one);
  EXPECT_EQ(area_mean(grid, field), mean);
  omp_set_num_threads(threads);
}

TEST(Quantiles, MeanOfAConstantIsTheConstant) {
  const Grid grid = Grid::sphere(36, 18);
  EXPECT_NEAR(area_mean(grid, std::vector<float>(grid.size(), 7.5F)), 7.5, 1e-12);
}

TEST(Quantiles, RefuseWhatHasNoAnswer) {
  const Grid grid = Grid::plane(5, 5, 1.0, 1.0);
  const std::vector<float> field(25, 1.0F);
  EXPECT_THROW((void)quantile(grid, std::vector<float>(24), 0.5), InputError);
  EXPECT_THROW((void)quantile(grid, field, 1.5), InputError);
  EXPECT_THROW((void)quantile(grid, field, std::nan("")), InputError);
  EXPECT_THROW((void)quantile(grid, std::vector<float>(25, kNan), 0.5), InputError);
  EXPECT_THROW((void)area_mean(grid, field, std::vector<std::uint8_t>(25, 0)), InputError);
}

}  // namespace
}  // namespace geo
