// What holds on whole planets that drift, of any size and seed.
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

#include "geo/kernels/plates/sphere/sphere_start.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::SampledSphere;

bool same_bits(const SphereState& a, const SphereState& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0;
  };
  bool all = a.plates.size() == b.plates.size();
  for (std::size_t p = 0; all && p < a.plates.size(); ++p) {
    all = a.plates[p].axis == b.plates[p].axis &&
          a.plates[p].speed_rad_myr == b.plates[p].speed_rad_myr &&
          a.plates[p].turn.w == b.plates[p].turn.w && a.plates[p].alive == b.plates[p].alive;
  }
  return all && same(a.crust.plate, b.crust.plate) &&
         same(a.crust.continental, b.crust.continental) && same(a.crust.orogeny, b.crust.orogeny) &&
         same(a.crust.elevation_m, b.crust.elevation_m) &&
         same(a.crust.thickness_m, b.crust.thickness_m) && same(a.crust.age_myr, b.crust.age_myr) &&
         same(a.crust.fold, b.crust.fold) && same(a.crust.ridge, b.crust.ridge);
}

TEST(SphereTectonics, GivesTheSameBitsOnAnyNumberOfThreads) {
  const SampledSphere world(12000);
  SphereSettings settings;
  settings.rift_per_myr = 0.02;
  const int threads = omp_get_max_threads();
  std::vector<SphereState> ends;
  for (const int number : {1, 2, 4}) {
    omp_set_num_threads(number);
    SphereTectonics model(world.mesh, settings, start_sphere(world.mesh, {}, settings, 5), 5);
    for (int k = 0; k < 35; ++k) advance(model);
    ends.push_back(model.state);
  }
  omp_set_num_threads(threads);
  EXPECT_TRUE(same_bits(ends[0], ends[1]));
  EXPECT_TRUE(same_bits(ends[0], ends[2]));
}

TEST(SphereTectonics, PlanetsOfAnySizeStayWhole) {
  const SampledSphere world(600);
  for (const double radius_km : {1.0, 30.0, 1000.0, 100000.0}) {
    for (const bool by_forces : {false, true}) {
      SCOPED_TRACE(std::to_string(radius_km) + " km" + (by_forces ? ", forces" : ""));
      SphereSettings settings;
      settings.radius_km = radius_km;
      settings.mean_area_km2 = 4.0 * std::numbers::pi * radius_km * radius_km / 20.0;
      settings.rift_per_myr = 0.05;
      settings.plume_mm_yr = 1.0;
      settings.suture_drag = 1200.0;
      settings.by_forces = by_forces;
      SphereStart start;
      start.plates = 20;
      SphereTectonics model(world.mesh, settings, start_sphere(world.mesh, start, settings, 1), 1);
      for (const std::int16_t plate : model.state.crust.plate) ASSERT_GE(plate, 0);
      for (int k = 0; k < 40; ++k) advance(model);
      finish(model);
      EXPECT_GE(model.budget.plates, 1);
      EXPECT_NEAR(model.budget.area_error, 0.0, 1e-12);
      const SphereCrust& crust = model.state.crust;
      for (std::int32_t i = 0; i < crust.size(); ++i) {
        ASSERT_GE(crust.plate[i], 0);
        ASSERT_TRUE(model.state.plates[crust.plate[i]].alive);
        ASSERT_TRUE(std::isfinite(crust.elevation_m[i]) && std::isfinite(crust.thickness_m[i]));
        ASSERT_TRUE(std::isfinite(crust.age_myr[i]));
      }
    }
  }
}

TEST(SphereTectonics, TheMassBalanceOfContinentsClosesToRoundingHoweverLong) {
  const SampledSphere world(1000);
  SphereSettings settings;
  settings.floor_by_age = true;
  settings.law.erosion_mm_yr = 0.24;
  settings.thickest_km = 50.0;
  for (const bool by_rivers : {false, true}) {
    settings.by_rivers = by_rivers;
    SphereStart start;
    start.plates = 8;
    SphereTectonics model(world.mesh, settings, start_sphere(world.mesh, start, settings, 2), 2);
    finish(model);
    const double first_km3 = model.budget.continental_km3;
    double change_km3 = 0.0;
    for (int k = 0; k < 250; ++k) {
      advance(model);
      const SphereBudget& b = model.budget;
      change_km3 += b.raised_km3 - b.eroded_km3 + b.deposited_km3 + b.scraped_km3 + b.emerged_km3 +
                    b.changed_km3 - b.lost_km3 + b.resampling_km3;
    }
    const double last_km3 = model.budget.continental_km3;
    EXPECT_GT(std::abs(last_km3 - first_km3), 0.01 * first_km3);
    // A collision may leave half of the last digit of one thickness, 2 mm.
    EXPECT_NEAR(last_km3, first_km3 + change_km3, 1e-8 * last_km3) << by_rivers;
  }
}

TEST(SphereTectonics, PlanetsOfManySeedsStayWhole) {
  const SampledSphere world(8000);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    SphereSettings settings;
    settings.floor_by_age = true;
    SphereTectonics model(world.mesh, settings, start_sphere(world.mesh, {}, settings, seed), seed);
    for (int k = 0; k < 50; ++k) {
      advance(model);
      if (!model.budget.resampled) continue;
      ASSERT_NEAR(model.budget.area_error, 0.0, 1e-12);
      ASSERT_NEAR(model.budget.created_km2, model.budget.consumed_km2 + model.budget.buried_km2,
                  0.08 * model.budget.created_km2);
    }
    resample(model);
    const SphereCrust& crust = model.state.crust;
    for (std::int32_t i = 0; i < crust.size(); ++i) {
      ASSERT_GE(crust.plate[i], 0);
      ASSERT_TRUE(model.state.plates[crust.plate[i]].alive);
      ASSERT_TRUE(std::isfinite(crust.elevation_m[i]) && std::isfinite(crust.thickness_m[i]));
      ASSERT_TRUE(std::isfinite(crust.age_myr[i]) && crust.age_myr[i] >= 0.0F);
      ASSERT_GT(crust.elevation_m[i], -11000.0F);
      ASSERT_LT(crust.elevation_m[i], 12000.0F);
    }
    EXPECT_GT(model.budget.plates, 8);
  }
}

}  // namespace
}  // namespace geo
