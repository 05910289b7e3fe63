#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "geo/kernels/climate/energy_balance.hpp"
#include "geo/kernels/climate/evaporation.hpp"
#include "geo/kernels/climate/insolation.hpp"

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr Orbit kCircle{23.44, 0.0, 0.0};

TEST(Insolation, AnnualMeansMatchExactValues) {
  // Exact orbit integrals at obliquity 23.44, S0 = 1361, no eccentricity.
  const std::pair<double, double> kExact[] = {
      {0, 415.54}, {30, 365.16}, {45, 306.90}, {60, 236.29}};
  for (const auto& [latitude, expected] : kExact) {
    EXPECT_NEAR(annual_insolation_w_m2(latitude, kCircle, 1361.0), expected, 0.01) << latitude;
    EXPECT_NEAR(annual_insolation_w_m2(-latitude, kCircle, 1361.0), expected, 0.01) << latitude;
  }
  EXPECT_NEAR(annual_insolation_w_m2(90, kCircle, 1361.0),
              1361.0 * std::sin(23.44 * kRadians) / std::numbers::pi, 0.01);
}

/// Second Legendre coefficient of the annual insolation over its mean.
double second_legendre(double obliquity_deg) {
  constexpr int kRows = 400;
  double sum = 0.0;
  for (int row = 0; row < kRows; ++row) {
    const double x = (row + 0.5) / kRows;
    const double q = annual_insolation_w_m2(std::asin(x) / kRadians, {obliquity_deg, 0.0, 0.0},
                                            4.0);  // S0/4 = 1
    sum += q * 0.5 * (3 * x * x - 1) / kRows;
  }
  return 5.0 * sum;
}

// A planet that stands on its head turns backwards under the same sun: sin(180 deg - e) = sin e.
TEST(Insolation, BeyondNinetyDegreesIsThatOfTheSupplement) {
  for (const double obliquity : {0.0, 23.44, 60.0, 90.0}) {
    for (const double latitude : {-80.0, -35.0, 0.0, 50.0, 89.0}) {
      for (double longitude = 0.0; longitude < 360.0; longitude += 15.0) {
        EXPECT_NEAR(daily_insolation_w_m2(latitude, {longitude, 1.0}, 180.0 - obliquity, 1361.0),
                    daily_insolation_w_m2(latitude, {longitude, 1.0}, obliquity, 1361.0), 1e-9)
            << obliquity << ", " << latitude << ", " << longitude;
      }
    }
  }
}

TEST(Insolation, SecondLegendreCoefficientFollowsObliquity) {
  for (const double obliquity : {0.0, 23.44, 54.74, 90.0}) {
    const double sine = std::sin(obliquity * kRadians);
    EXPECT_NEAR(second_legendre(obliquity), -5.0 / 16.0 * (2.0 - 3.0 * sine * sine), 1e-4)
        << obliquity;
  }
  EXPECT_NEAR(second_legendre(23.44), -0.47665, 1e-4);
}

// Kepler: a year's mean nearness is 1 / sqrt(1 - e^2), and at its ends (1 -+ e)^-2.
TEST(Insolation, EccentricOrbitsFollowKepler) {
  const Orbit orbit{23.44, 0.3, 282.9};
  double mean = 0.0, nearest = 0.0, farthest = 9.0;
  constexpr int kSteps = 20000;
  for (int k = 0; k < kSteps; ++k) {
    const Sun sun = sun_at(orbit, (k + 0.5) / kSteps);
    mean += sun.nearness / kSteps;
    nearest = std::max(nearest, sun.nearness);
    farthest = std::min(farthest, sun.nearness);
  }
  EXPECT_NEAR(mean, 1.0 / std::sqrt(1.0 - 0.09), 1e-6);
  EXPECT_NEAR(nearest, 1.0 / (0.7 * 0.7), 1e-5);
  EXPECT_NEAR(farthest, 1.0 / (1.3 * 1.3), 1e-5);
  EXPECT_NEAR(std::remainder(sun_at(orbit, 79.0 / 365.25).longitude_deg, 360.0), 0.0, 1e-6)
      << "the equinox is kept";
}

TEST(Insolation, OfMonthsIsOppositeInTheHemispheres) {
  const auto north = monthly_insolation_w_m2(50, kCircle, 1361.0);
  const auto january = north[0], july = north[6];
  EXPECT_GT(july, january + 300.0);
  // Half a year on, the other hemisphere has the same sun.
  for (double t : {0.0, 0.1, 0.37}) {
    EXPECT_NEAR(daily_insolation_w_m2(50, sun_at(kCircle, t), 23.44, 1361.0),
                daily_insolation_w_m2(-50, sun_at(kCircle, t + 0.5), 23.44, 1361.0), 1e-6);
  }
}

TemperatureCycle solve(const Grid& grid, const EnergyBalance& model, float land,
                       float height_m = 0.0F) {
  std::vector<double> latitude;
  for (int j = 0; j < grid.ny(); ++j) latitude.push_back(grid.latitude_deg(j));
  const auto size = static_cast<std::size_t>(grid.size());
  return solve_energy_balance(grid, model, false, latitude, std::vector<double>(grid.ny(), 0.0),
                              std::vector<float>(size, land), std::vector<float>(size, height_m));
}

EnergyBalance constant_albedo() {
  EnergyBalance model;
  model.solar_constant_w_m2 = 1360.0;
  model.outgoing_w_m2 = 210.0;
  model.outgoing_slope_w_m2_k = 2.0;
  model.diffusivity_w_m2_k = 0.55;
  model.moist_transport = 0.0;
  model.coalbedo = 0.7;
  model.coalbedo_p2 = 0.0;
  model.ice_width_k = 0.0;
  model.orbit = kCircle;
  model.gyre_heat_w_m2 = 0.0;
  return model;
}

TEST(EnergyBalance, ConstantAlbedoMatchesLegendreSolution) {
  // T0 = (Q a - A)/B and T2 = Q a s2/(6 D + B) are exact for each degree. The textbook number
  // -21.5547 is T2 at s2 = -0.48; the sun of obliquity 23.44 has s2 = -0.47665.
  const Grid grid = Grid::sphere(90, 90);
  const auto s = solve(grid, constant_albedo(), 1.0F);
  double mean = 0.0, second = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    const double x = std::sin(grid.latitude_deg(j) * kRadians);
    const double share = grid.area_m2(j) * grid.nx() / grid.total_area_m2();
    mean += share * s.mean_c(grid.cell(0, j));
    second += 5.0 * share * s.mean_c(grid.cell(0, j)) * 0.5 * (3 * x * x - 1);
  }
  EXPECT_NEAR(mean, 14.000, 0.005);
  EXPECT_NEAR(second / -0.47665 * -0.48, -21.5547, 0.03) << "second order in the spacing of 2 deg";
}

TEST(EnergyBalance, HarmonicSolvesTheStoringPlanet) {
  // On a uniform planet degree 1 dominates the annual harmonic: T1 = Q1 a / (2 D + B + i omega C).
  const Grid grid = Grid::sphere(90, 90);
  EnergyBalance model = constant_albedo();
  model.land_heat_capacity_w_yr_m2_k = 3.0;
  const auto s = solve(grid, model, 1.0F);
  std::complex<double> temperature = 0.0, insolation = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    const double x = std::sin(grid.latitude_deg(j) * kRadians);
    temperature += grid.area_m2(j) * x * s.harmonic(1)[grid.cell(0, j)];
    for (int m = 0; m < kMonths; ++m) {
      insolation += grid.area_m2(j) * x * 2.0 / kMonths *
                    monthly_insolation_w_m2(grid.latitude_deg(j), kCircle, 1360.0)[m] *
                    std::polar(1.0, -2 * std::numbers::pi * (m + 0.5) / kMonths);
    }
  }
  const std::complex<double> expected =
      insolation * 0.7 / std::complex<double>(2 * 0.55 + 2.0, 2 * std::numbers::pi * 3.0);
  EXPECT_NEAR(std::abs(temperature / expected - 1.0), 0.0, 1e-3);
}

TEST(EnergyBalance, HeightsOnlyMatterThroughSnowAndIce) {
  const Grid grid = Grid::sphere(60, 30);
  const EnergyBalance model;
  const Index cell = grid.cell(0, 3);
  EXPECT_LT(solve(grid, model, 1.0F, 3000.0F).mean_c(cell), solve(grid, model, 1.0F).mean_c(cell))
      << "a high plateau near the pole is icier";
  EnergyBalance without = model;
  without.ice_width_k = 0.0;
  EXPECT_NEAR(solve(grid, without, 1.0F, 3000.0F).mean_c(cell),
              solve(grid, without, 1.0F).mean_c(cell), 1e-6);
}

TEST(EnergyBalance, SeaWindsMakeWesternCoastsMild) {
  const Grid grid = Grid::sphere(90, 45);
  std::vector<double> latitude, wind(grid.ny(), 5.0);
  for (int j = 0; j < grid.ny(); ++j) latitude.push_back(grid.latitude_deg(j));
  std::vector<float> land(grid.size());
  for (Index c = 0; c < grid.size(); ++c) land[c] = grid.column(c) < 30 ? 1.0F : 0.0F;
  EnergyBalance model;
  model.gyre_heat_w_m2 = 0.0;
  const std::vector<float> flat(land.size(), 0.0F);
  const auto range = [&](bool retrograde, int column) {
    std::vector<double> blowing(wind);
    if (retrograde) std::fill(blowing.begin(), blowing.end(), -5.0);
    const auto year = solve_energy_balance(grid, model, retrograde, latitude, blowing, land, flat);
    const Index cell = grid.cell(column, 34);  // 50 N
    return 2.0 * std::abs(year.harmonic(1)[cell]);
  };
  EXPECT_LT(range(false, 1), range(false, 28)) << "the western coast has the smaller range";
  EXPECT_NEAR(range(true, 28), range(false, 1), 1e-3) << "mirrored on a planet that turns back";
}

TEST(Budyko, SpotValueAndLimits) {
  EXPECT_NEAR(800.0 * budyko_evaporated_share(1000.0 / 800.0), 615.65, 0.01);
  EXPECT_EQ(budyko_evaporated_share(0.0), 0.0);
  EXPECT_NEAR(budyko_evaporated_share(1e-4), 1e-4, 1e-7) << "wet: all of the energy evaporates";
  EXPECT_NEAR(budyko_evaporated_share(50.0), 1.0, 1e-3) << "dry: all of the rain evaporates";
}

TEST(Oudin, FollowsItsFormula) {
  // 300 W m-2 for a day over 2.45 MJ kg-1 is 10.58 mm; (15 + 5)/100 of it.
  EXPECT_NEAR(oudin_evaporation_mm_d(300.0, 15.0), 300.0 * 86400 / 2.45e6 * 0.2, 1e-12);
  EXPECT_EQ(oudin_evaporation_mm_d(300.0, -5.0), 0.0);
}

}  // namespace
}  // namespace geo
