// The elastic shell against published and closed solutions.
#include "geo/kernels/crust/flexure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geo/core/error.hpp"
#include "geo/kernels/numerics/spherical_filter.hpp"
#include "support/terrain.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

/// P_l(x) by the recursion of Bonnet.
double legendre(int degree, double x) {
  double before = 1.0, now = x;
  if (degree == 0) return 1.0;
  for (int l = 1; l < degree; ++l) {
    const double next = ((2.0 * l + 1.0) * x * now - l * before) / (l + 1.0);
    before = now;
    now = next;
  }
  return now;
}

/// P_l of the angle from an axis that lies along neither a pole nor the equator.
std::vector<float> tilted_harmonic(const Grid& grid, int degree) {
  std::vector<float> field(grid.size());
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      const auto p = grid.unit_vector(i, j);
      field[grid.cell(i, j)] =
          static_cast<float>(legendre(degree, (2.0 * p[0] - 3.0 * p[1] + 6.0 * p[2]) / 7.0));
    }
  }
  return field;
}

double greatest_difference(const std::vector<float>& a, const std::vector<float>& b, double scale) {
  double greatest = 0.0;
  for (std::size_t c = 0; c < a.size(); ++c) {
    greatest = std::max(greatest, std::abs(a[c] - scale * b[c]));
  }
  return greatest;
}

TEST(Flexure, RigidityOfTheReferencePlate) {
  EXPECT_NEAR(ElasticPlate{}.rigidity_n_m(), 9.7222e22, 1e18);
}

TEST(Flexure, CompensationOfTheShellMatchesTurcotte) {
  // Te 25 km, mantle 600 kg m-3 denser than what fills the hollow.
  const auto share = compensation_degrees({.infill_kg_m3 = 2700.0}, 201);
  EXPECT_NEAR(share[2], 0.99137, 1e-5);
  EXPECT_NEAR(share[10], 0.99202, 1e-5);
  EXPECT_NEAR(share[50], 0.93132, 1e-5);
  EXPECT_NEAR(share[100], 0.49044, 1e-5);
  EXPECT_NEAR(share[200], 0.05787, 1e-5);
}

TEST(Flexure, HarmonicsOfAnyDegreeAreScaledByTheirShareAlone) {
  const Grid grid = Grid::sphere(1024, 512);
  const ElasticPlate plate;
  const auto share = compensation_degrees(plate, 341);
  for (const int degree : {2, 10, 50, 100, 200}) {
    const auto load = tilted_harmonic(grid, degree);
    auto bent = load;
    flex(grid, bent, plate);
    // Single precision of values about 1, and what quadrature leaves beyond degree 312.
    EXPECT_LT(greatest_difference(bent, load, share[degree]), 2e-5) << "degree " << degree;
  }
}

TEST(Flexure, PointLoadOnALargeShellIsThatOfAPlane) {
  // Green's function as a sum over degrees. Membrane stress holds E Te / (R^2 drho g) of the load:
  // two parts in a thousand on an Earth, nothing on a planet ten times as wide.
  ElasticPlate plate{.infill_kg_m3 = 1030.0, .radius_m = 6.371e7};
  plate.mean_density_kg_m3 = 1e9;  // no self-gravitation
  const int degrees = 60'000;
  const auto share = compensation_degrees(plate, degrees);
  const double restoring = (plate.mantle_kg_m3 - plate.infill_kg_m3) * plate.gravity_m_s2;
  const double load_n = 1e18;
  const double scale = load_n / (4.0 * kPi * plate.radius_m * plate.radius_m * restoring);
  const auto deflection = [&](double distance_m) {
    const double x = std::cos(distance_m / plate.radius_m);
    double before = 1.0, now = x, sum = share[0] + 3.0 * share[1] * x;
    for (int l = 1; l + 1 < degrees; ++l) {
      const double next = ((2.0 * l + 1.0) * x * now - l * before) / (l + 1.0);
      before = now;
      now = next;
      sum += (2.0 * l + 3.0) * share[l + 1] * now;
    }
    return scale * sum;
  };
  EXPECT_NEAR(deflection(0.0), 2686.46, 0.001 * 2686.46);
  const double beta = std::pow(plate.rigidity_n_m() / restoring, 0.25);
  EXPECT_GT(deflection(3.90 * beta), 0.0);
  EXPECT_LT(deflection(3.93 * beta), 0.0);
}

TEST(Flexure, LineLoadBendsAsAPlateDoes) {
  // A load along the equator: zero at 3 pi / 4 alpha (152 km), bulge of -exp(-pi) at pi alpha.
  const ElasticPlate plate{.infill_kg_m3 = 1030.0};
  const double restoring = (plate.mantle_kg_m3 - plate.infill_kg_m3) * plate.gravity_m_s2;
  const double alpha = std::pow(4.0 * plate.rigidity_n_m() / restoring, 0.25);
  EXPECT_NEAR(alpha, 64.645e3, 5.0);
  const auto share = compensation_degrees(plate, 1500);
  const double load_n_m = 1e12;
  const auto deflection = [&](double distance_m) {
    // Ring on the equator: density sum (2 l + 1) / 2 P_l(0) P_l(x) over R.
    const double x = std::sin(distance_m / plate.radius_m);
    double before = 1.0, now = x, before0 = 1.0, now0 = 0.0, sum = share[0];
    for (int l = 1; l < 1500; ++l) {
      sum += (2.0 * l + 1.0) * share[l] * now * now0;
      const double next = ((2.0 * l + 1.0) * x * now - l * before) / (l + 1.0);
      const double next0 = -l * before0 / (l + 1.0);
      before = now, now = next, before0 = now0, now0 = next0;
    }
    return load_n_m / (2.0 * plate.radius_m * restoring) * sum;
  };
  EXPECT_NEAR(deflection(0.0), 347.330, 0.004 * 347.33);
  EXPECT_NEAR(deflection(203.09e3), -15.01, 0.8);
  EXPECT_GT(deflection(149e3), 0.0);
  EXPECT_LT(deflection(155e3), 0.0);
}

TEST(SphericalFilter, UnitGainsLeaveABandLimitedFieldAlone) {
  for (const auto& [nx, ny] : {std::pair{128, 64}, std::pair{120, 60}, std::pair{90, 45}}) {
    const Grid grid = Grid::sphere(nx, ny);
    auto field = tilted_harmonic(grid, 3);
    const auto more = tilted_harmonic(grid, 17);
    for (std::size_t c = 0; c < field.size(); ++c) field[c] += 2.0F * more[c] + 5.0F;
    auto filtered = field;
    filter_degrees(grid, filtered, std::vector<double>(ny / 2, 1.0));
    EXPECT_LT(greatest_difference(filtered, field, 1.0), 1e-5) << nx << " x " << ny;
  }
}

TEST(SphericalFilter, KeepsTheMeanOfTheSphere) {
  const Grid grid = Grid::sphere(128, 64);
  const std::vector<float> terrain = test::random_terrain(grid, 4);
  auto field = terrain;
  filter_degrees(grid, field, std::vector<double>{1.0, 0.0, 0.0});
  for (const float value : field) ASSERT_NEAR(value, field[0], 1e-3);
}

TEST(SphericalFilter, RejectsWhatItCannotDo) {
  std::vector<float> field(40 * 20);
  const std::vector<double> gain(11, 1.0);
  EXPECT_THROW(filter_degrees(Grid::torus(40, 20, 1e3, 1e3), field, gain), InputError);
  EXPECT_THROW(filter_degrees(Grid::sphere(42, 20), field, gain), InputError);
  EXPECT_THROW(filter_degrees(Grid::sphere(40, 20), field, std::vector<double>(21, 1.0)),
               InputError);
  EXPECT_THROW(compensation_degrees({.infill_kg_m3 = 3300.0}, 5), InputError);
}

}  // namespace
}  // namespace geo
