// Rules of the drift beyond the papers: advance of the overriding plate, the sea as base level, and
// continents that have stopped.
#include <gtest/gtest.h>

#include <cmath>

#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "kernels/plates/sphere/hemispheres.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::hemispheres;
using test::latitude_deg;
using test::longitude_deg;
using test::SampledSphere;

/// Quiet plates of which no floor begins to subduct, either.
SphereSettings settled() {
  SphereSettings settings = test::quiet();
  settings.initiation_per_myr = 0.0;
  return settings;
}

/// Rise of the overriding plate along the equator in a step, m.
double rise_m(const SampledSphere& world, double west_mm_yr, double east_mm_yr,
              double advance_mm_yr) {
  SphereSettings settings = settled();
  settings.law.damping_mm_yr = 0.0;
  settings.accretion_width_km = 0.0;
  settings.advance_mm_yr = advance_mm_yr;
  SphereTectonics model(world.mesh, settings, hemispheres(world, west_mm_yr, east_mm_yr), 1);
  advance(model);
  double most = 0.0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    if (std::abs(latitude_deg(world.samples.position(i))) > 10.0) continue;
    most = std::max(most, model.state.crust.elevation_m[i] + 5000.0);
  }
  return most;
}

TEST(OverridingPlates, RiseAsTheyAdvanceOnTheirTrench) {
  const SampledSphere world(20000);
  // Both close at 80 mm/yr, so that the papers' law gives the same to all.
  const double plain = rise_m(world, -40.0, 40.0, 0.0);
  ASSERT_GT(plain, 20.0);
  EXPECT_NEAR(rise_m(world, 0.0, 80.0, 0.0), plain, 0.05 * plain);
  EXPECT_NEAR(rise_m(world, 0.0, 80.0, 40.0), plain / 3.0, 0.05 * plain);
  EXPECT_NEAR(rise_m(world, -20.0, 60.0, 40.0), plain * (1.0 / 3.0 + 0.5), 0.05 * plain);
  EXPECT_NEAR(rise_m(world, -80.0, 0.0, 40.0), plain * 5.0 / 3.0, 0.05 * plain);
  EXPECT_NEAR(rise_m(world, 40.0, 120.0, 40.0), 0.0, 0.01 * plain);
}

TEST(Erosion, GoesDownToTheSeaAsItStands) {
  const SampledSphere world(20000);
  SphereSettings settings = settled();
  settings.wears_land_alone = true;
  settings.ocean_share = 0.7;
  SphereState state = hemispheres(world, 0.0, 0.0);
  // By height: a fifth of the planet at 2000 m, a fifth at 150 m, floor. The sea covers 70 %, so it
  // stands at the lower land.
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const double share = 0.5 * (1.0 + world.samples.position(i)[2]);
    if (share < 0.6) continue;
    state.crust.continental[i] = 1;
    state.crust.thickness_m[i] = 36000.0F;
    state.crust.elevation_m[i] = share > 0.8 ? 2000.0F : 150.0F;
  }
  const auto was = state.crust.elevation_m;
  SphereTectonics model(world.mesh, settings, std::move(state), 1);
  advance(model);
  const double worn_m = 1850.0 / 10000.0 * 30.0 * 2.0;  // (z - sea) / z_c eps_c dt
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    if (model.state.crust.continental[i] == 0) continue;
    const double wanted = was[i] > 1000.0F ? worn_m : 0.0;
    ASSERT_NEAR(was[i] - model.state.crust.elevation_m[i], wanted, 0.05) << was[i];
  }
}

/// Collisions of two continents that close at 20 mm/yr for 80 Myr, 1600 km.
int collisions(const SampledSphere& world, double suturing_mm_yr) {
  SphereSettings settings = settled();
  settings.penetration_km = 5000.0;
  settings.suturing_mm_yr = suturing_mm_yr;
  SphereState state = hemispheres(world, -10.0, 10.0);
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& at = world.samples.position(i);
    if (std::abs(latitude_deg(at)) > 25.0 || std::abs(longitude_deg(at)) < 140.0) continue;
    state.crust.continental[i] = 1;
    state.crust.thickness_m[i] = 36000.0F;
    state.crust.elevation_m[i] = 300.0F;
  }
  SphereTectonics model(world.mesh, settings, std::move(state), 1);
  int count = 0;
  while (model.state.time_myr < 80.0) {
    advance(model);
    count += model.budget.collisions;
  }
  return count;
}

TEST(Continents, BecomeOnePlateOnceTheyHaveAllButStopped) {
  const SampledSphere world(20000);
  EXPECT_EQ(collisions(world, 0.0), 0);
  EXPECT_EQ(collisions(world, 15.0), 0);
  EXPECT_EQ(collisions(world, 25.0), 1);
}

}  // namespace
}  // namespace geo
