// Plates that are led by those of other samples, and chance that does not know the samples.
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geo/kernels/plates/sphere/sphere_start.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::SampledSphere;

SphereSettings lively() {
  SphereSettings settings;
  settings.floor_by_age = true;
  settings.by_forces = true;
  settings.rift_per_myr = 0.03;
  settings.mean_area_km2 = 5.1e8 / 10.0;
  settings.suture_drag = 200.0;
  settings.penetration_km = 1000.0;
  settings.smallest_piece_km2 = 5e6;
  settings.thickest_km = 63.0;
  settings.wears_land_alone = true;
  return settings;
}

SphereState begin(const SampledSphere& world, const SphereSettings& settings, std::uint64_t seed) {
  SphereStart start;
  start.plates = 10;
  start.continental_share = 0.35;
  start.continent_km = 8000.0;
  return start_sphere(world.mesh, start, settings, seed);
}

/// A follower after some steps.
struct Led {
  Led(const SampledSphere& leading, const SampledSphere& world, int steps, std::uint64_t seed = 3)
      : leader(leading.mesh, lively(), begin(leading, lively(), seed), seed),
        model(world.mesh, lively(), begin(world, lively(), seed), seed) {
    follow(model, leader);
    first_km3 = -1.0;
    for (int k = 0; k < steps; ++k) {
      advance_both(model, leader);
      const SphereBudget& b = model.budget;
      const double change_km3 = b.raised_km3 - b.eroded_km3 + b.deposited_km3 + b.scraped_km3 +
                                b.emerged_km3 + b.changed_km3 - b.lost_km3 + b.resampling_km3;
      if (first_km3 < 0.0) first_km3 = b.continental_km3 - change_km3;
      changed_km3 += change_km3;
      collisions += b.collisions;
      rifts += b.rifts;
    }
  }
  SphereTectonics leader, model;
  double first_km3, changed_km3 = 0.0;
  int collisions = 0, rifts = 0;
};

/// Share of places, of a lattice of its own, on which continents of two models agree.
double agreement(SphereTectonics a, SphereTectonics b) {
  finish(a);
  finish(b);
  const FibonacciSphere places(5000);
  int both = 0, either = 0;
  for (std::int32_t i = 0; i < places.size(); ++i) {
    const auto is_land = [&](const SphereTectonics& m) {
      return m.state.crust.continental[m.mesh->samples().nearest(places.position(i))] != 0;
    };
    const bool first = is_land(a), second = is_land(b);
    both += first && second ? 1 : 0;
    either += first || second ? 1 : 0;
  }
  return static_cast<double>(both) / either;
}

TEST(LedPlates, AreThoseOfTheLeaderHoweverManySamplesThereAre) {
  const SampledSphere leading(8000), coarse(10000), fine(20000);
  const Led one(leading, coarse, 40), other(leading, fine, 40);
  ASSERT_GT(one.rifts + one.collisions, 4);
  ASSERT_EQ(one.model.state.plates.size(), other.model.state.plates.size());
  for (std::size_t p = 0; p < one.model.state.plates.size(); ++p) {
    const SpherePlate &a = one.model.state.plates[p], &b = other.model.state.plates[p];
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.alive, b.alive);
    EXPECT_EQ(a.axis, b.axis);
    EXPECT_EQ(a.speed_rad_myr, b.speed_rad_myr);
  }
  const double led = agreement(one.model, other.model);
  EXPECT_GT(led, 0.8);
  // Each for itself they come to be other planets: what the test above is about.
  SphereTectonics alone(coarse.mesh, lively(), begin(coarse, lively(), 3), 3);
  SphereTectonics apart(fine.mesh, lively(), begin(fine, lively(), 3), 3);
  for (int k = 0; k < 40; ++k) {
    advance(alone);
    advance(apart);
  }
  EXPECT_LT(agreement(alone, apart), led - 0.1) << led;
}

TEST(LedPlates, HoldTheCrustThatTheLeaderHasOnThem) {
  const SampledSphere leading(8000), world(12000);
  Led led(leading, world, 40);
  while (!led.leader.budget.resampled) advance_both(led.model, led.leader);
  int same = 0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const std::int32_t there = leading.samples.nearest(world.samples.position(i));
    same += led.model.state.crust.plate[i] == led.leader.state.crust.plate[there] ? 1 : 0;
  }
  EXPECT_GT(same, 0.9 * world.mesh.size());
}

TEST(LedPlates, WeldAndOpenBasinsWhereTheLeadersDo) {
  const SampledSphere leading(8000), world(16000);
  SphereSettings settings = lively();
  settings.welding_mm_yr = 8.0;
  settings.welding_continental = 1.0;
  settings.back_arc_per_myr = 0.02;
  settings.back_arc_age_myr = 30.0;
  settings.back_arc_km = 500.0;
  SphereTectonics leader(leading.mesh, settings, begin(leading, settings, 3), 3);
  SphereTectonics model(world.mesh, settings, begin(world, settings, 3), 3);
  follow(model, leader);
  for (int k = 0; k < 50; ++k) advance_both(model, leader);
  finish_both(model, leader);
  EXPECT_GT(std::ranges::count(leader.events, SphereEvent::Kind::back_arc, &SphereEvent::kind), 3);
  std::size_t welded = 0;
  for (const PlateLife& life : leader.state.lives) welded += life.joined >= 0 ? 1 : 0;
  EXPECT_GT(welded, 3U);
  EXPECT_NEAR(model.budget.area_error, 0.0, 1e-12);
  EXPECT_GT(agreement(model, leader), 0.75);
}

TEST(LedPlates, CloseTheirBudgets) {
  const SampledSphere leading(4000), world(8000);
  const Led led(leading, world, 50);
  EXPECT_NEAR(led.model.budget.area_error, 0.0, 1e-12);
  EXPECT_NEAR((led.model.budget.continental_km3 - led.first_km3 - led.changed_km3) /
                  led.model.budget.continental_km3,
              0.0, 1e-6);
}

TEST(LedPlates, AreTheSameBitsOnAnyNumberOfThreads) {
  const SampledSphere leading(3000), world(8000);
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const Led one(leading, world, 40);
  omp_set_num_threads(4);
  const Led other(leading, world, 40);
  omp_set_num_threads(before);
  EXPECT_EQ(one.model.state.crust.plate, other.model.state.crust.plate);
  EXPECT_EQ(one.model.state.crust.elevation_m, other.model.state.crust.elevation_m);
  EXPECT_EQ(one.model.state.crust.age_myr, other.model.state.crust.age_myr);
}

TEST(Chance, BreaksPlatesAtTheirRateAndNotByTheirSamples) {
  // Plates at rest of which none is small: the first break of each of many planets.
  SphereSettings settings;
  settings.slab_pull = 0.0;
  settings.rift_per_myr = 0.02;
  settings.rift_smallest = 0.0;
  settings.initiation_per_myr = 0.0;
  settings.mean_area_km2 = 5.1e8;
  const auto first_rift_myr = [&](const SampledSphere& world, std::uint64_t seed) {
    SphereState state;
    state.crust.resize(world.mesh.size());
    state.add_plate({});
    for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
      state.crust.plate[i] = 0;
      state.crust.continental[i] = 1;
      state.crust.thickness_m[i] = 35000.0F;
    }
    SphereTectonics model(world.mesh, settings, std::move(state), seed);
    while (model.budget.rifts == 0 && model.state.time_myr < 2000.0) advance(model);
    return model.state.time_myr;
  };
  const SampledSphere coarse(600), fine(1500);
  double sum = 0.0;
  constexpr int kSeeds = 200;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const double time_myr = first_rift_myr(coarse, seed);
    sum += time_myr;
    if (seed < 20) EXPECT_EQ(time_myr, first_rift_myr(fine, seed)) << seed;
  }
  // lambda e^-lambda a step of 2 Myr, lambda 0.04; the end of the step in which it happens is told.
  const double per_step = 0.04 * std::exp(-0.04);
  const double expected_myr = 2.0 / per_step;
  EXPECT_NEAR(sum / kSeeds, expected_myr, 3.0 * expected_myr / std::sqrt(kSeeds));
}

}  // namespace
}  // namespace geo
