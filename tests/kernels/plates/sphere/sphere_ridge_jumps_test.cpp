// Ridges that jump to plumes beside them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

constexpr double kHalf_mm_yr = 30.0;

SphereSettings jumping() {
  SphereSettings settings = quiet();
  settings.ridge_jump_km = 600.0;
  settings.ridge_jump_age_myr = 20.0;
  return settings;
}

/// Two hemispheres that have parted at longitude 0 for as long as `since_myr` says, with a plume
/// below the eastern one.
SphereState parted(const SampledSphere& world, double plume_longitude_deg, double oldest_myr,
                   double half_mm_yr = kHalf_mm_yr) {
  SphereState state = hemispheres(world, 2.0 * half_mm_yr);
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const double away_km = std::abs(longitude_deg(world.samples.position(i))) * test::kKmPerDegree;
    state.crust.age_myr[i] = static_cast<float>(std::max(oldest_myr, away_km / kHalf_mm_yr));
  }
  SpherePlume plume;
  plume.place = place(0.0, plume_longitude_deg);
  plume.growth_mm_yr = 1.0;
  state.plumes.push_back(plume);
  return state;
}

std::ptrdiff_t jumps(const SphereTectonics& model) {
  return std::ranges::count(model.events, SphereEvent::Kind::ridge_jump, &SphereEvent::kind);
}

TEST(SphereRidgeJumps, WhatLiesBeforeAPlumeComesToThePlateBeyondTheRidge) {
  const SampledSphere world(40000);  // 113 km apart
  SphereTectonics model(world.mesh, jumping(), parted(world, 4.5, 0.0), 1);
  resample(model);
  ASSERT_EQ(jumps(model), 1);
  EXPECT_EQ(model.events.back().first, 1);
  EXPECT_EQ(model.events.back().second, 0);
  double moved_km2 = 0.0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const double longitude = longitude_deg(world.samples.position(i));
    const double latitude = std::abs(latitude_deg(world.samples.position(i)));
    if (longitude < 0.0) continue;
    const bool has_moved = model.state.crust.plate[i] == 0;
    if (has_moved) moved_km2 += model.sample_km2();
    if (longitude < 3.5 && latitude < 2.0) {
      EXPECT_TRUE(has_moved) << longitude << " " << latitude;
    }
    if (longitude > 5.5 || latitude > 6.5) {
      EXPECT_FALSE(has_moved) << longitude << " " << latitude;
    }
  }
  EXPECT_NEAR(moved_km2, model.events.back().area_km2, 1.0);
  // From now on floor grows above the plume.
  model.settings.ridge_jump_km = 0.0;
  for (int k = 0; k < 5; ++k) advance(model);
  finish(model);
  const auto age_at = [&](double longitude) {
    return model.state.crust.age_myr[world.samples.nearest(place(0.0, longitude))];
  };
  EXPECT_LT(age_at(4.5), 4.0F);
  EXPECT_GT(age_at(0.0), 10.0F);   // 4.5 degrees of floor came along, 15 Myr old at most
  EXPECT_GT(age_at(-1.5), 10.0F);  // where the ridge was, moved with its plate
  EXPECT_NEAR(model.budget.area_error, 0.0, 1e-12);
}

TEST(SphereRidgeJumps, NoneToOldFloorFarOffAboveTheRidgeOrWhereNothingOpens) {
  const SampledSphere world(40000);
  const auto jumps_of = [&](const SphereState& state, const SphereSettings& settings) {
    SphereTectonics model(world.mesh, settings, state, 1);
    resample(model);
    return jumps(model);
  };
  EXPECT_EQ(jumps_of(parted(world, 4.5, 0.0), jumping()), 1);
  EXPECT_EQ(jumps_of(parted(world, 4.5, 0.0), quiet()), 0);
  EXPECT_EQ(jumps_of(parted(world, 4.5, 25.0), jumping()), 0);
  EXPECT_EQ(jumps_of(parted(world, 9.0, 0.0), jumping()), 0);
  EXPECT_EQ(jumps_of(parted(world, 0.8, 0.0), jumping()), 0);
  EXPECT_EQ(jumps_of(parted(world, 4.5, 0.0, -kHalf_mm_yr), jumping()), 0);
  SphereState held = parted(world, 4.5, 0.0);
  held.plates[1].is_held = true;
  EXPECT_EQ(jumps_of(held, jumping()), 0);
  SphereState ended = parted(world, 4.5, 0.0);
  ended.plumes[0].growth_mm_yr = 0.0;
  EXPECT_EQ(jumps_of(ended, jumping()), 0);
}

TEST(SphereRidgeJumps, FollowersJumpWithTheirLeader) {
  const SampledSphere leading(40000), world(60000);
  SphereTectonics leader(leading.mesh, jumping(), parted(leading, 5.0, 0.0), 1);
  SphereTectonics model(world.mesh, jumping(), parted(world, 5.0, 0.0), 1);
  follow(model, leader);
  finish_both(model, leader);
  while (!leader.budget.resampled) advance_both(model, leader);
  ASSERT_GE(jumps(leader), 1);
  EXPECT_EQ(jumps(model), jumps(leader));
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const std::int32_t there = leading.samples.nearest(world.samples.position(i));
    const auto& plate = leader.state.crust.plate;
    const bool is_inside = std::ranges::all_of(
        leading.mesh.neighbours(there), [&](std::int32_t j) { return plate[j] == plate[there]; });
    if (is_inside) EXPECT_EQ(model.state.crust.plate[i], plate[there]);
  }
}

}  // namespace
}  // namespace geo
