// Detail made like exemplars on a whole planet.
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <numbers>

#include "geo/core/error.hpp"
#include "geo/core/field.hpp"
#include "geo/kernels/exemplars/exemplar_detail.hpp"
#include "geo/kernels/numerics/smoothing.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLongest_m = 150e3;
/// So small a planet that a small grid has fine cells: 12 km.
constexpr Ellipsoid kSmall{.radius_m = 1000e3};

const ExemplarLibrary& library() {
  static const ExemplarLibrary kLibrary = grow_exemplars(kGrownForPlanets);
  return kLibrary;
}

/// One terrain and one direction of folds all over.
struct Everywhere {
  explicit Everywhere(OrogenyType type, double fold_rad = 0.0, std::array<double, 3> turn = {})
      : grid(Grid::sphere(128, 64, kSmall, turn)),
        z(grid.size()),
        orogeny(grid.size(), static_cast<std::int8_t>(type)),
        east(grid.size(), static_cast<float>(std::cos(fold_rad))),
        north(grid.size(), static_cast<float>(std::sin(fold_rad))) {
    // Steep everywhere, and the same at every longitude.
    for (Index c = 0; c < grid.size(); ++c) {
      z[c] = static_cast<float>(5e3 + 40.0 * grid.latitude_deg(grid.row(c)));
    }
  }
  [[nodiscard]] std::vector<float> detail_on(const Grid& fine, std::uint64_t seed = 3,
                                             std::span<const std::uint8_t> wanted = {}) const {
    std::vector<float> detail(fine.size());
    exemplar_detail_on_sphere(fine, wanted, grid,
                              {.elevation_m = z,
                               .orogeny_type = orogeny,
                               .orogeny_age_myr = {},
                               .fold_east = east,
                               .fold_north = north,
                               .plain_slope = 0.0},
                              library(), planetary_band(library(), kLongest_m), seed, detail);
    return detail;
  }
  Grid grid;
  std::vector<float> z;
  std::vector<std::int8_t> orogeny;
  std::vector<float> east, north;
};

Grid fine_grid(std::array<double, 3> turn = {}) { return Grid::sphere(512, 256, kSmall, turn); }

/// Mean square of what `value` gives, by area, between two latitudes.
template <class Value>
double mean_square(const Grid& grid, double from_deg, double to_deg, Value&& value) {
  double sum = 0.0, area = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    if (grid.latitude_deg(j) < from_deg || grid.latitude_deg(j) > to_deg) continue;
    for (int i = 0; i < grid.nx(); ++i) {
      sum += std::pow(value(i, j), 2.0) * grid.area_m2(j);
      area += grid.area_m2(j);
    }
  }
  return sum / area;
}

TEST(PlanetExemplars, HaveTheSameVarianceAtEveryLatitude) {
  const Grid grid = fine_grid();
  for (const OrogenyType type : {OrogenyType::andean, OrogenyType::himalayan, OrogenyType::none}) {
    const auto z = Everywhere(type, 0.7).detail_on(grid);
    const auto deviation = [&](double from_deg, double to_deg) {
      return std::sqrt(
          mean_square(grid, from_deg, to_deg, [&](int i, int j) { return z[grid.cell(i, j)]; }));
    };
    // Of unit variance but for the waves that these cells do not show.
    EXPECT_NEAR(deviation(-90.0, 90.0), 0.92, 0.1) << static_cast<int>(type);
    EXPECT_NEAR(deviation(-30.0, 30.0), deviation(60.0, 90.0), 0.2) << static_cast<int>(type);
    EXPECT_NEAR(deviation(-30.0, 30.0), deviation(-90.0, -60.0), 0.2) << static_cast<int>(type);
  }
}

TEST(PlanetExemplars, LeaveLongerWavesToThePlates) {
  const Grid grid = fine_grid();
  auto z = Everywhere(OrogenyType::himalayan, 0.7).detail_on(grid);
  smooth(grid, std::span<float>(z), 0.5 * kLongest_m);
  const double left =
      mean_square(grid, -90.0, 90.0, [&](int i, int j) { return z[grid.cell(i, j)]; });
  EXPECT_LT(std::sqrt(left), 0.15);
}

TEST(PlanetExemplars, RidgesFollowTheFolds) {
  const Grid grid = fine_grid();
  for (const OrogenyType type : {OrogenyType::andean, OrogenyType::himalayan}) {
    for (const double fold : {0.0, 0.8, 2.0}) {
      const auto z = Everywhere(type, fold).detail_on(grid);
      double xx = 0.0, xy = 0.0, yy = 0.0;
      for (int j = 0; j < grid.ny(); ++j) {
        if (std::abs(grid.latitude_deg(j)) > 60.0) continue;  // where east turns little
        for (int i = 0; i < grid.nx(); ++i) {
          const auto rise = [&](Direction to, Direction from) {
            return (z[grid.neighbour(i, j, to)] - z[grid.neighbour(i, j, from)]) /
                   (grid.distances_m(j)[to] + grid.distances_m(j)[from]);
          };
          const double x = rise(kEast, kWest), y = rise(kNorth, kSouth), area = grid.area_m2(j);
          xx += x * x * area;
          xy += x * y * area;
          yy += y * y * area;
        }
      }
      const double along = 0.5 * std::atan2(2.0 * xy, xx - yy) + 0.5 * kPi;
      EXPECT_LT(std::abs(std::remainder(along - fold, kPi)), 8.0 * kPi / 180.0) << fold;
      EXPECT_GT(std::hypot(xx - yy, 2.0 * xy) / (xx + yy), 0.1) << fold;
    }
  }
}

TEST(PlanetExemplars, HaveNoSeam) {
  // The same lattice under grids that begin at another meridian.
  constexpr int kColumns = 100;
  const Grid grid = fine_grid();
  const std::array<double, 3> turn{0.0, 0.0, 2.0 * kPi * kColumns / grid.nx()};
  const auto a = Everywhere(OrogenyType::andean, 0.7).detail_on(grid);
  const auto b = Everywhere(OrogenyType::andean, 0.7, turn).detail_on(fine_grid(turn));
  const auto off = [&](int columns) {
    return std::sqrt(mean_square(grid, -90.0, 90.0, [&](int i, int j) {
      return a[grid.cell((i + columns + grid.nx()) % grid.nx(), j)] - b[grid.cell(i, j)];
    }));
  };
  EXPECT_LT(std::min(off(kColumns), off(-kColumns)), 1e-3);
}

TEST(PlanetExemplars, AreContinuousOverThePoles) {
  const Grid grid = fine_grid();
  const Everywhere planet(OrogenyType::andean, 0.7);
  std::vector<std::uint8_t> wanted(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    const double latitude_deg = std::abs(grid.latitude_deg(grid.row(c)));
    wanted[c] = latitude_deg < 6.0 || latitude_deg > 88.0 ? 1 : 0;
  }
  // What is next to a pole is one place: many planets make a mean.
  double poles = 0.0, usual = 0.0;
  constexpr int kPlanets = 16;
  for (std::uint64_t seed = 1; seed <= kPlanets; ++seed) {
    const auto z = planet.detail_on(grid, seed, wanted);
    const auto step = [&](int i, int j, Direction to) {
      return std::pow(z[grid.neighbour(i, j, to)] - z[grid.cell(i, j)], 2.0);
    };
    for (int i = 0; i < grid.nx(); ++i) {
      poles += 0.5 * (step(i, grid.ny() - 1, kNorth) + step(i, 0, kSouth));
      usual += step(i, grid.ny() / 2, kNorth);
    }
  }
  EXPECT_NEAR(std::sqrt(poles / usual), 1.0, 0.35);
}

TEST(PlanetExemplars, AreTheSameOnEveryGridThatShowsThem) {
  const Everywhere planet(OrogenyType::himalayan, 0.7);
  const Grid coarse = Grid::sphere(256, 128, kSmall), fine = Grid::sphere(768, 384, kSmall);
  const auto a = planet.detail_on(coarse), b = planet.detail_on(fine);
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (int j = 0; j < coarse.ny(); ++j) {
    for (int i = 0; i < coarse.nx(); ++i) {
      const double x = a[coarse.cell(i, j)], y = b[fine.cell(3 * i + 1, 3 * j + 1)];
      ab += coarse.area_m2(j) * x * y;
      aa += coarse.area_m2(j) * x * x;
      bb += coarse.area_m2(j) * y * y;
    }
  }
  EXPECT_GT(ab / std::sqrt(aa * bb), 0.9);
}

TEST(PlanetExemplars, AreMadeWhereTheyAreWanted) {
  const Everywhere planet(OrogenyType::andean, 0.7);
  const Grid grid = Grid::sphere(256, 128, kSmall);
  std::vector<std::uint8_t> wanted(grid.size());
  for (Index c = 0; c < grid.size(); ++c) wanted[c] = (c / 7) % 3 == 0 ? 1 : 0;
  const auto all = planet.detail_on(grid), some = planet.detail_on(grid, 3, wanted);
  for (Index c = 0; c < grid.size(); ++c) EXPECT_EQ(some[c], wanted[c] != 0 ? all[c] : 0.0F);
}

TEST(PlanetExemplars, AreTheSameForAnyNumberOfThreads) {
  const Everywhere planet(OrogenyType::andean, 0.7);
  const Grid grid = Grid::sphere(256, 128, kSmall);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const auto one = planet.detail_on(grid);
  omp_set_num_threads(4);
  const auto four = planet.detail_on(grid);
  omp_set_num_threads(threads);
  EXPECT_EQ(one, four);
}

TEST(PlanetExemplars, OnesTooSmallOrTooCoarseDoNotHoldTheWaves) {
  const auto holds = [](int nx, int ny, double cell_m) {
    return holds_waves({.name = "e", .nx = nx, .ny = ny, .cell_m = cell_m, .elevation_m = {}},
                       kLongest_m);
  };
  EXPECT_NEAR(least_side_m(kLongest_m), 500e3, 1e-6);
  EXPECT_TRUE(holds(600, 500, 1e3));
  EXPECT_FALSE(holds(600, 490, 1e3));
  EXPECT_TRUE(holds(60, 60, 12e3));
  EXPECT_FALSE(holds(60, 60, 13e3));
  for (const Exemplar& e : library().exemplars) EXPECT_TRUE(holds_waves(e, kLongest_m));
}

TEST(PlanetExemplars, NeedAWholeSphere) {
  const Everywhere planet(OrogenyType::andean);
  const Grid torus = Grid::torus(64, 64, 1e4, 1e4);
  EXPECT_THROW((void)planet.detail_on(torus), InputError);
  EXPECT_THROW((void)planetary_band({}, kLongest_m), InputError);
}

}  // namespace
}  // namespace geo
