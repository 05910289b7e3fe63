#include "geo/kernels/climate/insolation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

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

}  // namespace
}  // namespace geo
