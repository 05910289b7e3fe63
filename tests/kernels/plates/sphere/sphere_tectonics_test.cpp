// Two plates of floor that part and meet, and how plates of a sphere move.
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geo/kernels/crust/ocean_depth.hpp"
#include "geo/kernels/plates/sphere/sphere_start.hpp"
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

TEST(SphereTectonics, OpensAnOceanWithItsRidgeInTheMiddleAndAgesToItsSides) {
  const SampledSphere world(30000);
  SphereSettings settings = quiet();
  settings.floor_by_age = true;
  // Part at longitude 0 and meet at 180: 100 mm/yr for 20 Myr opens 2000 km at the equator.
  SphereTectonics model(world.mesh, settings, hemispheres(world, 100.0), 1);
  for (int k = 0; k < 10; ++k) advance(model);
  resample(model);
  EXPECT_EQ(model.state.time_myr, 20.0);
  const SphereCrust& crust = model.state.crust;
  double worst = 0.0;
  int seen = 0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& at = world.samples.position(i);
    if (std::abs(latitude_deg(at)) > 20.0 || std::abs(longitude_deg(at)) > 7.0) continue;
    const double from_ridge_km =
        std::abs(longitude_deg(at)) * kKmPerDegree * std::cos(std::asin(at[2]));
    const double half_km = 1000.0 * std::cos(std::asin(at[2]));
    worst = std::max(worst, std::abs(crust.age_myr[i] - 20.0 * from_ridge_km / half_km));
    EXPECT_EQ(crust.plate[i], longitude_deg(at) < 0.0 ? 0 : 1) << longitude_deg(at);
    EXPECT_FLOAT_EQ(crust.elevation_m[i], static_cast<float>(-ocean_depth_m(crust.age_myr[i])));
    EXPECT_GT(std::abs(crust.ridge[i][2]), 0.9F);  // the ridge runs north
    ++seen;
  }
  EXPECT_GT(seen, 300);
  // The borders of plates are steps of samples, 140 km apart here.
  EXPECT_LT(worst, 20.0 * 180.0 / 1000.0);
}

TEST(SphereTectonics, OpensWhatTheRelativeMotionSweeps) {
  const SampledSphere world(30000);
  SphereTectonics model(world.mesh, quiet(), hemispheres(world, 100.0), 1);
  for (int k = 0; k < 10; ++k) advance(model);
  resample(model);
  // A lune of angle 2000 km / R has the area 2 R^2 angle; the steps of samples along the borders,
  // 140 km wide, open a little more.
  const double lune_km2 = 2.0 * 6370.0 * 2000.0;
  EXPECT_NEAR(model.budget.created_km2, lune_km2, 0.05 * lune_km2);
  EXPECT_NEAR(model.budget.consumed_km2, lune_km2, 0.05 * lune_km2);
  EXPECT_NEAR(model.budget.area_error, 0.0, 1e-12);
  EXPECT_NEAR(model.budget.ocean_change_km2, 0.0, 1.0);
}

TEST(SphereTectonics, OlderFloorGoesDown) {
  const SampledSphere world(20000);
  SphereTectonics model(world.mesh, quiet(), hemispheres(world, 100.0), 1);
  for (int k = 0; k < 5; ++k) advance(model);
  int below = 0, above = 0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    (model.state.crust.plate[i] == 1 ? below : above) += model.margins.hidden[i];
  }
  EXPECT_GT(below, 100);
  EXPECT_EQ(above, 0);
  for (const auto& trench : model.margins.trenches) {
    EXPECT_EQ(model.state.crust.plate[trench.sample], 0);
    EXPECT_EQ(trench.lower, 1);
  }
  EXPECT_GT(model.margins.trenches.size(), 40U);
}

TEST(SphereTectonics, RaisesTheOverridingPlateByItsLaw) {
  const SampledSphere world(30000);
  SphereSettings settings = quiet();
  settings.law.damping_mm_yr = 0.0;
  settings.accretion_width_km = 0.0;
  SphereTectonics model(world.mesh, settings, hemispheres(world, 100.0), 1);
  advance(model);
  int raised = 0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const std::int32_t k = model.margins.nearest_trench[i];
    if (k < 0) continue;
    const Vector3& at = world.samples.position(i);
    const double d_km =
        6370.0 * angle_between(at, world.samples.position(model.margins.trenches[k].sample));
    const double v = 100.0 * std::hypot(at[0], at[1]);
    // 0.6 mm/yr f g h with h = (5 / 20)^2, for 2 Myr.
    const double rise_m = 1200.0 * uplift_by_distance(d_km, 200.0, 1800.0) * v / 100.0 / 16.0;
    ASSERT_NEAR(model.state.crust.elevation_m[i], -5000.0 + rise_m, 0.01);
    raised += rise_m > 10.0;
  }
  EXPECT_GT(raised, 500);
}

TEST(SphereTectonics, SlabPullBringsAPlateToItsFront) {
  const SampledSphere world(20000);
  SphereSettings settings = quiet();
  settings.slab_pull = 0.02;
  // Both plates turn about the axis; plate 1 subducts at longitude 180, north and south alike, so
  // its axis keeps; one trench alone, north of the equator, would tilt it.
  SphereTectonics model(world.mesh, settings, hemispheres(world, 100.0), 1);
  for (int k = 0; k < 5; ++k) advance(model);
  EXPECT_LT(length(add(model.state.plates[1].axis, {0.0, 0.0, 1.0}, -1.0)), 0.01);
  EXPECT_EQ(model.state.plates[0].axis, (Vector3{0.0, 0.0, -1.0}));
}

TEST(SphereTectonics, TakesTheNetRotationAway) {
  const SampledSphere world(5000);
  SphereSettings settings;
  settings.rift_per_myr = 0.0;
  settings.slab_pull = 0.0;
  SphereTectonics model(world.mesh, settings, start_sphere(world.mesh, {}, settings, 3), 3);
  for (int k = 0; k < 4; ++k) advance(model);
  resample(model);
  const auto plate = model.state.crust.plate;  // they fill the sphere
  advance(model);
  Vector3 sum{};
  double speeds = 0.0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& r = world.samples.position(i);
    const Vector3 v = cross(model.rotation[plate[i]], r);
    sum = add(sum, cross(r, v));
    speeds += length(v);
  }
  EXPECT_GT(speeds * 6370.0 / world.mesh.size(), 10.0);  // mm/yr
  EXPECT_LT(6370.0 * length(sum) / world.mesh.size(), 1e-12);
}

}  // namespace
}  // namespace geo
