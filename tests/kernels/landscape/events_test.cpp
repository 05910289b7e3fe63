#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geo/kernels/climate/aerosol.hpp"
#include "geo/kernels/landscape/impact_crater.hpp"
#include "geo/kernels/landscape/rift_valley.hpp"

namespace geo {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

ImpactScene stone_on_earth(double diameter_m) {
  return {.diameter_m = diameter_m,
          .density_kg_m3 = 3000.0,
          .velocity_m_s = 20e3,
          .angle_deg = 45.0,
          .ground_density_kg_m3 = 2700.0,
          .gravity_m_s2 = 9.81};
}

// 1.161 * (3/2.7)^(1/3) * 1000^0.78 * 20000^0.44 * 9.81^-0.22 * (sqrt(1/2))^(1/3), by hand:
// 1.161 * 1.03574 * 218.776 * 78.0855 * 0.605195 * 0.890899 = 11 076 m.
TEST(Crater, TransientDiameterIsThatOfTheScalingLaw) {
  const Crater crater = crater_of(stone_on_earth(1000.0));
  EXPECT_NEAR(crater.transient_m, 11076.0, 12.0);
  EXPECT_NEAR(crater.diameter_m, 1.17 * std::pow(11.076, 1.13) * std::pow(3.2, -0.13) * 1e3, 25.0);
  EXPECT_NEAR(crater.energy_j, std::numbers::pi / 6.0 * 3e12 * 0.5 * 4e8, 1e17);
}

TEST(Crater, KnownCratersHaveTheirSize) {
  // Meteor Crater: 1.19 km wide, of some 3e8 kg of iron, 40 m wide, at 12 km/s (Melosh & Collins
  // 2005, Nature 434, 157).
  ImpactScene barringer = stone_on_earth(40.0);
  barringer.density_kg_m3 = 7800.0;
  barringer.velocity_m_s = 12e3;
  const Crater meteor = crater_of(barringer);
  EXPECT_FALSE(meteor.complex);
  EXPECT_NEAR(meteor.diameter_m, 1190.0, 240.0);
  EXPECT_NEAR(meteor.depth_m / meteor.diameter_m, 0.21, 0.02);  // bowls: about one in five
  // Tycho on the Moon: 85 km wide, 4.7 km deep, a peak of 1.6 to 2 km.
  ImpactScene lunar = stone_on_earth(7000.0);
  lunar.gravity_m_s2 = 1.62;
  const Crater tycho = crater_of(lunar);
  EXPECT_TRUE(tycho.complex);
  EXPECT_FALSE(tycho.has_peak_ring);
  EXPECT_NEAR(tycho.diameter_m, 85e3, 20e3);
  EXPECT_NEAR(tycho.depth_m, 4700.0, 1000.0);
  EXPECT_NEAR(tycho.uplift_m, 1800.0, 400.0);
}

TEST(Crater, ProfileIsContinuousAndThinsAsEjectaDo) {
  for (const double impactor_m : {30.0, 800.0, 12e3}) {
    const Crater crater = crater_of(stone_on_earth(impactor_m));
    const double radius_m = 0.5 * crater.diameter_m;
    double before = crater_profile_m(crater, 0.0), lowest = before;
    constexpr int kSteps = 20000;
    for (int step = 1; step <= kSteps; ++step) {
      const double now = crater_profile_m(crater, 3.0 * radius_m * step / kSteps);
      ASSERT_LT(std::abs(now - before), 3e-3 * crater.depth_m) << impactor_m << " " << step;
      before = now, lowest = std::min(lowest, now);
    }
    EXPECT_NEAR(lowest, crater.rim_m - crater.depth_m, 0.01 * crater.depth_m);
    EXPECT_NEAR(crater_profile_m(crater, radius_m), crater.rim_m, 1e-9 * crater.rim_m);
    for (const double r : {1.5 * radius_m, 5.0 * radius_m}) {
      const double ejecta_m = std::pow(crater.transient_m, 4) / (112.0 * r * r * r);
      EXPECT_NEAR(crater_profile_m(crater, r), ejecta_m, 0.021 * ejecta_m);
    }
    EXPECT_EQ(crater_erasure(crater, 0.5 * radius_m), 1.0);
    EXPECT_EQ(crater_erasure(crater, 1.3 * radius_m), 0.0);
  }
}

TEST(Crater, WaterShieldsTheGroundFromSmallBodiesAlone) {
  ImpactScene small = stone_on_earth(200.0), large = stone_on_earth(20e3);
  const double small_dry = crater_of(small).diameter_m, large_dry = crater_of(large).diameter_m;
  small.water_depth_m = large.water_depth_m = 4000.0;
  EXPECT_LT(crater_of(small).diameter_m, 0.2 * small_dry);
  EXPECT_GT(crater_of(large).diameter_m, 0.9 * large_dry);
  EXPECT_EQ(crater_of(small).energy_j, crater_of(stone_on_earth(200.0)).energy_j);
}

TEST(Crater, LargeOnesHaveAPeakRing) {
  const Crater crater = crater_of(stone_on_earth(12e3));
  ASSERT_TRUE(crater.has_peak_ring);
  const double radius_m = 0.5 * crater.diameter_m, floor = crater.rim_m - crater.depth_m;
  EXPECT_NEAR(crater_profile_m(crater, 0.0), floor, 1e-6);
  EXPECT_NEAR(crater_profile_m(crater, 0.5 * radius_m), floor + crater.uplift_m, 1e-6);
}

AerosolVeil veil_of(double mass_kg) {
  return {.mass_kg = mass_kg,
          .lifetime_yr = 2.0,
          .planet_area_m2 = 5.1e14,
          .absorbed_w_m2 = 238.0,
          .feedback_w_m2_k = 2.09,
          .heat_capacity_w_yr_m2_k = 9.4};
}

TEST(Aerosol, PinatuboHasItsOpticalDepth) {
  EXPECT_NEAR(aerosol_optical_depth(veil_of(3e10)), 0.15, 0.005);
}

TEST(Aerosol, CoolingSolvesTheHeatBalance) {
  const AerosolVeil veil = veil_of(1e12);
  const double depth = aerosol_optical_depth(veil);
  const double forcing = 238.0 * (1.0 - std::exp(-25.0 * depth / 238.0));
  double temperature = 0.0, coldest = 0.0, after_twelve = 0.0;
  constexpr double kStep_yr = 1e-3;
  for (int step = 0; step < 20000; ++step) {
    const double middle_yr = (step + 0.5) * kStep_yr;
    const double gain = -forcing * std::exp(-middle_yr / veil.lifetime_yr) - 2.09 * temperature;
    temperature += gain * kStep_yr / veil.heat_capacity_w_yr_m2_k;
    coldest = std::min(coldest, temperature);
    if (step == 11999) after_twelve = temperature;
  }
  EXPECT_NEAR(aerosol_cooling_k(veil, 0.0), -coldest, 2e-3 * -coldest);
  EXPECT_NEAR(aerosol_cooling_k(veil, 12.0), -after_twelve, 2e-3 * -after_twelve);
}

TEST(Aerosol, CoolingGrowsWithMassUpToDarknessAndPasses) {
  double before = -1.0;
  for (const double mass_kg : {0.0, 1e9, 1e11, 1e13, 1e15}) {
    const double now = aerosol_cooling_k(veil_of(mass_kg), 0.0);
    EXPECT_GT(now, before);
    before = now;
  }
  EXPECT_EQ(aerosol_cooling_k(veil_of(0.0), 0.0), 0.0);
  EXPECT_NEAR(before, 26.0, 4.0);  // Brugger et al. 2017
  EXPECT_LT(aerosol_cooling_k(veil_of(1e15), 1000.0), 1e-12);
  EXPECT_GE(aerosol_cooling_k(veil_of(1e15), 1e7), 0.0);
}

TEST(Aerosol, EqualTimesAreNoSingularity) {
  AerosolVeil equal = veil_of(1e12), near = equal;
  equal.lifetime_yr = equal.heat_capacity_w_yr_m2_k / equal.feedback_w_m2_k;
  near.lifetime_yr = 1.0001 * equal.lifetime_yr;
  EXPECT_NEAR(aerosol_cooling_k(equal, 0.0), aerosol_cooling_k(near, 0.0), 1e-3);
  EXPECT_GT(aerosol_cooling_k(equal, 0.0), 1.0);
}

TEST(Rift, ShouldersAreThoseOfABrokenPlate) {
  const RiftSection section{30e3, 1000.0, 600.0, 50e3};
  // w'''' = -4 w / flexure^4, by central differences.
  constexpr double kStep_m = 500.0;
  for (double x = 40e3; x < 250e3; x += 10e3) {
    const auto w = [&](int k) { return rift_profile_m(section, x + k * kStep_m); };
    const double fourth =
        (w(2) - 4.0 * w(1) + 6.0 * w(0) - 4.0 * w(-1) + w(-2)) / std::pow(kStep_m, 4);
    EXPECT_NEAR(fourth * std::pow(section.flexure_m, 4), -4.0 * w(0), 0.5);
  }
  EXPECT_EQ(rift_profile_m(section, 0.0), -1000.0);
  EXPECT_NEAR(rift_profile_m(section, 30e3), 600.0, 1e-9);
  EXPECT_NEAR(rift_profile_m(section, 29.999e3), 600.0, 1.0);
}

TEST(Rift, DistanceFromALineOfGreatCircles) {
  const auto at = [](double latitude_deg, double longitude_deg) -> Vector3 {
    const double b = latitude_deg * kDegree, l = longitude_deg * kDegree;
    return {std::cos(b) * std::cos(l), std::cos(b) * std::sin(l), std::sin(b)};
  };
  const GreatCirclePath line({at(0, 170), at(0, -160), at(40, -160)});
  EXPECT_NEAR(line.length(), 70.0 * kDegree, 1e-12);
  const auto beside = line.nearest(at(7, 179), 0.5);
  EXPECT_NEAR(beside.distance, 7.0 * kDegree, 1e-12);
  EXPECT_NEAR(beside.along, 9.0 * kDegree, 1e-12);
  const auto second = line.nearest(at(20, -161), 0.5);
  EXPECT_NEAR(second.distance, std::asin(std::cos(20 * kDegree) * std::sin(kDegree)), 1e-12);
  const auto before = line.nearest(at(0, 165), 0.5);  // past the end: from the end itself
  EXPECT_NEAR(before.distance, 5.0 * kDegree, 1e-12);
  EXPECT_EQ(before.along, 0.0);
  EXPECT_GT(line.nearest(at(-40, 0), 0.5).distance, 3.0);
}

}  // namespace
}  // namespace geo
