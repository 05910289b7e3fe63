#include "geo/core/grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geo/core/error.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Grid, SphereAreasAddUpToTheSphere) {
  const Grid grid = Grid::sphere(360, 180);
  EXPECT_NEAR(grid.total_area_m2() / (4 * kPi * std::pow(6371000.0, 2)), 1.0, 1e-13);
  EXPECT_EQ(grid.area_m2(0), grid.area_m2(179)) << "north mirrors south to the last bit";
}

TEST(Grid, EllipsoidAreaMatchesWgs84) {
  const Grid grid = Grid::sphere(360, 180, {6378137.0, 1 / 298.257223563});
  EXPECT_NEAR(grid.total_area_m2() / 510065621724088.44, 1.0, 1e-12);  // EPSG constant for WGS 84
}

TEST(Grid, DistancesAreGreatCircles) {
  const Grid grid = Grid::sphere(360, 180);
  const double degree_m = 6371000.0 * kPi / 180;
  EXPECT_NEAR(grid.distances_m(90)[kNorth], degree_m, 1e-6);
  // Over the pole from 89.5 N: one degree.
  EXPECT_NEAR(grid.distances_m(179)[kNorth], degree_m, 1e-6);
  EXPECT_NEAR(grid.distances_m(0)[kSouth], degree_m, 1e-6);
  EXPECT_NEAR(grid.spacing_east_m(90), degree_m * std::cos(0.5 * kPi / 180), 1e-6);
}

TEST(Grid, EveryStepHasAWayBackOnEveryTopology) {
  for (const Grid& grid :
       {Grid::sphere(12, 6), Grid::torus(7, 5, 1.0, 2.0), Grid::plane(7, 5, 1.0, 2.0)}) {
    for (int j = 0; j < grid.ny(); ++j) {
      for (int i = 0; i < grid.nx(); ++i) {
        for (int k = 0; k < kDirections; ++k) {
          const Index to = grid.neighbour(i, j, k);
          if (to == kNoCell) continue;
          EXPECT_EQ(grid.neighbour(to, grid.back_direction(j, k)), grid.cell(i, j));
          const double there = grid.distances_m(j)[k];
          const double back = grid.distances_m(grid.row(to))[grid.back_direction(j, k)];
          EXPECT_NEAR(there / back, 1.0, 1e-12);
        }
      }
    }
  }
}

TEST(Grid, StepOverThePoleLandsHalfWayRoundOnTheSameRow) {
  const Grid grid = Grid::sphere(12, 6);
  EXPECT_EQ(grid.neighbour(2, 5, kNorth), grid.cell(8, 5));
  EXPECT_EQ(grid.neighbour(2, 5, kNorthEast), grid.cell(9, 5));
  EXPECT_EQ(grid.neighbour(2, 0, kSouth), grid.cell(8, 0));
  EXPECT_EQ(grid.neighbour(11, 3, kEast), grid.cell(0, 3));
}

TEST(Grid, RefusesWhatItCannotRepresent) {
  EXPECT_THROW((void)Grid::sphere(361, 180), ConfigurationError);
  EXPECT_THROW((void)Grid::sphere(2, 2), ConfigurationError);
  EXPECT_THROW((void)Grid::sphere(100000, 50000), ConfigurationError);
  EXPECT_THROW((void)Grid::plane(10, 10, 0.0, 1.0), ConfigurationError);
  for (const double side_m : {-1.0, 1e-300, 1e300, double{INFINITY}, double{NAN}}) {
    EXPECT_THROW((void)Grid::plane(10, 10, side_m, 1.0), ConfigurationError) << side_m;
    EXPECT_THROW((void)Grid::torus(10, 10, 1.0, side_m), ConfigurationError) << side_m;
  }
  EXPECT_THROW((void)Grid::window(10, 10, {0.0, 1e-300, 0.0, 1.0}), ConfigurationError);
  EXPECT_THROW((void)Grid::window(10, 10, {0.0, 1.0, 0.0, 1e-300}), ConfigurationError);
  EXPECT_THROW((void)Grid::plane(10, 10, std::nan(""), 1.0), ConfigurationError);
}

}  // namespace
TEST(Grid, RowsAreLimitedAsEachTakesMemoryOfItsOwn) {
  EXPECT_EQ(Grid::torus(4, 1 << 12, 1e3, 1e3).ny(), 1 << 12);
  EXPECT_THROW(Grid::torus(4, (1 << 24) + 1, 1e3, 1e3), ConfigurationError);
}

}  // namespace geo
