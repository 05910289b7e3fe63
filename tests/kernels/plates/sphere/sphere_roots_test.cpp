// Roots of continents that are thicker than crust can be.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/kernels/plates/sphere/sphere_start.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::kKmPerDegree;
using test::latitude_deg;
using test::longitude_deg;
using test::SampledSphere;

constexpr double kRoot_m = 120000.0, kWhole_m = 36000.0, kMost_m = 75000.0;

/// A plate at rest with a round continent, in whose middle the crust is as thick as two and more.
class ThickRoot : public testing::Test {
 protected:
  static SphereSettings settings() {
    SphereSettings s;
    s.rift_per_myr = s.initiation_per_myr = s.slab_pull = 0.0;
    s.law.erosion_mm_yr = 0.0;
    s.floor_by_age = true;
    return s;
  }
  SphereTectonics with_continent(double radius_km, double root_km) const {
    SphereState state;
    state.crust.resize(world_.mesh.size());
    state.add_plate({});
    for (std::int32_t i = 0; i < world_.mesh.size(); ++i) {
      const double far_km = middle_km(i);
      const bool is_land = far_km < radius_km, is_root = far_km < root_km;
      state.crust.plate[i] = 0;
      state.crust.continental[i] = is_land ? 1 : 0;
      state.crust.thickness_m[i] =
          static_cast<float>(is_root ? kRoot_m : (is_land ? kWhole_m : 7000.0));
      state.crust.elevation_m[i] = is_root ? 9000.0F : (is_land ? 500.0F : -5000.0F);
    }
    return {world_.mesh, settings(), std::move(state), 1};
  }
  double middle_km(std::int32_t i) const {
    const Vector3& at = world_.samples.position(i);
    return kKmPerDegree * std::hypot(latitude_deg(at), longitude_deg(at));
  }
  /// Sums over the continent: number of samples and thickness.
  struct Sums {
    int samples = 0;
    double thick_m = 0.0, thickest_m = 0.0;
  };
  static Sums sums(const SphereCrust& crust) {
    Sums sums;
    for (std::int32_t i = 0; i < crust.size(); ++i) {
      if (crust.continental[i] == 0) continue;
      ++sums.samples;
      sums.thick_m += crust.thickness_m[i];
      sums.thickest_m = std::max<double>(sums.thickest_m, crust.thickness_m[i]);
    }
    return sums;
  }

  SampledSphere world_{60000};
};

TEST_F(ThickRoot, SpreadsToAPlateauOfTheSameVolume) {
  SphereTectonics model = with_continent(2000.0, 300.0);
  const SphereCrust was = model.state.crust;
  const Sums before = sums(was);
  ASSERT_EQ(before.thickest_m, kRoot_m);
  advance(model);
  const Sums after = sums(model.state.crust);
  EXPECT_LE(after.thickest_m, kMost_m + 2.0);
  EXPECT_NEAR(after.thick_m, before.thick_m, 1e-5 * before.thick_m);
  // The surface goes with the root as Airy has it.
  const SphereCrust& now = model.state.crust;
  for (std::int32_t i = 0; i < now.size(); ++i) {
    if (now.continental[i] == 0) continue;
    ASSERT_NEAR(6.6 * (now.elevation_m[i] - was.elevation_m[i]),
                now.thickness_m[i] - was.thickness_m[i], 1.0);
  }
  EXPECT_LT(model.budget.lost_km3, 1e-5 * model.budget.continental_km3);
  // As much as was above the limit lies round the root: pi R^2 with 45 km over 39 km of room.
  int wide = 0;
  for (std::int32_t i = 0; i < world_.mesh.size(); ++i) {
    wide += model.state.crust.thickness_m[i] > 1.2 * kWhole_m ? 1 : 0;
  }
  const double root_km2 = std::numbers::pi * 300.0 * 300.0;
  const double sample_km2 = 4.0 * std::numbers::pi * 6370.0 * 6370.0 / world_.mesh.size();
  EXPECT_NEAR(wide * sample_km2, root_km2 * (1.0 + 45.0 / 39.0), 0.35 * root_km2);
}

TEST_F(ThickRoot, OfASmallIslandLosesWhatFindsNoRoom) {
  SphereTectonics model = with_continent(350.0, 300.0);
  const Sums before = sums(model.state.crust);
  advance(model);
  const Sums after = sums(model.state.crust);
  EXPECT_LE(after.thickest_m, kMost_m + 2.0);
  EXPECT_NEAR(after.thick_m, kMost_m * after.samples, 1e-3 * after.thick_m);
  const double sample_km2 = 4.0 * std::numbers::pi * 6370.0 * 6370.0 / world_.mesh.size();
  EXPECT_NEAR(model.budget.lost_km3, 1e-3 * sample_km2 * (before.thick_m - after.thick_m),
              1e-5 * model.budget.continental_km3);
}

/// A Gaussian belt spreads as one of a plane does: (h - h_c) = h_0 s^2 / (s^2 + 4 D t) e^(-r^2 /
/// (s^2
/// + 4 D t)).
TEST_F(ThickRoot, FlowsToItsSidesAsDiffusionHasIt) {
  SphereTectonics model = with_continent(3000.0, 0.0);
  model.settings.thickest_km = 0.0;
  model.settings.crustal_flow_km2_myr = 2000.0;
  model.settings.crustal_flow_above_km = 36.0;
  constexpr double kHigh_m = 20000.0, kWide_km = 500.0, kTime_myr = 60.0;
  SphereCrust& crust = model.state.crust;
  const auto far_km = [&](std::int32_t i) {
    return 6370.0 * angle_between(world_.samples.position(i), {1.0, 0.0, 0.0});
  };
  for (std::int32_t i = 0; i < crust.size(); ++i) {
    if (crust.continental[i] == 0) continue;
    const double r = far_km(i) / kWide_km;
    crust.thickness_m[i] = static_cast<float>(kWhole_m + kHigh_m * std::exp(-r * r));
  }
  const Sums before = sums(crust);
  for (int k = 0; k < 30; ++k) advance(model);
  const double grown = kWide_km * kWide_km + 4.0 * 2000.0 * kTime_myr;
  for (std::int32_t i = 0; i < crust.size(); ++i) {
    if (crust.continental[i] == 0 || far_km(i) > 1500.0) continue;
    const double wanted_m = kWhole_m + kHigh_m * kWide_km * kWide_km / grown *
                                           std::exp(-std::pow(far_km(i), 2) / grown);
    ASSERT_NEAR(crust.thickness_m[i], wanted_m, 0.03 * kHigh_m) << far_km(i);
  }
  EXPECT_NEAR(sums(crust).thick_m, before.thick_m, 1e-6 * before.thick_m);
}

TEST_F(ThickRoot, StaysWhereThereIsNoLimit) {
  SphereTectonics model = with_continent(2000.0, 300.0);
  SphereSettings free = settings();
  free.thickest_km = 0.0;
  SphereTectonics unlimited(world_.mesh, free, model.state, 1);
  advance(unlimited);
  EXPECT_EQ(sums(unlimited.state.crust).thickest_m, kRoot_m);
}

}  // namespace
}  // namespace geo
