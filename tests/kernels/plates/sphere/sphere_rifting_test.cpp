// Plates that break open along the fracture, wherever that lies.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geo/core/random.hpp"
#include "geo/kernels/plates/great_circle_line.hpp"
#include "geo/kernels/plates/sphere/sphere_start.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::kRadius_km;
using test::longitude_deg;
using test::SampledSphere;

constexpr double kSpeed_mm_yr = 30.0;

/// Nothing moves but what breaks.
SphereSettings still() {
  SphereSettings settings;
  settings.rift_per_myr = 0.0;
  settings.initiation_per_myr = 0.0;
  settings.slab_pull = 0.0;
  settings.no_net_rotation = false;
  settings.rift_warp_km = 0.0;
  return settings;
}

SphereState floor_of(const SampledSphere& world, int plates) {
  SphereState state;
  state.crust.resize(world.mesh.size());
  for (int p = 0; p < plates; ++p) state.add_plate({});
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const double east = longitude_deg(world.samples.position(i)) + 180.0;
    state.crust.plate[i] = static_cast<std::int16_t>(std::min(plates - 1.0, east / 360.0 * plates));
    state.crust.thickness_m[i] = 7000.0F;
    state.crust.elevation_m[i] = -5000.0F;
    state.crust.age_myr[i] = 50.0F;
  }
  return state;
}

Vector3 on_equator(double longitude_deg) {
  const double lambda = longitude_deg * std::numbers::pi / 180.0;
  return {std::cos(lambda), std::sin(lambda), 0.0};
}

/// Floor that opens in some time after a break.
template <class Break>
double opened_km2(const SampledSphere& world, SphereState state, double time_myr, Break&& breaks) {
  SphereTectonics model(world.mesh, still(), std::move(state), 1);
  breaks(model);
  while (model.state.time_myr < time_myr) advance(model);
  finish(model);
  return model.budget.created_km2;
}

TEST(SphereRifting, OpensAsFarFromThePlatesMiddleAsWithinIt) {
  const SampledSphere world(20000);
  // Plate 1 is the eastern hemisphere, its middle at 90 E; fractures along meridians.
  for (const double east : {45.0, 90.0, 140.0}) {
    const Vector3 at = on_equator(east);
    const double by_place =
        opened_km2(world, floor_of(world, 2), 16.0, [&](SphereTectonics& model) {
          const std::vector<Vector3> places{on_equator(east + 8.6), on_equator(east - 8.6)};
          rift_plate(model, plate_at(model, at), places, kSpeed_mm_yr);
        });
    const double by_line = opened_km2(world, floor_of(world, 2), 16.0, [&](SphereTectonics& model) {
      const std::vector<Vector3> line{rotated(at, scaled(on_equator(east - 90.0), 0.3)),
                                      rotated(at, scaled(on_equator(east - 90.0), -0.3))};
      rift_plate_along(model, plate_at(model, at), GreatCircleLine(line), 2, kSpeed_mm_yr);
    });
    // Both halves go at the speed: a lune.
    const double lune_km2 = 2.0 * kRadius_km * 2.0 * kSpeed_mm_yr * 16.0;
    EXPECT_NEAR(by_place, lune_km2, 0.15 * lune_km2) << east;
    EXPECT_NEAR(by_line, by_place, 0.1 * lune_km2) << east;
  }
}

TEST(SphereRifting, OpensAnywhereOnPlatesOfManySeedsByPlaceAndByLine) {
  const SampledSphere world(12000);
  constexpr double kTime_myr = 20.0;
  int seen = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SphereStart start;
    start.plates = 8;
    SphereState first = start_sphere(world.mesh, start, still(), seed);
    for (SpherePlate& plate : first.plates) plate.speed_rad_myr = 0.0;
    const RandomStream random(seed, "test.places");
    for (std::uint64_t k = 0; k < 3; ++k) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", place " + std::to_string(k));
      const Vector3 at = random.direction(2 * k);
      const Vector3 along = normalised(tangent(random.direction(2 * k + 1), at));
      const Vector3 across = cross(along, at);
      const double by_place = opened_km2(world, first, kTime_myr, [&](SphereTectonics& model) {
        const std::vector<Vector3> places{normalised(add(at, across, 0.15)),
                                          normalised(add(at, across, -0.15))};
        rift_plate(model, plate_at(model, at), places, kSpeed_mm_yr);
      });
      const double by_line = opened_km2(world, first, kTime_myr, [&](SphereTectonics& model) {
        const std::vector<Vector3> line{normalised(add(at, along, -0.1)),
                                        normalised(add(at, along, 0.1))};
        rift_plate_along(model, plate_at(model, at), GreatCircleLine(line), 2, kSpeed_mm_yr);
      });
      EXPECT_NEAR(by_place, by_line, 0.3 * by_line);
      // 1200 km across; a fracture of 2000 km at the least.
      EXPECT_GT(by_place, 0.8 * 2.0 * kSpeed_mm_yr * kTime_myr * 2000.0);
      ++seen;
    }
  }
  EXPECT_EQ(seen, 9);
}

/// A continent over the eastern hemisphere that breaks by chance in its first step, above a plume
/// or not: how far its break passes by that plume, in the frame of the planet.
double break_from_plume_km(const SampledSphere& world, double share, std::uint64_t seed) {
  const Vector3 plume = normalised(add(on_equator(70.0), Vector3{0.0, 0.0, 1.0}, 0.4));
  SphereState state = floor_of(world, 2);
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    if (state.crust.plate[i] == 1) state.crust.continental[i] = 1;
  }
  state.plumes.push_back({.place = plume});
  SphereSettings settings = still();
  settings.rift_per_myr = 0.02;
  settings.plume_rift_share = share;
  SphereTectonics model(world.mesh, settings, std::move(state), seed);
  const std::vector<std::int16_t> before = model.state.crust.plate;
  for (int step = 0; step < 40 && model.budget.rifts == 0; ++step) advance(model);
  EXPECT_GT(model.budget.rifts, 0);
  double nearest = 9.0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    for (const std::int32_t j : world.mesh.neighbours(i)) {
      if (before[i] != before[j] || model.state.crust.plate[i] == model.state.crust.plate[j]) {
        continue;
      }
      nearest = std::min(nearest, length(add(world.samples.position(i), plume, -1.0)));
    }
  }
  return kRadius_km * nearest;
}

TEST(SphereRifting, BreaksThatAPlumeLeadsMeetAboveIt) {
  const SampledSphere world(12000);
  double by_chance_km = 0.0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    EXPECT_LT(break_from_plume_km(world, 1.0, seed), 1.5 * world.samples.spacing() * kRadius_km);
    by_chance_km += break_from_plume_km(world, 0.0, seed) / 6.0;
  }
  EXPECT_GT(by_chance_km, 500.0);
}

TEST(SphereRifting, AllFragmentsLeaveEachOther) {
  const SampledSphere world(20000);
  const Vector3 at = on_equator(50.0), north{0.0, 0.0, 1.0};
  for (const int fragments : {2, 3, 4}) {
    std::vector<Vector3> places;
    for (int k = 0; k < fragments; ++k) {
      const Vector3 away = rotated(north, scaled(at, 2.0 * std::numbers::pi * k / fragments));
      places.push_back(normalised(add(at, away, 0.15)));
    }
    SphereTectonics model(world.mesh, still(), floor_of(world, 2), 1);
    rift_plate(model, 1, places, kSpeed_mm_yr);
    std::vector<int> numbers;
    for (const Vector3& place : places) numbers.push_back(plate_at(model, place));
    for (int a = 0; a < fragments; ++a) {
      for (int b = 0; b < a; ++b) {
        const Vector3 apart = normalised(add(places[a], places[b], -1.0));
        const Vector3 relative =
            cross(add(model.rotation[numbers[a]], model.rotation[numbers[b]], -1.0), at);
        EXPECT_GT(kRadius_km * dot(relative, apart), 0.9 * kSpeed_mm_yr)
            << fragments << ": " << a << ", " << b;
      }
    }
  }
}

TEST(SphereRifting, WhatAPlateCarriesGoesWithTheFragmentWhereItIs) {
  const SampledSphere world(6000);
  for (const double east : {30.0, 150.0}) {
    SphereState state = floor_of(world, 2);
    SpherePlate body;
    body.carrier = 1;
    const int number = state.add_plate(body);
    for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
      if (angle_between(world.samples.position(i), on_equator(east)) < 0.2) {
        state.crust.plate[i] = static_cast<std::int16_t>(number);
      }
    }
    SphereTectonics model(world.mesh, still(), std::move(state), 1);
    const std::vector<Vector3> places{on_equator(75.0), on_equator(105.0)};
    rift_plate(model, 1, places, kSpeed_mm_yr);
    EXPECT_EQ(model.state.root(number), plate_at(model, on_equator(east < 90.0 ? 75.0 : 105.0)))
        << east;
  }
}

TEST(SphereRifting, AMovingPlateKeepsItsMotionOnTheMean) {
  const SampledSphere world(12000);
  SphereState state = floor_of(world, 4);
  state.plates[2].axis = {0.0, 0.0, 1.0};
  state.plates[2].speed_rad_myr = 40.0 / kRadius_km;
  SphereTectonics model(world.mesh, still(), std::move(state), 1);
  const std::vector<Vector3> places{on_equator(40.0), on_equator(60.0)};
  rift_plate(model, 2, places, 20.0);
  const Vector3 sum = add(model.rotation[2], model.rotation[4]);
  EXPECT_NEAR(kRadius_km * length(add(scaled(sum, 0.5), {0.0, 0.0, 1.0}, -40.0 / kRadius_km)), 0.0,
              1e-9);
}

}  // namespace
}  // namespace geo
