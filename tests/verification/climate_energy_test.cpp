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

TEST(Insolation, AnnualMeansMatchExactValues) {
  // Exact orbit integrals at obliquity 23.44, S0 = 1361, no eccentricity.
  const std::pair<double, double> kExact[] = {
      {0, 415.54}, {30, 365.16}, {45, 306.90}, {60, 236.29}};
  for (const auto& [latitude, expected] : kExact) {
    EXPECT_NEAR(insolation_cycle(latitude, 23.44, 1361.0).mean_w_m2, expected, 0.01) << latitude;
    EXPECT_NEAR(insolation_cycle(-latitude, 23.44, 1361.0).mean_w_m2, expected, 0.01) << latitude;
  }
  EXPECT_NEAR(insolation_cycle(90, 23.44, 1361.0).mean_w_m2,
              1361.0 * std::sin(23.44 * kRadians) / std::numbers::pi, 0.01);
}

/// Second Legendre coefficient of the annual insolation over its mean.
double second_legendre(double obliquity_deg) {
  constexpr int kRows = 400;
  double sum = 0.0;
  for (int row = 0; row < kRows; ++row) {
    const double x = (row + 0.5) / kRows;
    const double q =
        insolation_cycle(std::asin(x) / kRadians, obliquity_deg, 4.0).mean_w_m2;  // S0/4 = 1
    sum += q * 0.5 * (3 * x * x - 1) / kRows;
  }
  return 5.0 * sum;
}

// A planet that stands on its head turns backwards under the same sun: sin(180 deg - e) = sin e.
TEST(Insolation, BeyondNinetyDegreesIsThatOfTheSupplement) {
  for (const double obliquity : {0.0, 23.44, 60.0, 90.0}) {
    for (const double latitude : {-80.0, -35.0, 0.0, 50.0, 89.0}) {
      for (double longitude = 0.0; longitude < 360.0; longitude += 15.0) {
        EXPECT_NEAR(daily_insolation_w_m2(latitude, longitude, 180.0 - obliquity, 1361.0),
                    daily_insolation_w_m2(latitude, longitude, obliquity, 1361.0), 1e-9)
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

TEST(Insolation, HarmonicIsAntisymmetricAboutTheEquator) {
  const auto north = insolation_cycle(50, 23.44, 1361.0),
             south = insolation_cycle(-50, 23.44, 1361.0);
  EXPECT_NEAR(std::abs(north.harmonic_w_m2 + south.harmonic_w_m2), 0.0, 1e-9);
  EXPECT_LT(north.harmonic_w_m2.imag(), -100.0) << "most sun at the northern solstice, L = 90 deg";
}

struct Solution {
  std::vector<double> mean;
  std::vector<std::complex<double>> harmonic;
};

Solution solve(const Grid& grid, const EnergyBalance& model, float land) {
  std::vector<double> latitude;
  for (int j = 0; j < grid.ny(); ++j) latitude.push_back(grid.latitude_deg(j));
  const auto size = static_cast<std::size_t>(grid.size());
  Solution s{std::vector<double>(size), std::vector<std::complex<double>>(size)};
  solve_energy_balance(grid, model, latitude, std::vector<float>(size, land),
                       std::vector<float>(size, 0.0F), s.mean, s.harmonic);
  return s;
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
    mean += share * s.mean[grid.cell(0, j)];
    second += 5.0 * share * s.mean[grid.cell(0, j)] * 0.5 * (3 * x * x - 1);
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
    temperature += grid.area_m2(j) * x * s.harmonic[grid.cell(0, j)];
    insolation +=
        grid.area_m2(j) * x * insolation_cycle(grid.latitude_deg(j), 23.44, 1360.0).harmonic_w_m2;
  }
  const std::complex<double> expected =
      insolation * 0.7 / std::complex<double>(2 * 0.55 + 2.0, 2 * std::numbers::pi * 3.0);
  EXPECT_NEAR(std::abs(temperature / expected - 1.0), 0.0, 1e-3);
}

TEST(EnergyBalance, HeightsOnlyMatterThroughIce) {
  const Grid grid = Grid::sphere(60, 30);
  std::vector<double> latitude;
  for (int j = 0; j < grid.ny(); ++j) latitude.push_back(grid.latitude_deg(j));
  const auto size = static_cast<std::size_t>(grid.size());
  std::vector<double> low(size), high(size);
  std::vector<std::complex<double>> harmonic(size);
  const std::vector<float> land(size, 1.0F);
  const EnergyBalance model;
  solve_energy_balance(grid, model, latitude, land, std::vector<float>(size, 0.0F), low, harmonic);
  solve_energy_balance(grid, model, latitude, land, std::vector<float>(size, 3000.0F), high,
                       harmonic);
  EXPECT_LT(high[grid.cell(0, 3)], low[grid.cell(0, 3)]) << "a high plateau near the pole is icier";
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
