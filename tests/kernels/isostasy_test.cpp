// Floating crust, bending plates, cooling floor and margins, against exact values.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geo/core/field.hpp"
#include "geo/core/vector3.hpp"
#include "geo/kernels/airy.hpp"
#include "geo/kernels/convergent_margins.hpp"
#include "geo/kernels/cubic_rows.hpp"
#include "geo/kernels/flexure.hpp"
#include "geo/kernels/hypsometric_curve.hpp"
#include "geo/kernels/nearest_source.hpp"
#include "geo/kernels/noise.hpp"
#include "geo/kernels/ocean_depth.hpp"
#include "geo/kernels/quantiles.hpp"
#include "geo/kernels/spherical_filter.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Airy, FreeboardOfContinentAndOcean) {
  EXPECT_NEAR(airy_freeboard_m(43e3, 2800.0, 3300.0), 6515.15, 0.01);
  EXPECT_NEAR(airy_freeboard_m(7e3, 2900.0, 3300.0), 848.48, 0.01);
}

TEST(Airy, DatumIsTheRidgeAndFactorsAreThoseOfTheColumns) {
  const AiryDatum datum;
  EXPECT_NEAR(datum.water_load_factor(), 1.4537, 1e-4);
  EXPECT_NEAR(datum.loaded(datum.dry_elevation_m(7e3, 2900.0, 0.0)), -2600.0, 1e-9);
  // Thicknesses and heights of cold continents, km.
  EXPECT_NEAR(datum.dry_elevation_m(36.4e3, 2800.0, 1.0), 750.0, 15.0);
  EXPECT_NEAR(datum.loaded(datum.dry_elevation_m(30e3, 2800.0, 1.0)), -320.0, 15.0);
  EXPECT_NEAR(datum.dry_elevation_m(70e3, 2800.0, 1.0), 5840.0, 15.0);
  // Old floor lies as deep as its share of the cold lithosphere says.
  const double share = datum.lithosphere_of_depth(5600.0);
  EXPECT_NEAR(datum.loaded(datum.dry_elevation_m(7e3, 2900.0, share)), -5600.0, 1e-6);
}

TEST(OceanDepth, FollowsItsAge) {
  for (const auto& [age, depth] : {std::pair{1.0, 2965.0},
                                   {10.0, 3754.0},
                                   {20.0, 4233.0},
                                   {40.0, 4838.0},
                                   {60.0, 5185.0},
                                   {100.0, 5498.0},
                                   {150.0, 5613.0}}) {
    EXPECT_NEAR(ocean_depth_m(age), depth, 1.0) << age << " Myr";
  }
  EXPECT_NEAR(ocean_depth_m(60.0, DepthModel::ps77), 5211.1, 0.1);
  EXPECT_NEAR(ocean_depth_m(70.0, DepthModel::ps77), 5350.3, 0.1);
  EXPECT_NEAR(ocean_heat_flow_mw_m2(25.0), 102.0, 1e-9);
  EXPECT_EQ(ocean_depth_m(-3.0), 2600.0);
}

// Turcotte et al. (1981) for Te = 25 km and a density contrast of 600 kg m-3.
TEST(Flexure, CompensationOfASphericalPlate) {
  ElasticPlate plate;
  plate.infill_kg_m3 = 2700.0;
  EXPECT_NEAR(plate.rigidity_n_m(), 9.7222e22, 1e18);
  const auto c = compensation_degrees(plate, 201);
  EXPECT_NEAR(c[2], 0.99137, 2e-4);
  EXPECT_NEAR(c[10], 0.99202, 2e-4);
  EXPECT_NEAR(c[50], 0.93132, 2e-4);
  EXPECT_NEAR(c[100], 0.49044, 2e-4);
  EXPECT_NEAR(c[200], 0.05787, 2e-4);
  EXPECT_EQ(c[0], 1.0);
}

// A line load on a sphere that is flat at its scale: V0 alpha^3 / 8 D in the middle, a bulge of
// exp(-pi) of it at pi alpha.
TEST(Flexure, LineLoadBendsThePlateAsOnAPlane) {
  const Grid grid = Grid::sphere(1024, 512);
  ElasticPlate plate;
  plate.infill_kg_m3 = 3300.0 - 2270.0;
  plate.thickness_m = 60e3;
  plate.mean_density_kg_m3 = 1e9;  // no self-gravitation, as on a plane
  const double restoring = 2270.0 * plate.gravity_m_s2;
  const double alpha_m = std::pow(4.0 * plate.rigidity_n_m() / restoring, 0.25);
  // The load of one row of cells on the equator, as the deflection it has in local balance.
  constexpr double kLoad_n_m = 1e12;
  std::vector<float> deflection(grid.size(), 0.0F);
  const double width_m = grid.spacing_north_m(256);
  for (int i = 0; i < grid.nx(); ++i) {
    for (const int j : {255, 256}) {
      deflection[grid.cell(i, j)] = static_cast<float>(0.5 * kLoad_n_m / width_m / restoring);
    }
  }
  flex(grid, deflection, plate);
  const double middle = kLoad_n_m * std::pow(alpha_m, 3) / (8.0 * plate.rigidity_n_m());
  EXPECT_NEAR(deflection[grid.cell(0, 256)], middle, 0.05 * middle);
  double bulge = 0.0;
  for (int j = 256; j < 330; ++j) bulge = std::min<double>(bulge, deflection[grid.cell(5, j)]);
  EXPECT_NEAR(bulge, -std::exp(-kPi) * middle, 0.012 * middle);
}

TEST(SphericalFilter, ScalesEachHarmonicByItsGain) {
  const Grid grid = Grid::sphere(128, 64);
  std::vector<float> field(grid.size()), expected(grid.size());
  for (int j = 0; j < grid.ny(); ++j) {
    const double s = std::sin(grid.latitude_deg(j) * kPi / 180.0), c = std::sqrt(1.0 - s * s);
    for (int i = 0; i < grid.nx(); ++i) {
      const double lon = grid.longitude_deg(i) * kPi / 180.0;
      const double y32 = c * c * s * std::cos(2.0 * lon);              // degree 3
      const double y10 = s, y77 = std::pow(c, 7) * std::sin(7 * lon);  // degrees 1 and 7
      field[grid.cell(i, j)] = static_cast<float>(2.0 + y10 + 5.0 * y32 + 3.0 * y77);
      expected[grid.cell(i, j)] = static_cast<float>(1.0 + 0.5 * y10 + 10.0 * y32);
    }
  }
  filter_degrees(grid, field, std::vector<double>{0.5, 0.5, 9.0, 2.0, 1.0, 1.0, 1.0, 0.0});
  for (Index cell = 0; cell < grid.size(); ++cell) ASSERT_NEAR(field[cell], expected[cell], 2e-5);
}

TEST(CubicRows, KeepEqualGridsAndSmoothFieldsAcrossPolesAndDateLine) {
  const Grid coarse = Grid::sphere(64, 32), fine = Grid::sphere(256, 128);
  const auto height = [](const std::array<double, 3>& p) { return p[0] + 2.0 * p[1] - p[2]; };
  std::vector<float> field(coarse.size()), row(fine.nx()), scratch;
  for (Index cell = 0; cell < coarse.size(); ++cell) {
    field[cell] =
        static_cast<float>(height(coarse.unit_vector(coarse.column(cell), coarse.row(cell))));
  }
  const CubicRows rows(coarse, fine), same(coarse, coarse);
  for (int j = 0; j < fine.ny(); ++j) {
    rows.read(field, j, row, scratch);
    for (int i = 0; i < fine.nx(); ++i) {
      ASSERT_NEAR(row[i], height(fine.unit_vector(i, j)), 2e-3) << i << " " << j;
    }
  }
  std::vector<float> back(coarse.nx());
  same.read(field, 7, back, scratch);
  for (int i = 0; i < coarse.nx(); ++i) EXPECT_EQ(back[i], field[coarse.cell(i, 7)]);
}

TEST(NearestSource, IsTheNearestByGreatCircle) {
  const Grid grid = Grid::sphere(180, 90);
  std::vector<std::array<float, 3>> points;
  std::vector<std::int32_t> nearest(grid.size(), -1);
  for (const Index cell : {0, 91, 8000, 8123, 12345, 16100, 16199}) {
    const auto p = grid.unit_vector(grid.column(cell), grid.row(cell));
    nearest[cell] = static_cast<std::int32_t>(points.size());
    points.push_back(
        {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
  }
  nearest_sources(grid, points, std::vector<float>(points.size(), 0.0F), nearest);
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const auto p = grid.unit_vector(grid.column(cell), grid.row(cell));
    const std::array<float, 3> at{static_cast<float>(p[0]), static_cast<float>(p[1]),
                                  static_cast<float>(p[2])};
    double least = 1e30;
    for (const auto& point : points) least = std::min(least, distance_m(at, point, 6371e3));
    ASSERT_NEAR(distance_m(at, points[nearest[cell]], 6371e3), least, 30e3);
  }
}

/// A convergent boundary along the equator between an old ocean in the south and a continent.
struct EquatorialTrench {
  Grid grid = Grid::sphere(512, 256);
  std::vector<std::int16_t> plate;
  std::vector<std::int8_t> type;
  std::vector<float> strength, fraction, age, speed;
  EquatorialTrench() {
    for (Index cell = 0; cell < grid.size(); ++cell) {
      const bool north = grid.row(cell) >= 128;
      const bool near = grid.row(cell) == 127 || grid.row(cell) == 128;
      plate.push_back(north ? 1 : 0);
      type.push_back(near ? 1 : 0);
      strength.push_back(near ? 0.8F : 0.0F);
      fraction.push_back(north ? 1.0F : 0.0F);
      age.push_back(80.0F);
      speed.push_back(30.0F);
    }
  }
};

TEST(ConvergentMargins, TheOceanGoesDownAndDistancesAreTrueOnes) {
  const EquatorialTrench t;
  const auto margins =
      convergent_margins(t.grid, t.plate, t.type, t.strength, t.fraction, t.age, t.speed);
  for (Index cell = 0; cell < t.grid.size(); ++cell) {
    const double latitude_deg = t.grid.latitude_deg(t.grid.row(cell));
    ASSERT_EQ(margins.kind[cell], Convergence::ocean_continent);
    ASSERT_FLOAT_EQ(margins.strength[cell], 0.8F);
    const double expected_km = 6371.0 * kPi / 180.0 * latitude_deg;
    const double half_cell_km = 0.51e-3 * t.grid.spacing_north_m(128);
    ASSERT_NEAR(margins.across_km[cell], expected_km, half_cell_km) << latitude_deg;
  }
}

TEST(ConvergentMargins, OfTwoOceansTheOlderGoesDown) {
  EquatorialTrench t;
  for (Index cell = 0; cell < t.grid.size(); ++cell) {
    t.fraction[cell] = 0.0F;
    t.age[cell] = t.plate[cell] == 1 ? 120.0F : 30.0F;
  }
  const auto margins =
      convergent_margins(t.grid, t.plate, t.type, t.strength, t.fraction, t.age, t.speed);
  EXPECT_EQ(margins.kind[0], Convergence::oceans);
  EXPECT_LT(margins.across_km[t.grid.cell(7, 200)], 0.0F);
  EXPECT_GT(margins.across_km[t.grid.cell(7, 60)], 0.0F);
}

TEST(ConvergentMargins, CrossSectionsHaveTheirParts) {
  EXPECT_LT(trench_m(-5.0, 1.0), -3000.0);
  EXPECT_GT(trench_m(-170.0, 1.0), 250.0);  // outer rise
  EXPECT_NEAR(trench_m(400.0, 1.0), 0.0, 1.0);
  EXPECT_EQ(andean_thickening(-100.0, 1.0), 0.0);
  EXPECT_NEAR(andean_thickening(300.0, 1.0), 1.0, 1e-9);
  EXPECT_GT(himalayan_thickening(600.0, 1.0), andean_thickening(900.0, 1.0));
  EXPECT_GT(island_arc(165.0, 0.5), island_arc(60.0, 0.5));
}

TEST(Deformation, DecaysExponentiallyInEveryDirection) {
  const Grid grid = Grid::sphere(512, 256);
  std::vector<std::int8_t> type(grid.size(), 0);
  std::vector<float> strength(grid.size(), 0.0F);
  const Index source = grid.cell(100, 200);
  type[source] = 2;
  strength[source] = 0.7F;
  const auto deformation = propagated_deformation(grid, type, strength, 2, 400.0);
  const Vector3 at = grid.unit_vector(100, 200);
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const Vector3 here = grid.unit_vector(grid.column(cell), grid.row(cell));
    const double distance_km = 6371.0 * angle_between(at, here);
    ASSERT_NEAR(deformation[cell], 0.7 * std::exp(-distance_km / 400.0), 1e-4);
  }
}

TEST(Hypsometry, PowerLawBringsTheMedianOfLandToItsAim) {
  const Grid grid = Grid::sphere(256, 128);
  const Noise noise(5, "heights");
  std::vector<float> height(grid.size());
  std::vector<std::uint8_t> land(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const auto p = grid.unit_vector(grid.column(cell), grid.row(cell));
    height[cell] = 9000.0F * noise.fbm(p, 2.0, 6) - 200.0F;
    land[cell] = height[cell] > 0.0F;
  }
  const auto before = height;
  const double alpha = bend_hypsometry(grid, height, 400.0, 25e3);
  EXPECT_GT(alpha, 1.0);
  EXPECT_LE(alpha, 5.0);
  EXPECT_NEAR(quantile(grid, height, 0.5, land), 400.0, 8.0);
  for (Index cell = 0; cell < grid.size(); ++cell) {
    if (land[cell] != 0) {
      ASSERT_GT(height[cell], 0.0F);
    } else {
      ASSERT_EQ(height[cell], before[cell]);
    }
  }
  // Without smoothing it is the formula itself.
  height = before;
  const double most = quantile(grid, before, 1.0, land), median = quantile(grid, before, 0.5, land);
  const double exact = std::log(400.0 / most) / std::log(median / most);
  EXPECT_NEAR(bend_hypsometry(grid, height, 400.0, 0.0), exact, 1e-3);
  for (Index cell = 0; cell < grid.size(); ++cell) {
    if (land[cell] == 0 || before[cell] < 50.0F) continue;
    ASSERT_NEAR(height[cell], most * std::pow(before[cell] / most, exact), 0.2);
  }
}

}  // namespace
}  // namespace geo
