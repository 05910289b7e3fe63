// How high continents stand while plates raise, wear and stretch them.
#include <gtest/gtest.h>

#include <cmath>

#include "geo/kernels/plates/sphere/sphere_start.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "geo/kernels/plates/tectonic_laws.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::SampledSphere;

SphereSettings quiet() {
  SphereSettings settings;
  settings.rift_per_myr = 0.0;
  settings.no_net_rotation = false;
  settings.least_steps = settings.most_steps = 1000;  // the lattice stays as it is
  return settings;
}

/// Height of crust that floats as 36 km at 350 m do.
double floating_m(double thickness_m) {
  return water_loaded(350.0 + (thickness_m - 36000.0) / 6.6);
}

TEST(Continents, FloatAsTheirCrustHasIt) {
  const SampledSphere world(30000);
  SphereSettings settings = quiet();
  settings.margin_km = 400.0;
  settings.law.erosion_mm_yr = 0.2;
  settings.law.collision_distance_km = 1500.0;
  for (const bool land_alone : {false, true}) {
    settings.wears_land_alone = land_alone;
    SphereState state = start_sphere(world.mesh, {}, settings, 5);
    const std::vector<std::int8_t> first = state.crust.continental;
    const std::vector<float> thick_m = state.crust.thickness_m;
    SphereTectonics model(world.mesh, settings, std::move(state), 5);
    for (int k = 0; k < 9; ++k) advance(model);
    const SphereCrust& crust = model.state.crust;
    int raised = 0, worn = 0, drowned = 0;
    for (std::int32_t i = 0; i < crust.size(); ++i) {
      if (first[i] == 0 || crust.plate[i] < 0 || crust.thickness_m[i] > 70000.0F) continue;
      ASSERT_NEAR(crust.elevation_m[i], floating_m(crust.thickness_m[i]), 2.0);
      raised += crust.thickness_m[i] > thick_m[i] + 50.0F;
      worn += crust.thickness_m[i] < thick_m[i] - 50.0F;
      drowned += crust.elevation_m[i] < -300.0F;
    }
    EXPECT_GT(raised, 200);
    EXPECT_GT(worn, 1000);
    EXPECT_GT(drowned, 500);
  }
}

TEST(Continents, BelowTheSeaFillUpOnlyWhereErosionGoesByHeight) {
  const SampledSphere world(8000);
  for (const bool land_alone : {false, true}) {
    SphereSettings settings = quiet();
    settings.law.erosion_mm_yr = 0.2;
    settings.wears_land_alone = land_alone;
    SphereState state;
    state.crust.resize(world.mesh.size());
    for (int k = 0; k < 2; ++k) state.add_plate({.axis = {0.0, 0.0, 1.0}});
    for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
      state.crust.plate[i] = world.samples.position(i)[2] < 0.0 ? 0 : 1;
      state.crust.continental[i] = 1;
      state.crust.elevation_m[i] = state.crust.plate[i] == 0 ? -1000.0F : 1000.0F;
      state.crust.thickness_m[i] = 30000.0F;
    }
    SphereTectonics model(world.mesh, settings, std::move(state), 1);
    for (int k = 0; k < 5; ++k) advance(model);
    // 10 Myr at 0.02 per Myr, in steps of 2 Myr: 0.96^5.
    const double left = std::pow(0.96, 5);
    const SphereCrust& crust = model.state.crust;
    for (std::int32_t i = 0; i < crust.size(); ++i) {
      const bool sea = crust.plate[i] == 0;
      const double wanted_m = sea ? (land_alone ? -1000.0 : -1000.0 * left) : 1000.0 * left;
      const double risen_m = sea ? (wanted_m + 1000.0) / 1.45 : wanted_m - 1000.0;
      ASSERT_NEAR(crust.elevation_m[i], wanted_m, 0.01);
      ASSERT_NEAR(crust.thickness_m[i], 30000.0 + 6.6 * risen_m, 0.1);
    }
  }
}

}  // namespace
}  // namespace geo
