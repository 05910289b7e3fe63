#include "geo/kernels/numerics/diffusion.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/random.hpp"

namespace geo {
namespace {

std::vector<Grid> all_kinds() {
  return {Grid::sphere(50, 27), Grid::sphere(48, 24, {6378137.0, 0.1}),
          Grid::torus(37, 29, 9e3, 1.1e4), Grid::plane(41, 33, 1e4, 8e3),
          Grid::window(35, 30, {30.0, 90.0, -20.0, 60.0})};
}

std::vector<float> rough_field(const Grid& grid, std::uint64_t seed) {
  const RandomStream random(seed, "diffusion_test");
  std::vector<float> field(grid.size());
  for (Index c = 0; c < grid.size(); ++c) field[c] = static_cast<float>(random.uniform(c) * 1000.0);
  return field;
}

double mass(const Grid& grid, const std::vector<float>& field) {
  double sum = 0.0;
  for (Index c = 0; c < grid.size(); ++c) sum += field[c] * grid.area_m2(grid.row(c));
  return sum;
}

TEST(Diffusion, KeepsMassOnEveryTopologyForStepsOfAnyLength) {
  for (const Grid& grid : all_kinds()) {
    for (const double variance_m2 : {1e6, 1e10, 1e13, 1e17}) {
      for (const auto scheme : {DiffusionScheme::second_order, DiffusionScheme::positive}) {
        auto field = rough_field(grid, 3);
        const double before = mass(grid, field);
        diffuse(grid, field, variance_m2, 1.0, {.scheme = scheme});
        EXPECT_NEAR(mass(grid, field) / before, 1.0, 1e-7) << "variance " << variance_m2;
      }
    }
  }
}

TEST(Diffusion, KeepsConstants) {
  for (const Grid& grid : all_kinds()) {
    std::vector<float> field(grid.size(), 4321.0F);
    diffuse(grid, field, 1e12, 1.0);
    for (const float v : field) ASSERT_NEAR(v, 4321.0, 2e-3);
  }
}

TEST(Diffusion, VeryLongStepsLevelEverything) {
  for (const Grid& grid : all_kinds()) {
    auto field = rough_field(grid, 4);
    const double mean = mass(grid, field) / grid.total_area_m2();
    diffuse(grid, field, 1e18, 1.0);
    for (const float v : field) ASSERT_NEAR(v, mean, 0.2);
  }
}

TEST(Diffusion, PositiveSchemeStaysWithinTheRangeOnPlanes) {
  for (const Grid& grid : {Grid::torus(37, 29, 9e3, 1.1e4), Grid::plane(41, 33, 1e4, 8e3)}) {
    for (const double variance_m2 : {1e7, 1e9, 1e11}) {
      std::vector<float> field(grid.size(), 0.0F);
      field[grid.cell(10, 10)] = 1.0F;
      diffuse(grid, field, variance_m2, 1.0, {.scheme = DiffusionScheme::positive});
      for (const float v : field) ASSERT_TRUE(v >= 0.0F && v <= 1.0F) << v;
    }
  }
}

// Weak exchange is worked out without a matrix; cells that are excluded ask for the matrix, so that
// one far corner makes the same problem take the other way.
TEST(Diffusion, WeakExchangeIsTheSameWithAndWithoutAMatrix) {
  for (const Grid& grid : {Grid::sphere(180, 91), Grid::plane(80, 60, 1e4, 8e3),
                           Grid::window(70, 60, {30.0, 80.0, -20.0, 60.0})}) {
    const auto before = rough_field(grid, 9);
    std::vector<std::uint8_t> fixed(grid.size(), 0), corner(grid.size(), 0);
    for (Index c = 0; c < grid.size(); c += 3) fixed[c] = 1;
    corner[grid.size() - 1] = 1;
    const double cell_m2 = grid.area_m2(grid.ny() / 2);
    auto explicitly = before, implicitly = before;
    diffuse(grid, explicitly, 2e-3 * cell_m2, 1.0,
            {.fixed = fixed, .scheme = DiffusionScheme::positive});
    diffuse(grid, implicitly, 2e-3 * cell_m2, 1.0,
            {.fixed = fixed, .excluded = corner, .scheme = DiffusionScheme::positive});
    double most = 0.0;
    for (Index c = 0; c < grid.size() - 2 * grid.nx(); ++c) {
      // They differ by c^2 times the fourth difference, at most 8 times the range of 1000.
      ASSERT_NEAR(explicitly[c], implicitly[c], 0.01 * 0.01 * 8.0 * 1000.0);
      if (fixed[c] != 0) {
        ASSERT_EQ(explicitly[c], before[c]);
      }
      most = std::max(most, std::abs(static_cast<double>(explicitly[c]) - before[c]));
    }
    EXPECT_GT(most, 3.0);
  }
}

TEST(Diffusion, FixedCellsKeepTheirValuesAndFeedTheRest) {
  for (const Grid& grid : all_kinds()) {
    auto field = rough_field(grid, 5);
    const auto before = field;
    std::vector<std::uint8_t> fixed(grid.size(), 0);
    const RandomStream random(6, "fixed");
    for (auto& f : fixed) f = random.uniform(&f - fixed.data()) < 0.1;
    diffuse(grid, field, 1e10, 1.0, {.fixed = fixed});
    for (Index c = 0; c < grid.size(); ++c) {
      if (fixed[c] != 0) {
        ASSERT_EQ(field[c], before[c]);
      }
      ASSERT_TRUE(field[c] > -300.0F && field[c] < 1300.0F) << field[c];
    }
    // All around equal fixed cells, the rest takes their value in the end.
    for (Index c = 0; c < grid.size(); ++c) field[c] = fixed[c] != 0 ? 70.0F : 0.0F;
    for (int step = 0; step < 60; ++step) diffuse(grid, field, 1e12, 1.0, {.fixed = fixed});
    for (const float v : field) ASSERT_NEAR(v, 70.0, 0.1);
  }
}

TEST(Diffusion, NothingCrossesTheBorderOfExcludedCells) {
  for (const Grid& grid : all_kinds()) {
    auto field = rough_field(grid, 7);
    const auto before = field;
    // Two halves of the columns apart by a wall of one column at each border.
    std::vector<std::uint8_t> wall(grid.size(), 0);
    const int middle = grid.nx() / 2;
    for (int j = 0; j < grid.ny(); ++j) wall[grid.cell(0, j)] = wall[grid.cell(middle, j)] = 1;
    diffuse(grid, field, 1e13, 1.0, {.excluded = wall});
    double west = 0.0, west_before = 0.0;
    for (Index c = 0; c < grid.size(); ++c) {
      if (wall[c] != 0) {
        ASSERT_EQ(field[c], before[c]);
      }
      if (grid.column(c) >= middle) continue;
      west += field[c] * grid.area_m2(grid.row(c));
      west_before += before[c] * grid.area_m2(grid.row(c));
    }
    EXPECT_NEAR(west / west_before, 1.0, 1e-7);
  }
}

TEST(Diffusion, SameBitsForAnyNumberOfThreads) {
  const int threads = omp_get_max_threads();
  for (const Grid& grid : all_kinds()) {
    auto one = rough_field(grid, 8), four = one;
    omp_set_num_threads(1);
    diffuse(grid, one, 1e10, 1.0);
    omp_set_num_threads(4);
    diffuse(grid, four, 1e10, 1.0);
    EXPECT_EQ(one, four);
  }
  omp_set_num_threads(threads);
}

// Rows and columns of one kind are solved with less memory than those with marked cells.
TEST(Diffusion, MarksThatMarkNothingChangeNoBit) {
  for (const Grid& grid : {Grid::plane(37, 29, 2e3, 3e3), Grid::torus(45, 23, 2e3, 3e3)}) {
    const std::vector<std::uint8_t> none(grid.size(), 0);
    for (const double variance_m2 : {1e5, 1e7, 1e10}) {
      auto plain = rough_field(grid, 9), marked = plain;
      diffuse(grid, plain, variance_m2, 1.0, {.substeps = 3});
      diffuse(grid, marked, variance_m2, 1.0, {.excluded = none, .substeps = 3});
      EXPECT_EQ(plain, marked) << "variance " << variance_m2;
    }
  }
}

TEST(Diffusion, RefusesWhatMakesNoSense) {
  const Grid grid = Grid::plane(5, 5, 1.0, 1.0);
  std::vector<float> field(25, 1.0F), other(24, 1.0F);
  const std::vector<std::uint8_t> mask(24, 0);
  EXPECT_THROW(diffuse(grid, other, 1.0, 1.0), InputError);
  EXPECT_THROW(diffuse(grid, field, 1.0, 1.0, {.fixed = mask}), InputError);
  EXPECT_THROW(diffuse(grid, field, -1.0, 1.0), InputError);
  EXPECT_THROW(diffuse(grid, field, 1.0, std::nan("")), InputError);
  EXPECT_NO_THROW(diffuse(grid, field, 0.0, 1.0));
}

}  // namespace
}  // namespace geo
