// How old new floor is.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "geo/kernels/plates/great_circle_line.hpp"
#include "geo/kernels/plates/sphere/sphere_start.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::kKmPerDegree;
using test::kRadius_km;
using test::latitude_deg;
using test::longitude_deg;
using test::SampledSphere;

SphereSettings settings_of(std::int64_t steps_between) {
  SphereSettings settings;
  settings.rift_per_myr = 0.0;
  settings.initiation_per_myr = 0.0;
  settings.slab_pull = 0.0;
  settings.no_net_rotation = false;
  settings.margin_km = 0.0;
  settings.penetration_km = 1e6;  // none collide
  settings.least_steps = settings.most_steps = steps_between;
  return settings;
}

/// Land all round, in two halves that touch at longitude 0: all floor is new.
SphereState land(const SampledSphere& world) {
  SphereState state;
  state.crust.resize(world.mesh.size());
  for (int p = 0; p < 2; ++p) state.add_plate({});
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    state.crust.plate[i] = longitude_deg(world.samples.position(i)) < 0.0 ? 0 : 1;
    state.crust.continental[i] = 1;
    state.crust.thickness_m[i] = 36000.0F;
    state.crust.elevation_m[i] = 300.0F;
  }
  return state;
}

double oldest_floor_myr(const SphereTectonics& model) {
  const SphereCrust& crust = model.state.crust;
  double oldest = -1.0;
  for (std::int32_t i = 0; i < crust.size(); ++i) {
    if (crust.plate[i] < 0 || crust.continental[i] != 0) continue;
    oldest = std::max(oldest, static_cast<double>(crust.age_myr[i]));
  }
  return oldest;
}

/// Both halves turn about the polar axis from now on, apart at longitude 0 where this is positive.
void part_at(SphereTectonics& model, double relative_mm_yr) {
  const double half = 0.5 * std::abs(relative_mm_yr) / kRadius_km;
  const double sign = relative_mm_yr < 0.0 ? -1.0 : 1.0;
  set_motion(model, 0, {0.0, 0.0, -sign}, half);
  set_motion(model, 1, {0.0, 0.0, sign}, half);
}

TEST(SphereFloorAge, NoFloorIsOlderThanTheRiftThatMadeIt) {
  const SampledSphere world(20000);
  SphereTectonics model(world.mesh, settings_of(30), land(world), 1);
  for (int k = 0; k < 13; ++k) advance(model);
  const double rifted_myr = model.state.time_myr;
  const std::vector<Vector3> line{{0.0, std::cos(0.5), -std::sin(0.5)},
                                  {0.0, std::cos(0.5), std::sin(0.5)}};
  rift_plate_along(model, 1, GreatCircleLine(line), 2, 25.0);
  int seen = 0;
  for (int k = 0; k < 60; ++k) {
    advance(model);
    // As a frame would show it, 17 steps before it is resampled, and after that.
    SphereTectonics shown = model;
    finish(shown);
    ASSERT_LE(oldest_floor_myr(shown), model.state.time_myr - rifted_myr + 1e-4);
    seen += model.budget.resampled ? 1 : 0;
  }
  EXPECT_EQ(seen, 2);
  // The oldest lies at the coast.
  EXPECT_GT(oldest_floor_myr(model), 0.85 * (model.state.time_myr - rifted_myr));
}

TEST(SphereFloorAge, NoFloorIsOlderThanTheTurnOfItsPlates) {
  const SampledSphere world(20000);
  SphereTectonics model(world.mesh, settings_of(40), land(world), 1);
  part_at(model, -60.0);
  for (int k = 0; k < 12; ++k) advance(model);
  // They lie 1440 km over each other, and part for longer than it takes to come clear again.
  part_at(model, 120.0);
  for (int k = 0; k < 18; ++k) advance(model);
  finish(model);
  // At longitude 0; at 180 they have parted first and meet now.
  double oldest = 0.0;
  const SphereCrust& crust = model.state.crust;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    if (crust.continental[i] != 0 || std::abs(longitude_deg(world.samples.position(i))) > 90.0) {
      continue;
    }
    oldest = std::max(oldest, static_cast<double>(crust.age_myr[i]));
  }
  EXPECT_GT(oldest, 10.0);
  EXPECT_LE(oldest, 36.0 + 1e-4);
}

TEST(SphereFloorAge, AgesFollowTheRateAtWhichPlatesHaveParted) {
  const SampledSphere world(40000);
  SphereTectonics model(world.mesh, settings_of(40), land(world), 1);
  part_at(model, 40.0);
  for (int k = 0; k < 10; ++k) advance(model);
  part_at(model, 120.0);
  for (int k = 0; k < 5; ++k) advance(model);
  finish(model);
  // 800 km in 20 Myr, then 1200 km in 10: on both sides 600 km of the last 10 Myr, then 400 km of
  // 20.
  const SphereCrust& crust = model.state.crust;
  double sum = 0.0;
  int seen = 0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& at = world.samples.position(i);
    if (crust.continental[i] != 0 || std::abs(latitude_deg(at)) > 10.0) continue;
    if (std::abs(longitude_deg(at)) > 90.0) continue;
    const double from_ridge_km = std::abs(longitude_deg(at)) * kKmPerDegree;
    const double age_myr =
        from_ridge_km < 600.0 ? from_ridge_km / 60.0 : 10.0 + (from_ridge_km - 600.0) / 20.0;
    sum += std::abs(crust.age_myr[i] - age_myr);
    ++seen;
  }
  EXPECT_GT(seen, 100);
  // Coasts are steps of samples, 60 km to either side, at 20 to 60 km per Myr.
  EXPECT_LT(sum / seen, 2.0);
}

TEST(SphereFloorAge, OverRunsWithRiftsAllFloorIsYoungerThanTheFirst) {
  const SampledSphere world(20000);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SphereSettings settings = settings_of(15);
    settings.rift_per_myr = 0.02;
    settings.rift_onset_myr = seed == 2 ? 20.0 : 0.0;
    SphereTectonics model(world.mesh, settings, land(world), seed);
    double first_myr = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 36; ++k) {
      advance(model);
      for (const SphereEvent& event : model.events) {
        first_myr = std::min(first_myr, event.time_myr);
      }
      if (k % 4 != 0) continue;
      SphereTectonics shown = model;
      finish(shown);
      ASSERT_LE(oldest_floor_myr(shown), std::max(0.0, model.state.time_myr - first_myr) + 1e-4)
          << "seed " << seed << ", " << model.state.time_myr << " Myr";
    }
    EXPECT_LT(first_myr, 40.0);
    EXPECT_GT(oldest_floor_myr(model), 10.0);
  }
}

}  // namespace
}  // namespace geo
