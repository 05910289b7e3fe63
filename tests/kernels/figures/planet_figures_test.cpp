// What a scorecard measures, on planets whose figures are known beforehand.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/random.hpp"
#include "geo/kernels/figures/drainage_figures.hpp"
#include "geo/kernels/figures/hypsometry_figures.hpp"
#include "geo/kernels/figures/plate_figures.hpp"
#include "geo/kernels/numerics/regression.hpp"
#include "geo/kernels/numerics/spectrum.hpp"
#include "geo/kernels/numerics/zonal_means.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

template <class Value>
auto field_of(const Grid& grid, const Value& value) {
  std::vector<decltype(value(std::array<double, 3>{}))> field(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    field[c] = value(grid.unit_vector(grid.column(c), grid.row(c)));
  }
  return field;
}

TEST(HypsometryFigures, OfATwoLevelPlanetAreItsLevels) {
  // Land north of 30 degrees: (1 - sin 30) / 2, a quarter of the sphere.
  const Grid grid = Grid::sphere(360, 180);
  const auto z = field_of(grid, [](auto r) { return r[2] > 0.5 ? 700.0F : -3900.0F; });
  const auto figures = measure_hypsometry(grid, z);
  EXPECT_NEAR(figures.land_fraction, 0.25, 1e-12);
  EXPECT_NEAR(figures.land_mean_m, 700.0, 1e-9);
  EXPECT_NEAR(figures.ocean_mean_m, -3900.0, 1e-9);
  EXPECT_NEAR(figures.water_volume_m3 / (0.75 * 3900.0 * grid.total_area_m2()), 1.0, 1e-12);
  const auto modes = elevation_modes(grid, z);
  EXPECT_NEAR(modes.land_m, 700.0, 25.0);
  EXPECT_NEAR(modes.ocean_m, -3900.0, 12.6);
  EXPECT_GT(modes.antimode_m, -3900.0 + 4 * 150.0);  // where the smoothed density has ended
  EXPECT_LT(modes.antimode_m, 0.0);
}

TEST(HypsometryFigures, WithoutLandOrSeaHaveNoMeanThere) {
  const Grid grid = Grid::sphere(20, 10);
  const std::vector<float> land(grid.size(), 10.0F), sea(grid.size(), -10.0F);
  EXPECT_TRUE(std::isnan(measure_hypsometry(grid, land).ocean_mean_m));
  EXPECT_TRUE(std::isnan(measure_hypsometry(grid, sea).land_mean_m));
  EXPECT_TRUE(std::isnan(elevation_modes(grid, land).ocean_m));
  EXPECT_TRUE(std::isnan(elevation_modes(grid, sea).land_m));
  EXPECT_THROW(measure_hypsometry(grid, std::vector<float>(3)), InputError);
}

TEST(HypsometryFigures, SharesBetweenLevelsAreZonesOfTheSphere) {
  const Grid grid = Grid::sphere(180, 180);
  const auto latitude =
      field_of(grid, [](auto r) { return static_cast<float>(std::asin(r[2]) * 180.0 / kPi); });
  const auto shares = shares_between(grid, latitude, std::array{-30.0, 0.0, 60.0});
  ASSERT_EQ(shares.size(), 4U);
  EXPECT_NEAR(shares[0], 0.25, 1e-12);
  EXPECT_NEAR(shares[1], 0.25, 1e-12);
  EXPECT_NEAR(shares[2], 0.5 * std::sin(kPi / 3.0), 1e-12);
  EXPECT_NEAR(shares[3], 0.5 * (1.0 - std::sin(kPi / 3.0)), 1e-12);
}

TEST(Spectrum, OfOneHarmonicIsItsMeanSquareAtItsDegree) {
  const Grid grid = Grid::sphere(240, 120);
  struct Case {
    int degree;
    double (*harmonic)(std::array<double, 3>);
  };
  const Case cases[] = {{0, [](std::array<double, 3>) { return 2.0; }},
                        {1, [](std::array<double, 3> r) { return 3.0 * r[0]; }},
                        {2, [](std::array<double, 3> r) { return r[2] * r[2] - 1.0 / 3.0; }},
                        {3, [](std::array<double, 3> r) { return r[0] * r[1] * r[2]; }},
                        {4, [](std::array<double, 3> r) {
                           return std::pow(r[0], 4) - 6.0 * r[0] * r[0] * r[1] * r[1] +
                                  std::pow(r[1], 4);
                         }}};
  for (const auto& [degree, harmonic] : cases) {
    const auto field =
        field_of(grid, [&, h = harmonic](auto r) { return static_cast<float>(h(r)); });
    double mean_square = 0.0;
    for (Index c = 0; c < grid.size(); ++c) {
      mean_square += grid.area_m2(grid.row(c)) * field[c] * field[c] / grid.total_area_m2();
    }
    const auto power = harmonic_power(grid, field, 20);
    for (int l = 0; l <= 20; ++l) {
      EXPECT_NEAR(power[l] / mean_square, l == degree ? 1.0 : 0.0, 1e-3) << degree << " at " << l;
    }
  }
}

TEST(Spectrum, DoesNotDependOnWhereThePoleIs) {
  const Grid grid = Grid::sphere(240, 120);
  const auto bumps = [](double x, double y, double z) {
    return static_cast<float>(std::exp(3.0 * x) + std::sin(9.0 * y) * z);
  };
  const auto one =
      harmonic_power(grid, field_of(grid, [&](auto r) { return bumps(r[0], r[1], r[2]); }), 24);
  const auto other =
      harmonic_power(grid, field_of(grid, [&](auto r) { return bumps(r[2], r[0], r[1]); }), 24);
  const double total = std::accumulate(one.begin(), one.end(), 0.0);
  for (int l = 0; l <= 24; ++l) EXPECT_NEAR(other[l], one[l], 1e-3 * total) << l;
}

TEST(Spectrum, SlopeOfAPowerLawIsItsExponent) {
  std::vector<double> power(129);
  for (int l = 1; l <= 128; ++l) power[l] = 5.0 * std::pow(l, -1.9);
  EXPECT_NEAR(spectral_slope(power, 3, 96), -1.9, 1e-12);
  EXPECT_THROW(harmonic_power(Grid::sphere(20, 10), std::vector<float>(200), 6), InputError);
  EXPECT_THROW(harmonic_power(Grid::plane(20, 20, 1, 1), std::vector<float>(400), 3), InputError);
}

TEST(Regression, FindsTheSlopeOfALineWhateverItsOffset) {
  const std::vector<double> x{1e6, 1e6 + 1, 1e6 + 5}, y{7.0, 9.5, 19.5};
  EXPECT_NEAR(regression_slope(x, y), 2.5, 1e-9);
  EXPECT_TRUE(std::isnan(regression_slope(std::vector{2.0, 2.0}, std::vector{1.0, 3.0})));
  const Grid grid = Grid::sphere(40, 20);
  const auto a = field_of(grid, [](auto r) { return static_cast<float>(r[2]); });
  const auto b = field_of(grid, [](auto r) { return static_cast<float>(4.0 - 3.0 * r[2]); });
  EXPECT_NEAR(area_regression_slope(grid, a, b), -3.0, 1e-6);
}

TEST(ZonalMeans, OfAFieldOfLatitudeAreItsMeans) {
  const Grid grid = Grid::sphere(36, 180);
  const auto sine = field_of(grid, [](auto r) { return static_cast<float>(r[2]); });
  const auto means = zonal_means(grid, sine, 18);
  for (int band = 0; band < 18; ++band) {
    // The mean of the sine over a zone by area lies half-way between those of its edges.
    const double low = std::sin((10 * band - 90) * kPi / 180.0);
    const double high = std::sin((10 * band - 80) * kPi / 180.0);
    EXPECT_NEAR(means[band], 0.5 * (low + high), 1e-4) << band;
  }
  auto shifted = means;
  for (double& mean : shifted) mean += 2.0;
  EXPECT_NEAR(zonal_rms(means, shifted), 2.0, 1e-12);
}

/// A planet of two plates parted by the plane through its centre with that normal; the one the
/// normal points into turns with `spin` (mm/yr), the other rests.
struct TwoPlates {
  TwoPlates(const Grid& grid, std::array<double, 3> normal, std::array<double, 3> spin) {
    for (Index c = 0; c < grid.size(); ++c) {
      const auto r = grid.unit_vector(grid.column(c), grid.row(c));
      const double side = normal[0] * r[0] + normal[1] * r[1] + normal[2] * r[2];
      plate.push_back(side > 0.0 ? 1 : 0);
      const double across = std::hypot(r[0], r[1]);
      const std::array v{spin[1] * r[2] - spin[2] * r[1], spin[2] * r[0] - spin[0] * r[2],
                         spin[0] * r[1] - spin[1] * r[0]};
      const double u = (-v[0] * r[1] + v[1] * r[0]) / across, w = v[2] / across;
      east.push_back(side > 0.0 ? static_cast<float>(u) : 0.0F);
      north.push_back(side > 0.0 ? static_cast<float>(w) : 0.0F);
    }
    continent.assign(grid.size(), 0.0F);
  }
  [[nodiscard]] PlateFields fields() const { return {plate, continent, east, north}; }

  std::vector<std::int16_t> plate;
  std::vector<float> continent, east, north;
};

constexpr int kRidge = static_cast<int>(BoundaryKind::ocean_ridge);
constexpr int kRift = static_cast<int>(BoundaryKind::continental_rift);
constexpr int kOceanTransform = static_cast<int>(BoundaryKind::ocean_transform);
constexpr int kContinentalTransform = static_cast<int>(BoundaryKind::continental_transform);
constexpr int kSubduction = static_cast<int>(BoundaryKind::subduction);
constexpr int kCollision = static_cast<int>(BoundaryKind::collision);

TEST(PlateFigures, AGreatCircleHasItsLengthInWhateverDirection) {
  const RandomStream random(7, "plate_figures_test");
  for (const int nx : {360, 720, 1440}) {
    const Grid grid = Grid::sphere(nx, nx / 2);
    const double length_m = 2.0 * kPi * grid.figure().radius_m;
    for (int turn = 0; turn < 6; ++turn) {
      const auto normal = turn == 0   ? std::array{0.0, 0.0, 1.0}
                          : turn == 1 ? std::array{1.0, 0.0, 0.0}
                                      : random.direction(turn);
      const TwoPlates resting(grid, normal, {0.0, 0.0, 0.0});
      const auto figures = measure_boundaries(grid, resting.fields());
      EXPECT_NEAR(figures.total_m() / length_m, 1.0, 0.025) << "turn " << turn << " nx " << nx;
      EXPECT_DOUBLE_EQ(figures.at_rest_m, figures.total_m());
      // Turning about its own normal, a half slides past the other everywhere: so it is seen but
      // where the steps of the raster turn a neighbourhood aside.
      const TwoPlates sliding(grid, normal, {normal[0], normal[1], normal[2]});
      const auto slid = measure_boundaries(grid, sliding.fields());
      EXPECT_GT(slid.length_m[kOceanTransform] / figures.total_m(), 0.95)
          << "turn " << turn << " nx " << nx;
    }
  }
}

TEST(PlateFigures, OpeningIsTheRelativeVelocityAcross) {
  // The northern half turns about the x axis: across the equator its velocity is -w sin(longitude),
  // so where it parts is as long as where it closes. Half a circle has a mean sine of 2 / pi.
  const Grid grid = Grid::sphere(720, 360);
  const TwoPlates plates(grid, {0.0, 0.0, 1.0}, {-50.0, 0.0, 0.0});
  const auto figures = measure_boundaries(grid, plates.fields());
  const double half_m = kPi * grid.figure().radius_m;
  EXPECT_NEAR(figures.length_m[kRidge] / half_m, 1.0, 0.02);
  EXPECT_NEAR(figures.length_m[kSubduction] / half_m, 1.0, 0.02);
  EXPECT_NEAR(figures.opening_mm_yr[kRidge], 50.0 * 2.0 / kPi, 0.7);
  EXPECT_NEAR(figures.opening_mm_yr[kSubduction], -figures.opening_mm_yr[kRidge], 0.7);
}

TEST(PlateFigures, KindFollowsTheDirectionOfTheMotionHoweverSlow) {
  // About an axis half-way between x and z the velocity is w sin(longitude) across the equator and
  // w along it, w the speed over the square root of 2: plates slide where |sin(longitude)| is less
  // than the tangent of 25 degrees.
  const Grid grid = Grid::sphere(720, 360);
  const double length_m = 2.0 * kPi * grid.figure().radius_m;
  const double share = 2.0 * std::asin(std::tan(25.0 * kPi / 180.0)) / kPi;
  for (const double speed : {100.0, 1.0}) {
    const TwoPlates plates(grid, {0.0, 0.0, 1.0}, {speed, 0.0, speed});
    const auto figures = measure_boundaries(grid, plates.fields());
    EXPECT_NEAR(figures.length_m[kOceanTransform] / length_m, share, 0.01) << speed;
    EXPECT_NEAR(figures.length_m[kRidge] / length_m, 0.5 * (1.0 - share), 0.01) << speed;
    EXPECT_NEAR(figures.length_m[kSubduction] / length_m, 0.5 * (1.0 - share), 0.01) << speed;
    EXPECT_DOUBLE_EQ(figures.at_rest_m, 0.0);
  }
}

TEST(PlateFigures, ContinentsOnBothSidesMakeCollisionsRiftsAndTransforms) {
  const Grid grid = Grid::sphere(360, 180);
  TwoPlates plates(grid, {0.0, 0.0, 1.0}, {50.0, 0.0, 50.0});
  const auto has = [&](const std::vector<int>& kinds) {
    const auto figures = measure_boundaries(grid, plates.fields());
    for (int kind = 0; kind < kBoundaryKinds; ++kind) {
      const bool expected = std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
      if ((figures.length_m[kind] > 0.0) != expected) return false;
    }
    return true;
  };
  EXPECT_TRUE(has({kRidge, kOceanTransform, kSubduction}));
  for (Index c = 0; c < grid.size(); ++c) plates.continent[c] = plates.plate[c] == 1 ? 0.9F : 0.0F;
  EXPECT_TRUE(has({kRidge, kOceanTransform, kSubduction}));
  // A thin shore beyond: rifts and transforms run through continental crust, but an ocean closes.
  for (Index c = 0; c < grid.size(); ++c) plates.continent[c] = plates.plate[c] == 1 ? 0.9F : 0.3F;
  EXPECT_TRUE(has({kRift, kContinentalTransform, kSubduction}));
  plates.continent.assign(grid.size(), 1.0F);
  EXPECT_TRUE(has({kRift, kContinentalTransform, kCollision}));
}

TEST(PlateFigures, SharesOfPlatesAreTheirAreas) {
  const Grid grid = Grid::sphere(360, 180);
  const auto plate = field_of(grid, [](auto r) -> std::int16_t { return r[2] > 0.5 ? 4 : 9; });
  const auto shares = plate_shares(grid, plate);
  ASSERT_EQ(shares.size(), 2U);
  EXPECT_NEAR(shares[0], 0.75, 1e-12);
  EXPECT_NEAR(shares[1], 0.25, 1e-12);
}

TEST(PlateFigures, ARigidlyTurningPlanetRestsWithoutNetRotation) {
  const Grid grid = Grid::sphere(360, 180);
  TwoPlates all(grid, {0.0, 0.0, 1.0}, {20.0, -30.0, 10.0});
  TwoPlates rest(grid, {0.0, 0.0, -1.0}, {20.0, -30.0, 10.0});
  for (Index c = 0; c < grid.size(); ++c) {
    all.east[c] += rest.east[c];
    all.north[c] += rest.north[c];
  }
  EXPECT_LT(speed_without_net_rotation(grid, all.east, all.north), 0.01);
  // Halves that turn against each other about their common axis keep their speed: w^2 2 / 3.
  const TwoPlates north(grid, {0.0, 0.0, 1.0}, {0.0, 0.0, 40.0});
  const TwoPlates south(grid, {0.0, 0.0, -1.0}, {0.0, 0.0, -40.0});
  std::vector<float> east(grid.size()), zero(grid.size(), 0.0F);
  for (Index c = 0; c < grid.size(); ++c) east[c] = north.east[c] + south.east[c];
  EXPECT_NEAR(speed_without_net_rotation(grid, east, zero), 40.0 * std::sqrt(2.0 / 3.0), 0.01);
}

/// Parallel valleys of given lengths along a row, each ending in the sea.
TEST(DrainageFigures, LongestWayAndBasinsAreThoseOfAStraightRiver) {
  const Grid grid = Grid::plane(12, 3, 1000.0, 2000.0);
  std::vector<float> z(grid.size(), 5.0F);
  std::vector<std::int32_t> receiver(grid.size()), basin(grid.size());
  std::vector<double> area(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    const int column = grid.column(c), row = grid.row(c);
    const bool sea = column == 11, pit = row == 2 && column == 4;
    if (sea) z[c] = -5.0F;
    receiver[c] = sea || pit ? c : row == 2 && column > 4 && column < 8 ? c - 1 : c + 1;
    basin[c] = sea ? 0 : row == 2 ? (column < 8 ? 3 : 4) : row + 1;
    area[c] = 2e6 * (column + 1);
  }
  const DrainedPlanet drainage{z, receiver, area};
  const auto length = flow_length_m(grid, drainage);
  EXPECT_FLOAT_EQ(length[grid.cell(10, 0)], 10000.0F);
  EXPECT_FLOAT_EQ(length[grid.cell(4, 2)], 4000.0F);
  const auto basins = measure_basins(grid, drainage, basin);
  ASSERT_EQ(basins.area_m2.size(), 5U);
  EXPECT_NEAR(basins.area_m2[1], 11 * 2e6, 1.0);
  EXPECT_NEAR(basins.area_m2[3], 8 * 2e6, 1.0);
  EXPECT_EQ(basins.is_endorheic, (std::vector<std::uint8_t>{0, 0, 0, 1, 0}));
  std::vector<float> rate(grid.size());
  for (Index c = 0; c < grid.size(); ++c) rate[c] = static_cast<float>(grid.column(c));
  EXPECT_NEAR(basin_means(grid, z, basin, rate)[1], 5.0, 1e-9);
  EXPECT_NEAR(basin_means(grid, z, basin, rate)[4], 9.0, 1e-9);
  receiver[0] = 30;
  EXPECT_THROW(flow_length_m(grid, drainage), Bug);
}

TEST(DrainageFigures, HackOfRiversOfOneWidthIsOneAndOfSimilarBasinsAHalf) {
  // Straight rivers of n cells: their true areas grow as n, those of similar basins as n^2.
  const Grid grid = Grid::plane(64, 40, 1000.0, 1000.0);
  std::vector<float> z(grid.size(), 5.0F);
  std::vector<std::int32_t> receiver(grid.size());
  std::vector<double> narrow(grid.size(), 0.0), similar(grid.size(), 0.0);
  for (Index c = 0; c < grid.size(); ++c) {
    const int column = grid.column(c), row = grid.row(c), n = column - row;
    const bool sea = column == 63;
    if (sea) z[c] = -5.0F;
    receiver[c] = sea || n < 0 ? c : c + 1;
    narrow[c] = std::max(n, 0) * 1e6;
    similar[c] = std::pow(std::max(n, 0), 2) * 1e6;
  }
  EXPECT_NEAR(hack_exponent(grid, {z, receiver, narrow}, 1e6), 1.0, 1e-6);
  EXPECT_NEAR(hack_exponent(grid, {z, receiver, similar}, 1e6), 0.5, 1e-6);
  EXPECT_TRUE(std::isnan(hack_exponent(grid, {z, receiver, narrow}, 1e12)));
}

TEST(DrainageFigures, HortonRatiosOfAFractalTreeAreItsOwn) {
  // Columns of streams on a plane, one per row, placed so that each order has 3 times fewer streams
  // that are 2 times longer and drain 4 times as much.
  constexpr int kBrooks = 40;  // that end at the shore on their own
  const Grid grid = Grid::plane(80, 200 + kBrooks, 1000.0, 1000.0);
  std::vector<float> z(grid.size(), 5.0F);
  std::vector<std::int32_t> receiver(grid.size());
  std::vector<std::int8_t> order(grid.size(), 0);
  std::vector<double> area(grid.size(), 1e6);
  for (Index c = 0; c < grid.size(); ++c) receiver[c] = grid.column(c) < 79 ? c + 1 : c;
  int row = 0;
  for (int w = 1; w <= 4; ++w) {
    for (int stream = 0; stream < 5 * static_cast<int>(std::pow(3, 4 - w)); ++stream, ++row) {
      for (int k = 0; k < 5 * (1 << (w - 1)); ++k) {
        order[grid.cell(k, row)] = static_cast<std::int8_t>(w);
        area[grid.cell(k, row)] = 1e6 * std::pow(4.0, w);
      }
    }
  }
  ASSERT_LE(row, grid.ny() - kBrooks);
  for (int j = 0; j < row; ++j) area[grid.cell(79, j)] = 1e9;
  for (; row < grid.ny(); ++row) order[grid.cell(0, row)] = 1;
  EXPECT_GT(horton_ratios(grid, {z, receiver, area}, order, 0.0).bifurcation, 3.1);
  const auto ratios = horton_ratios(grid, {z, receiver, area}, order, 1e8);
  EXPECT_NEAR(ratios.bifurcation, 3.0, 1e-9);
  EXPECT_NEAR(ratios.length, 2.0, 1e-9);
  EXPECT_NEAR(ratios.area, 4.0, 1e-9);
}

}  // namespace
}  // namespace geo
