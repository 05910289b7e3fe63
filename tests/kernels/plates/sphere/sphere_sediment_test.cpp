// What rivers lay on moving plates, and the sea that it is laid in.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "geo/kernels/plates/sphere/surface/sphere_water.hpp"
#include "geo/kernels/plates/tectonic_laws.hpp"
#include "hemispheres.hpp"
#include "kernels/plates/sphere/sphere_steps.hpp"

namespace geo {
namespace {

using test::hemispheres;
using test::SampledSphere;

SphereSettings with_rivers() {
  SphereSettings settings = test::quiet();
  settings.by_rivers = true;
  settings.floor_by_age = true;
  settings.least_steps = settings.most_steps = 1000;  // the lattice stays as it is
  return settings;
}

double sediment_km3(const SphereTectonics& model) {
  const auto& sediment_m = model.state.crust.sediment_m;
  return 1e-3 * model.sample_km2() * std::accumulate(sediment_m.begin(), sediment_m.end(), 0.0);
}

TEST(SphereSediment, OfFloorThatSubductsIsScrapedOffInPart) {
  const SampledSphere world(8000);
  for (const bool below_continent : {false, true}) {
    SphereSettings settings = with_rivers();
    settings.law.uplift_mm_yr = 0.0;
    SphereState state = hemispheres(world, 100.0);
    for (std::int32_t i = 0; i < state.crust.size(); ++i) {
      if (state.crust.plate[i] == 1) {
        state.crust.sediment_m[i] = 500.0F;  // the older floor, which goes down
      } else if (below_continent) {
        state.crust.continental[i] = 1;
        state.crust.thickness_m[i] = 30000.0F;
        state.crust.elevation_m[i] = -500.0F;
      }
    }
    SphereTectonics model(world.mesh, settings, std::move(state), 1);
    double subducted_km3 = 0.0, scraped_km3 = 0.0;
    const double before_km3 = sediment_km3(model), crust_km3 = [&] {
      measure_volume(model);
      return model.budget.continental_km3;
    }();
    for (int k = 0; k < 6; ++k) {
      advance(model);
      subducted_km3 += model.budget.sediment_subducted_km3;
      scraped_km3 += model.budget.scraped_km3;
    }
    ASSERT_GT(subducted_km3, 0.0);
    // A share of what came stays, on whatever overrides.
    double kept_km3 = 0.0;
    for (std::int32_t i = 0; i < model.state.crust.size(); ++i) {
      if (model.state.crust.plate[i] == 0) {
        kept_km3 += 1e-3 * model.sample_km2() * model.state.crust.sediment_m[i];
      }
    }
    const double share = settings.accreted_share;
    EXPECT_NEAR(kept_km3, subducted_km3 * share / (1.0 - share), 1e-5 * kept_km3);
    EXPECT_NEAR(sediment_km3(model) + subducted_km3, before_km3, 1e-6 * before_km3);
    if (below_continent) {
      EXPECT_NEAR(scraped_km3, kept_km3, 1e-3 * kept_km3);
      EXPECT_NEAR(model.budget.continental_km3 - crust_km3, scraped_km3, 1e-2 * scraped_km3);
    } else {
      EXPECT_EQ(scraped_km3, 0.0);
    }
  }
}

/// A continent about the north pole, 2 km high, on a plate at rest.
SphereState polar_continent(const SampledSphere& world) {
  SphereState state = hemispheres(world, 1.0);
  for (std::int32_t i = 0; i < state.crust.size(); ++i) {
    if (world.samples.position(i)[2] < 0.8) continue;
    state.crust.continental[i] = 1;
    state.crust.thickness_m[i] = 40000.0F;
    state.crust.elevation_m[i] = 2000.0F + 500.0F * static_cast<float>(i % 7);
  }
  return state;
}

TEST(SphereSediment, IsWhatRiversHaveLaidLessWhatTheyHaveTakenAgain) {
  const SampledSphere world(8000);
  SphereTectonics model(world.mesh, with_rivers(), polar_continent(world), 1);
  double laid_km3 = 0.0, reworked_km3 = 0.0;
  for (int k = 0; k < 5; ++k) {
    run_rivers(model);
    laid_km3 = model.budget.sediment_laid_km3;
    reworked_km3 = model.budget.sediment_reworked_km3;
    EXPECT_NEAR(sediment_km3(model), laid_km3 - reworked_km3, 1e-6 * laid_km3);
  }
  EXPECT_GT(reworked_km3, 0.0);
  // All that is eroded is laid somewhere.
  EXPECT_NEAR(laid_km3 - reworked_km3,
              model.budget.deposited_km3 + model.budget.sea_floor_km3 - reworked_km3,
              1e-5 * laid_km3);
  EXPECT_NEAR(model.budget.eroded_km3, model.budget.deposited_km3 + model.budget.sea_floor_km3,
              1e-5 * model.budget.eroded_km3);
  for (const float thickness_m : model.state.crust.sediment_m) EXPECT_GE(thickness_m, 0.0F);
}

TEST(SphereSediment, RiversOnDryLandErodeLess) {
  const SampledSphere world(8000);
  double eroded_km3[2];
  for (const bool dry : {false, true}) {
    SphereState state = polar_continent(world);
    if (dry) state.runoff.assign(world.mesh.size(), 0.04F);
    SphereSettings settings = with_rivers();
    settings.rivers.erodibility_yr = 1e-9;  // far from base level: as the square root of runoff
    SphereTectonics model(world.mesh, settings, std::move(state), 1);
    run_rivers(model);
    eroded_km3[dry ? 1 : 0] = model.budget.eroded_km3;
  }
  EXPECT_NEAR(eroded_km3[1] / eroded_km3[0], 0.2, 0.01);
}

TEST(SphereSea, StandsWhereItsWaterHasIt) {
  const SampledSphere world(8000);
  SphereTectonics model(world.mesh, with_rivers(), polar_continent(world), 1);
  keep_water(model);
  EXPECT_EQ(model.state.sea_level_m, 0.0);  // no water is known
  model.state.water_km3 = sea_volume_km3(model, 0.0);
  keep_water(model);
  EXPECT_NEAR(model.state.sea_level_m, 0.0, 0.001);
  // Nine tenths of the planet are sea: a layer of 100 m taken from it lowers it by as much.
  double sea_km2 = 0.0;
  for (const float z : model.state.crust.elevation_m) sea_km2 += z < 0.0F ? model.sample_km2() : 0;
  model.state.ice_km3 = 0.1 * sea_km2;
  keep_water(model);
  EXPECT_NEAR(model.state.sea_level_m, -100.0, 0.01);
  // Floor that rises lifts it, and rivers see it.
  for (float& z : model.state.crust.elevation_m) z += z < 0.0F ? 300.0F : 0.0F;
  keep_water(model);
  EXPECT_NEAR(model.state.sea_level_m, 200.0, 0.01);
}

TEST(SphereSea, ComesBackToItsShareOfThePlanet) {
  const SampledSphere world(8000);
  SphereSettings settings = with_rivers();
  settings.freeboard_myr = 20.0;
  settings.freeboard_ocean_share = 0.95;  // part of the continent
  SphereTectonics model(world.mesh, settings, polar_continent(world), 1);
  exchange_water(model);
  EXPECT_EQ(model.state.water_km3, 0.0);  // no water is known
  const double wanted_km3 = sea_volume_km3(model, level_above(model, 0.05));
  model.state.water_km3 = 0.5 * wanted_km3;
  const double left = std::exp(-settings.law.step_myr / settings.freeboard_myr);
  double missing_km3 = 0.5 * wanted_km3;
  for (int k = 0; k < 5; ++k) {
    exchange_water(model);
    missing_km3 *= left;
    EXPECT_NEAR(wanted_km3 - model.state.water_km3, missing_km3, 1e-9 * wanted_km3);
  }
}

TEST(SphereSediment, OldRockErodesLessThanYoungAndThanSediment) {
  const SampledSphere world(8000);
  const auto eroded_km3 = [&](double age_myr, double sediment_m) {
    SphereSettings settings = with_rivers();
    settings.rivers.erodibility_yr = 1e-9;  // far from base level: as the erodibility
    settings.old_rock_erodibility = 0.2;
    settings.hardening_myr = 100.0;
    SphereState state = polar_continent(world);
    for (float& age : state.crust.orogeny_age_myr) age = static_cast<float>(age_myr);
    for (float& thickness : state.crust.sediment_m) thickness = static_cast<float>(sediment_m);
    SphereTectonics model(world.mesh, settings, std::move(state), 1);
    run_rivers(model);
    return model.budget.eroded_km3;
  };
  const double young = eroded_km3(0.0, 0.0);
  EXPECT_NEAR(eroded_km3(2000.0, 0.0) / young, 0.2, 0.01);
  EXPECT_NEAR(eroded_km3(100.0, 0.0) / young, 0.2 + 0.8 * std::exp(-1.0), 0.01);
  EXPECT_NEAR(eroded_km3(2000.0, 1000.0) / young, 1.0, 0.01);
}

TEST(SphereSea, LeavesAShareOfThePlanetAboveALevel) {
  const SampledSphere world(8000);
  SphereTectonics model(world.mesh, with_rivers(), polar_continent(world), 1);
  EXPECT_GE(level_above(model, 0.05), 2000.0);
  EXPECT_LE(level_above(model, 0.2), -4900.0);
}

}  // namespace
}  // namespace geo
