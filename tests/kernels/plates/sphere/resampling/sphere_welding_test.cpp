// Which plates become one when the crust is resampled, and how they move then.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "kernels/plates/sphere/hemispheres.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::hemispheres;
using test::kRadius_km;
using test::place;
using test::quiet;
using test::SampledSphere;

SphereSettings welding(double mm_yr) {
  SphereSettings settings = quiet();
  settings.welding_mm_yr = mm_yr;
  return settings;
}

/// All crust of these latitudes and longitudes is continental.
void make_land(const SampledSphere& world, SphereState& state) {
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    state.crust.continental[i] = 1;
    state.crust.thickness_m[i] = 35000.0F;
    state.crust.elevation_m[i] = 300.0F;
  }
}

std::ptrdiff_t living(const SphereTectonics& model) {
  return std::ranges::count_if(model.state.plates, [](const SpherePlate& p) { return p.alive; });
}

void drift(SphereTectonics& model, int steps) {
  for (int k = 0; k < steps; ++k) advance(model);
  finish(model);
}

TEST(SphereWelding, PlatesThatHardlyMoveBesideEachOtherBecomeOne) {
  const SampledSphere world(20000);
  // 9 mm/yr at the equator are 9 sqrt(2/3) = 7.3 mm/yr, root mean square over a hemisphere.
  SphereTectonics model(world.mesh, welding(7.6), hemispheres(world, -3.0, 6.0), 1);
  drift(model, 2);
  ASSERT_EQ(living(model), 1);
  const auto whole = std::ranges::find_if(model.state.plates, &SpherePlate::alive);
  const std::int16_t part = static_cast<std::int16_t>(1 - whole->id);
  EXPECT_EQ(model.state.lives[part].joined, whole->id);
  EXPECT_LT(model.state.lives[part].ended_myr, PlateLife::kLives);
  // The common angular momentum is kept: (6 - 3)/2 mm/yr eastwards. Floor that has opened is of
  // one or the other, so that their areas differ by less than 1 %.
  EXPECT_NEAR(whole->axis[2] * whole->speed_rad_myr * kRadius_km, 1.5, 0.05);
  EXPECT_NEAR(model.budget.area_error, 0.0, 1e-12);
  EXPECT_NEAR(model.budget.ocean_error_km2, 0.0, 1e-3);
}

TEST(SphereWelding, FasterOnesStayApart) {
  const SampledSphere world(20000);
  SphereTectonics model(world.mesh, welding(7.1), hemispheres(world, -3.0, 6.0), 1);
  drift(model, 2);
  EXPECT_EQ(living(model), 2);
  SphereTectonics off(world.mesh, welding(0.0), hemispheres(world, 0.0), 1);
  drift(off, 2);
  EXPECT_EQ(living(off), 2);
}

TEST(SphereWelding, ContinentsHoldOutLonger) {
  const SampledSphere world(20000);
  SphereState state = hemispheres(world, 4.0);
  make_land(world, state);
  SphereSettings settings = welding(7.0);
  SphereTectonics floorlike(world.mesh, settings, state, 1);
  drift(floorlike, 2);
  EXPECT_EQ(living(floorlike), 1);
  settings.welding_continental = 0.8;  // 1.4 mm/yr where continents border each other all along
  SphereTectonics continents(world.mesh, settings, state, 1);
  drift(continents, 2);
  EXPECT_EQ(living(continents), 2);
}

TEST(SphereWelding, RiftsThatDoNotOpenInTimeFail) {
  const SampledSphere world(20000);
  SphereSettings settings = welding(10.0);
  settings.welding_after_myr = 30.0;
  SphereTectonics model(world.mesh, settings, hemispheres(world, 60.0), 1);
  const std::vector<Vector3> places{place(0.0, 60.0), place(0.0, 120.0)};
  rift_plate(model, 1, places, 2.0);
  drift(model, 12);
  EXPECT_EQ(living(model), 3);
  drift(model, 5);
  EXPECT_EQ(living(model), 2);
}

TEST(SphereWelding, PlatesThatAreToldHowToMoveAreNotWelded) {
  const SampledSphere world(20000);
  SphereTectonics model(world.mesh, welding(10.0), hemispheres(world, 2.0), 1);
  hold_motions(model);
  drift(model, 2);
  EXPECT_EQ(living(model), 2);
}

TEST(SphereWelding, WhatAPartKnowsOfItsNeighboursTheWholeKnows) {
  const SampledSphere world(20000);
  SphereState state = hemispheres(world, 0.0);
  // A third plate round the north pole that goes below the part which is welded.
  SpherePlate polar;
  polar.axis = {0.0, 1.0, 0.0};
  polar.speed_rad_myr = 40.0 / kRadius_km;
  state.add_plate(polar);
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& at = world.samples.position(i);
    if (at[2] > 0.5) state.crust.plate[i] = 2;
    if (at[2] <= 0.5 && at[0] < 0.2) state.crust.plate[i] = 0;
    if (at[2] <= 0.5 && at[0] >= 0.2) state.crust.plate[i] = 1;
  }
  PlatePair& met = state.pair(1, 2);
  met.ocean_top = 1;
  met.is_ocean_top_final = true;
  met.last_contact_myr = 0.0F;
  SphereTectonics model(world.mesh, welding(5.0), state, 1);
  finish(model);
  resample(model);
  ASSERT_EQ(living(model), 2);
  EXPECT_EQ(model.state.pair(0, 2).ocean_top, 1);
  EXPECT_TRUE(model.state.pair(0, 2).is_ocean_top_final);
}

TEST(SphereWelding, OfTwoSmallPlatesOneJoinsTheOther) {
  const SampledSphere world(20000);
  SphereState state = hemispheres(world, 60.0);
  for (int k = 0; k < 2; ++k) state.add_plate(state.plates[0]);
  // Two discs that border each other more than anything else that is as slow.
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& at = world.samples.position(i);
    if (dot(at, place(0.0, -90.0)) < std::cos(0.25)) continue;
    state.crust.plate[i] = at[2] > 0.0 ? 2 : 3;
  }
  state.plates[0].speed_rad_myr *= 2.0;
  SphereSettings settings = quiet();
  settings.smallest_piece_km2 = 5e6;  // each has 4, both 8
  SphereTectonics model(world.mesh, settings, state, 1);
  drift(model, 1);
  for (const PlateLife& life : model.state.lives) {
    if (life.ended_myr == PlateLife::kLives) continue;
    ASSERT_GE(life.joined, 0);
    EXPECT_EQ(model.state.lives[life.joined].ended_myr, PlateLife::kLives);
  }
  EXPECT_EQ(living(model), 3);
}

TEST(SphereWelding, ContinentsLastAsSmallerPlatesThanFloor) {
  const SampledSphere world(20000);
  for (const bool is_land : {false, true}) {
    SphereState state = hemispheres(world, 60.0);
    state.add_plate(state.plates[0]);
    for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
      if (dot(world.samples.position(i), place(0.0, -90.0)) < std::cos(0.2)) continue;
      state.crust.plate[i] = 2;
      state.crust.continental[i] = is_land ? 1 : 0;
    }
    SphereSettings settings = quiet();
    settings.smallest_piece_km2 = 8e6;  // the disc has 5.1
    settings.piece_continental_weight = 2.0;
    SphereTectonics model(world.mesh, settings, state, 1);
    drift(model, 1);
    EXPECT_EQ(living(model), is_land ? 3 : 2);
  }
}

}  // namespace
}  // namespace geo
