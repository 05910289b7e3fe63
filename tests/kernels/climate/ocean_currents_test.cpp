#include "geo/kernels/climate/ocean_currents.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "geo/core/error.hpp"

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0, kTurning = 7.2921e-5;

/// A sea between meridians, under trades and westerlies.
struct Sea {
  Grid grid = Grid::sphere(180, 90);
  OceanCurrents model;
  std::vector<double> latitude, east_pa, north_pa;
  std::vector<float> land, u, v;

  explicit Sea(int land_columns, double rotation_rad_s = kTurning,
               double friction_1_s = OceanCurrents{}.friction_1_s)
      : east_pa(grid.size()),
        north_pa(grid.size()),
        land(grid.size()),
        u(grid.size()),
        v(grid.size()) {
    model.friction_1_s = friction_1_s;
    for (int j = 0; j < grid.ny(); ++j) latitude.push_back(grid.latitude_deg(j));
    for (Index c = 0; c < grid.size(); ++c) {
      land[c] = grid.column(c) < land_columns ? 1.0F : 0.0F;
      east_pa[c] = stress_pa(latitude[grid.row(c)]);
    }
    ocean_currents(grid, model, rotation_rad_s, latitude, land, east_pa, north_pa, u, v);
  }
  static double stress_pa(double latitude_deg) {
    return -0.1 * std::cos(6.0 * latitude_deg * kRadians);
  }
  /// Depth-integrated flow to the north over a part of a row, m3 s-1.
  [[nodiscard]] double northward(int row, int from, int to) const {
    double sum = 0.0;
    for (int i = from; i < to; ++i) {
      sum += v[grid.cell(i, row)] * grid.spacing_east_m(row) * model.layer_m;
    }
    return sum;
  }
};

TEST(OceanCurrents, BalanceWindByFrictionWhereNoLandIs) {
  const Sea sea(0);
  for (int j = 2; j < 88; ++j) {
    // Friction balances the stress on the faces of a row, whose flows are averaged.
    const double around = 0.25 * Sea::stress_pa(sea.latitude[j - 1]) +
                          0.5 * Sea::stress_pa(sea.latitude[j]) +
                          0.25 * Sea::stress_pa(sea.latitude[j + 1]);
    const double expected =
        around / (sea.model.water_density_kg_m3 * sea.model.friction_1_s * sea.model.layer_m);
    ASSERT_NEAR(sea.u[sea.grid.cell(77, j)], expected, 0.03 * 0.1) << sea.latitude[j];
    ASSERT_NEAR(sea.v[sea.grid.cell(77, j)], 0.0, 1e-6);
  }
}

TEST(OceanCurrents, FollowSverdrupInTheInteriorAndReturnInTheWest) {
  const Sea sea(60, kTurning, /*friction_1_s=*/2e-7);
  for (const double at : {25.0, 35.0, -25.0}) {
    const int row = static_cast<int>((at + 90.0) / 2.0);
    const double latitude = sea.latitude[row] * kRadians, radius_m = sea.grid.figure().radius_m;
    const double beta = 2.0 * kTurning * std::cos(latitude) / radius_m;
    // curl(stress) = -d(stress cos(lat))/dlat / (a cos(lat)); H v beta = curl / rho.
    const double curl =
        -(0.6 * std::sin(6.0 * latitude) + 0.1 * std::cos(6.0 * latitude) * std::tan(latitude)) /
        radius_m;
    const double v = curl / (sea.model.water_density_kg_m3 * beta * sea.model.layer_m);
    const double interior = sea.v[sea.grid.cell(150, row)];
    EXPECT_NEAR(interior, v, 0.1 * std::abs(v)) << at;
    double fastest = 0.0;
    int where = 0;
    for (int i = 60; i < 180; ++i) {
      const double speed = std::abs(sea.v[sea.grid.cell(i, row)]);
      if (speed > fastest) {
        fastest = speed;
        where = i;
      }
    }
    EXPECT_LT(where, 64) << "the boundary current runs in the west";
    EXPECT_GT(fastest, 5.0 * std::abs(interior));
    EXPECT_NEAR(sea.northward(row, 60, 180), 0.0, 1e-3 * std::abs(sea.northward(row, 70, 180)))
        << "what goes one way in the interior returns in the boundary current";
  }
}

TEST(OceanCurrents, ReturnInTheEastOfAPlanetThatTurnsBack) {
  const Sea sea(60), back(60, -kTurning);
  const int row = 60;
  EXPECT_NEAR(back.v[back.grid.cell(179, row)], -sea.v[sea.grid.cell(60, row)],
              1e-3 * std::abs(sea.v[sea.grid.cell(60, row)]));
}

TEST(OceanCurrents, RunRoundIslandsAndNotThroughThem) {
  Sea sea(60);
  for (int j = 50; j < 58; ++j) {
    for (int i = 110; i < 116; ++i) sea.land[sea.grid.cell(i, j)] = 1.0F;
  }
  ocean_currents(sea.grid, sea.model, kTurning, sea.latitude, sea.land, sea.east_pa, sea.north_pa,
                 sea.u, sea.v);
  EXPECT_EQ(sea.v[sea.grid.cell(112, 54)], 0.0F);
  EXPECT_NEAR(sea.northward(54, 60, 180), 0.0, 1e-3 * std::abs(sea.northward(54, 70, 180)));
  EXPECT_LT(std::abs(sea.v[sea.grid.cell(118, 54)]), 0.3) << "no jet";
}

TEST(OceanCurrents, HaveNoJetsWhereMeridiansMeet) {
  Sea sea(60);
  for (Index c = 0; c < sea.grid.size(); ++c) {
    // A coast across the pole, with bays of a few columns.
    const bool bay = sea.grid.column(c) % 7 < 3;
    if (sea.latitude[sea.grid.row(c)] > (bay ? 89.5 : 86.0)) sea.land[c] = 1.0F;
    sea.east_pa[c] = 0.1;
  }
  ocean_currents(sea.grid, sea.model, kTurning, sea.latitude, sea.land, sea.east_pa, sea.north_pa,
                 sea.u, sea.v);
  double at_pole = 0.0, elsewhere = 0.0;
  for (Index c = 0; c < sea.grid.size(); ++c) {
    const double speed = std::hypot(sea.u[c], sea.v[c]);
    double& fastest = sea.latitude[sea.grid.row(c)] > 80.0 ? at_pole : elsewhere;
    fastest = std::max(fastest, speed);
  }
  EXPECT_LT(at_pole, elsewhere);
}

TEST(OceanCurrents, WindStressGoesAsTheSquareOfTheWind) {
  const WindStress stress = wind_stress({}, -6.0, 8.0);
  EXPECT_NEAR(stress.east_pa, 1.2 * 1.3e-3 * 10.0 * -6.0, 1e-12);
  EXPECT_NEAR(stress.north_pa, 1.2 * 1.3e-3 * 10.0 * 8.0, 1e-12);
}

TEST(OceanCurrents, NeedASphere) {
  const Grid torus = Grid::torus(8, 8, 1e5, 1e5);
  std::vector<double> rows(8), stress(64);
  std::vector<float> land(64), out(64);
  EXPECT_THROW(ocean_currents(torus, {}, kTurning, rows, land, stress, stress, out, out), Bug);
}

}  // namespace
}  // namespace geo
