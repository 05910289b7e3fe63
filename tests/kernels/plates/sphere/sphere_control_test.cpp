// Crust and motions that are changed from outside between steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "geo/kernels/plates/great_circle_line.hpp"
#include "geo/kernels/plates/sphere/sphere_start.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "kernels/plates/sphere/hemispheres.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::hemispheres;
using test::latitude_deg;
using test::longitude_deg;
using test::place;
using test::quiet;
using test::SampledSphere;

TEST(SphereTectonics, ChangesTheCrustOfARegionWhereverItsPlatesAre) {
  const SampledSphere world(20000);
  SphereTectonics model(world.mesh, quiet(), hemispheres(world, 60.0), 1);
  for (int k = 0; k < 3; ++k) advance(model);
  const auto within = [](const Vector3& at) {
    return std::abs(latitude_deg(at)) < 15.0 && longitude_deg(at) > 60.0 &&
           longitude_deg(at) < 90.0;
  };
  const double area_km2 = change_crust(model, within, true);
  // The region's own area, 30 degrees wide.
  const double wanted_km2 =
      6370.0 * 6370.0 * std::numbers::pi / 6.0 * 2.0 * std::sin(std::numbers::pi / 12.0);
  EXPECT_NEAR(area_km2, wanted_km2, 0.03 * wanted_km2);
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Matrix3 frame = model.state.plates[model.state.crust.plate[i]].turn.matrix();
    EXPECT_EQ(model.state.crust.continental[i] != 0,
              within(times(frame, world.samples.position(i))));
  }
  EXPECT_EQ(change_crust(model, within, true), 0.0);
}

TEST(SphereTectonics, BendsTheCoastsOfChangedCrustAndKeepsTheirArea) {
  const SampledSphere world(40000);
  SphereTectonics model(world.mesh, quiet(), hemispheres(world, 60.0), 1);
  const Vector3 middle = place(10.0, 60.0);
  constexpr double kRadius = 0.25, kWarp_km = 150.0;
  const double area_km2 = change_crust(
      model, [&](const Vector3& at) { return angle_between(at, middle) < kRadius; }, true,
      kWarp_km);
  const double circle_km2 = 2.0 * std::numbers::pi * 6370.0 * 6370.0 * (1.0 - std::cos(kRadius));
  EXPECT_NEAR(area_km2, circle_km2, 0.08 * circle_km2);
  double inner_km = 1e9, outer_km = 0.0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const double far_km = 6370.0 * angle_between(world.samples.position(i), middle);
    const bool land = model.state.crust.continental[i] != 0;
    if (land) outer_km = std::max(outer_km, far_km);
    if (!land) inner_km = std::min(inner_km, far_km);
  }
  EXPECT_GT(outer_km - 6370.0 * kRadius, 0.3 * kWarp_km);
  EXPECT_LT(outer_km - 6370.0 * kRadius, 2.2 * kWarp_km);
  EXPECT_LT(inner_km - 6370.0 * kRadius, -0.3 * kWarp_km);
  EXPECT_GT(inner_km - 6370.0 * kRadius, -2.2 * kWarp_km);
}

/// Plates of a seed, all of them ocean.
SphereState bare_plates(const SampledSphere& world, const SphereSettings& settings) {
  SphereStart start;
  start.continental_share = 0.0;
  return start_sphere(world.mesh, start, settings, 3);
}

TEST(SphereTectonics, AMotionThatIsGivenHoldsAndNoOtherPlateFeelsIt) {
  const SampledSphere world(5000);
  SphereSettings settings;
  settings.rift_per_myr = 0.0;
  settings.slab_pull = 0.0;
  SphereTectonics model(world.mesh, settings, bare_plates(world, settings), 3);
  begin_step(model);
  const auto before = model.rotation;
  const Vector3 given = scaled(place(20.0, 70.0), 90.0 / 6370.0);
  set_motion(model, 5, given, length(given));
  advance(model);
  begin_step(model);
  for (std::size_t p = 0; p < before.size(); ++p) {
    const Vector3& wanted = p == 5 ? given : before[p];
    // Others that made room for plate 5 would change by 2 mm/yr; as plates turn, the weights of
    // their common rotation change a little.
    const double most = p == 5 ? 1e-9 : 0.2;
    EXPECT_LT(6370.0 * length(add(model.rotation[p], wanted, -1.0)), most) << p;
  }
}

TEST(SphereTectonics, AMotionThatIsGivenHoldsAgainstSlabPullAndFrame) {
  const SampledSphere world(5000);
  SphereSettings settings;
  settings.rift_per_myr = 0.0;
  settings.slab_pull = 0.02;
  for (const bool holds : {true, false}) {
    settings.hold_motions = holds;
    SphereTectonics model(world.mesh, settings, bare_plates(world, settings), 3);
    begin_step(model);
    const Vector3 given = scaled(place(20.0, 70.0), 90.0 / 6370.0);
    set_motion(model, 5, given, length(given));
    const Vector3 other = model.rotation[6];
    for (int k = 0; k < 12; ++k) advance(model);
    const double changed_mm_yr = 6370.0 * length(add(model.rotation[5], given, -1.0));
    if (holds) {
      EXPECT_LT(changed_mm_yr, 1e-9);
    } else {
      EXPECT_GT(changed_mm_yr, 5.0);
    }
    EXPECT_GT(6370.0 * length(add(model.rotation[6], other, -1.0)), 5.0);  // it is pulled
  }
}

TEST(SphereTectonics, BothHalvesOfAPlateThatIsHeldAreHeld) {
  const SampledSphere world(5000);
  SphereSettings settings;
  settings.rift_per_myr = 0.0;
  SphereTectonics model(world.mesh, settings, bare_plates(world, settings), 3);
  hold_motions(model);
  const Vector3 centre = model.partition.cap(5).centre;
  const std::vector<Vector3> line{centre, rotated(centre, scaled(place(0.0, 0.0), 0.1))};
  const auto plates = model.state.plates.size();
  rift_plate_along(model, 5, GreatCircleLine(line), 2, 20.0);
  const auto rotations = model.rotation;
  ASSERT_EQ(rotations.size(), plates + 1);
  for (int k = 0; k < 5; ++k) advance(model);
  EXPECT_EQ(model.rotation, rotations);
}

TEST(SphereTectonics, WhatIsDoneBetweenStepsIsInTheBudgetOfTheNext) {
  const SampledSphere world(5000);
  SphereTectonics model(world.mesh, quiet(), hemispheres(world, 0.0), 1);
  advance(model);
  begin_step(model);
  const std::vector<Vector3> line{place(-30.0, 90.0), place(30.0, 90.0)};
  rift_plate_along(model, 1, GreatCircleLine(line), 2, 0.0);
  const double area_km2 = change_crust(
      model, [](const Vector3& at) { return angle_between(at, place(0.0, -90.0)) < 0.15; }, true);
  advance(model);
  EXPECT_EQ(model.budget.rifts, 1);
  EXPECT_NEAR(model.budget.changed_km3, 36.0 * area_km2, 1e-6 * area_km2);
  advance(model);
  EXPECT_EQ(model.budget.rifts, 0);
  EXPECT_EQ(model.budget.changed_km3, 0.0);
}

}  // namespace
}  // namespace geo
