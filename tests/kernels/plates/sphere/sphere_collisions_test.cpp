// Continents that collide, and what they keep.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "kernels/plates/sphere/hemispheres.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::hemispheres;
using test::kKmPerDegree;
using test::latitude_deg;
using test::longitude_deg;
using test::quiet;
using test::SampledSphere;

/// A continent on each side, so placed that they meet at longitude 180.
SphereState two_continents(const SampledSphere& world, double gap_km, double relative_mm_yr) {
  SphereState state = hemispheres(world, relative_mm_yr);
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& at = world.samples.position(i);
    const double from_180_km = (180.0 - std::abs(longitude_deg(at))) * kKmPerDegree;
    const double wide_km = state.crust.plate[i] == 0 ? 4000.0 : 1500.0;
    if (std::abs(latitude_deg(at)) > 15.0 || from_180_km < 0.5 * gap_km ||
        from_180_km > 0.5 * gap_km + wide_km) {
      continue;
    }
    state.crust.continental[i] = 1;
    state.crust.elevation_m[i] = 300.0F;
    state.crust.thickness_m[i] = 36000.0F;
  }
  return state;
}

TEST(SphereTectonics, ContinentsCollideWhenThreeHundredKilometresHaveGoneUnder) {
  const SampledSphere world(30000);
  // 500 km apart, 100 mm/yr: they touch after 5 Myr and collide after 8, at a step of 2 Myr and
  // samples 140 km apart.
  SphereTectonics model(world.mesh, quiet(), two_continents(world, 500.0, 100.0), 1);
  while (model.events.empty() && model.state.time_myr < 20.0) advance(model);
  ASSERT_EQ(model.events.size(), 1U);
  const SphereEvent& event = model.events.front();
  EXPECT_EQ(event.kind, SphereEvent::Kind::collision);
  EXPECT_GE(event.time_myr, 8.0);
  EXPECT_LE(event.time_myr, 12.0);
  EXPECT_EQ(event.first, 1);  // the smaller one
  EXPECT_EQ(event.second, 0);
  EXPECT_NEAR(event.area_km2, 1500.0 * 30.0 * kKmPerDegree, 0.06 * event.area_km2);
  // The mountains hold what was swallowed.
  const SphereBudget& budget = model.budget;
  EXPECT_GT(budget.swallowed_km3, 300.0 * 2000.0 * 30.0);
  double high = 0.0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    if (model.state.crust.orogeny[i] == static_cast<std::int8_t>(OrogenyType::himalayan)) {
      high = std::max(high, static_cast<double>(model.state.crust.elevation_m[i]));
    }
  }
  EXPECT_GT(high, 3000.0);
}

TEST(SphereTectonics, ATerraneThatTwoPlatesReachInOneStepGoesWithTheSecond) {
  // Continents round the equator on three plates; those of the outer ones come from both sides.
  const SampledSphere world(20000);
  SphereState state;
  state.crust.resize(world.mesh.size());
  for (const double eastward_mm_yr : {80.0, 0.0, -80.0}) {
    SpherePlate plate;
    plate.axis = {0.0, 0.0, eastward_mm_yr < 0.0 ? -1.0 : 1.0};
    plate.speed_rad_myr = std::abs(eastward_mm_yr) / 6370.0;
    state.add_plate(plate);
  }
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& at = world.samples.position(i);
    const double east = longitude_deg(at);
    state.crust.plate[i] = east < -30.0 ? 0 : east < 30.0 ? 1 : 2;
    state.crust.elevation_m[i] = -5000.0F;
    state.crust.thickness_m[i] = 7000.0F;
    state.crust.age_myr[i] = 50.0F;
    if (std::abs(latitude_deg(at)) > 20.0 || std::abs(east) > 120.0) continue;
    state.crust.continental[i] = 1;
    state.crust.elevation_m[i] = 300.0F;
    state.crust.thickness_m[i] = 36000.0F;
  }
  SphereTectonics model(world.mesh, quiet(), std::move(state), 1);
  while (model.events.empty() && model.state.time_myr < 20.0) advance(model);
  ASSERT_EQ(model.events.size(), 2U);
  EXPECT_EQ(model.events[0].first, 1);
  EXPECT_EQ(model.events[1].first, 3);  // the terrane, which has left plate 1
  ASSERT_EQ(model.state.plates.size(), 4U);
  EXPECT_EQ(model.state.plates[3].carrier, model.events[1].second);
  EXPECT_NE(model.events[0].second, model.events[1].second);
}

TEST(SphereTectonics, CollisionsKeepTheVolumeOfContinents) {
  const SampledSphere world(30000);
  SphereSettings settings = quiet();
  settings.law.erosion_mm_yr = 0.0;
  settings.law.uplift_mm_yr = 0.0;
  SphereTectonics model(world.mesh, settings, two_continents(world, 500.0, 100.0), 1);
  advance(model);
  const double before = model.budget.continental_km3;
  double lost = 0.0, resampling = 0.0;
  while (model.state.time_myr < 20.0) {
    advance(model);
    lost += model.budget.lost_km3;
    resampling += model.budget.resampling_km3;
  }
  ASSERT_EQ(model.events.size(), 1U);
  EXPECT_NEAR(model.budget.continental_km3, before - lost + resampling, 1e-6 * before);
  EXPECT_NEAR(resampling, 0.0, 0.02 * before);
  EXPECT_EQ(lost, 0.0);
}

}  // namespace
}  // namespace geo
