// Plates of a sphere through time.
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "geo/kernels/crust/ocean_depth.hpp"
#include "geo/kernels/plates/great_circle_line.hpp"
#include "geo/kernels/plates/sphere/sphere_start.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::kKmPerDegree;
using test::latitude_deg;
using test::longitude_deg;
using test::SampledSphere;

Vector3 place(double latitude_deg, double longitude_deg) {
  const double phi = latitude_deg * std::numbers::pi / 180.0;
  const double lambda = longitude_deg * std::numbers::pi / 180.0;
  return {std::cos(phi) * std::cos(lambda), std::cos(phi) * std::sin(lambda), std::sin(phi)};
}
/// Two plates that part or meet along longitude 0 and half-way round, all ocean of age 50 Myr.
SphereState hemispheres(const SampledSphere& world, double relative_mm_yr) {
  SphereState state;
  state.crust.resize(world.mesh.size());
  for (const double sign : {-0.5, 0.5}) {
    SpherePlate plate;
    plate.axis = {0.0, 0.0, relative_mm_yr * sign < 0.0 ? -1.0 : 1.0};
    plate.speed_rad_myr = std::abs(sign * relative_mm_yr) / 6370.0;
    state.add_plate(plate);
  }
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    state.crust.plate[i] = longitude_deg(world.samples.position(i)) < 0.0 ? 0 : 1;
    state.crust.thickness_m[i] = 7000.0F;
    state.crust.elevation_m[i] = -5000.0F;
    state.crust.age_myr[i] = state.crust.plate[i] == 0 ? 50.0F : 60.0F;
  }
  return state;
}

SphereSettings quiet() {
  SphereSettings settings;
  settings.rift_per_myr = 0.0;
  settings.slab_pull = 0.0;
  settings.no_net_rotation = false;
  return settings;
}

TEST(SphereTectonics, OpensAnOceanWithItsRidgeInTheMiddleAndAgesToItsSides) {
  const SampledSphere world(30000);
  SphereSettings settings = quiet();
  settings.floor_by_age = true;
  // Part at longitude 0 and meet at 180: 100 mm/yr for 20 Myr opens 2000 km at the equator.
  SphereTectonics model(world.mesh, settings, hemispheres(world, 100.0), 1);
  for (int k = 0; k < 10; ++k) advance(model);
  resample(model);
  EXPECT_EQ(model.state.time_myr, 20.0);
  const SphereCrust& crust = model.state.crust;
  double worst = 0.0;
  int seen = 0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& at = world.samples.position(i);
    if (std::abs(latitude_deg(at)) > 20.0 || std::abs(longitude_deg(at)) > 7.0) continue;
    const double from_ridge_km =
        std::abs(longitude_deg(at)) * kKmPerDegree * std::cos(std::asin(at[2]));
    const double half_km = 1000.0 * std::cos(std::asin(at[2]));
    worst = std::max(worst, std::abs(crust.age_myr[i] - 20.0 * from_ridge_km / half_km));
    EXPECT_EQ(crust.plate[i], longitude_deg(at) < 0.0 ? 0 : 1) << longitude_deg(at);
    EXPECT_FLOAT_EQ(crust.elevation_m[i], static_cast<float>(-ocean_depth_m(crust.age_myr[i])));
    EXPECT_GT(std::abs(crust.ridge[i][2]), 0.9F);  // the ridge runs north
    ++seen;
  }
  EXPECT_GT(seen, 300);
  // The borders of plates are steps of samples, 140 km apart here.
  EXPECT_LT(worst, 20.0 * 180.0 / 1000.0);
}

TEST(SphereTectonics, OpensWhatTheRelativeMotionSweeps) {
  const SampledSphere world(30000);
  SphereTectonics model(world.mesh, quiet(), hemispheres(world, 100.0), 1);
  for (int k = 0; k < 10; ++k) advance(model);
  resample(model);
  // A lune of angle 2000 km / R has the area 2 R^2 angle; the steps of samples along the borders,
  // 140 km wide, open a little more.
  const double lune_km2 = 2.0 * 6370.0 * 2000.0;
  EXPECT_NEAR(model.budget.created_km2, lune_km2, 0.05 * lune_km2);
  EXPECT_NEAR(model.budget.consumed_km2, lune_km2, 0.05 * lune_km2);
  EXPECT_NEAR(model.budget.area_error, 0.0, 1e-12);
  EXPECT_NEAR(model.budget.ocean_change_km2, 0.0, 1.0);
}

TEST(SphereTectonics, OlderFloorGoesDown) {
  const SampledSphere world(20000);
  SphereTectonics model(world.mesh, quiet(), hemispheres(world, 100.0), 1);
  for (int k = 0; k < 5; ++k) advance(model);
  int below = 0, above = 0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    (model.state.crust.plate[i] == 1 ? below : above) += model.margins.hidden[i];
  }
  EXPECT_GT(below, 100);
  EXPECT_EQ(above, 0);
  for (const auto& trench : model.margins.trenches) {
    EXPECT_EQ(model.state.crust.plate[trench.sample], 0);
    EXPECT_EQ(trench.lower, 1);
  }
  EXPECT_GT(model.margins.trenches.size(), 40U);
}

TEST(SphereTectonics, RaisesTheOverridingPlateByItsLaw) {
  const SampledSphere world(30000);
  SphereSettings settings = quiet();
  settings.law.damping_mm_yr = 0.0;
  settings.accretion_width_km = 0.0;
  SphereTectonics model(world.mesh, settings, hemispheres(world, 100.0), 1);
  advance(model);
  int raised = 0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const std::int32_t k = model.margins.nearest_trench[i];
    if (k < 0) continue;
    const Vector3& at = world.samples.position(i);
    const double d_km =
        6370.0 * angle_between(at, world.samples.position(model.margins.trenches[k].sample));
    const double v = 100.0 * std::hypot(at[0], at[1]);
    // 0.6 mm/yr f g h with h = (5 / 20)^2, for 2 Myr.
    const double rise_m = 1200.0 * uplift_by_distance(d_km, 200.0, 1800.0) * v / 100.0 / 16.0;
    ASSERT_NEAR(model.state.crust.elevation_m[i], -5000.0 + rise_m, 0.01);
    raised += rise_m > 10.0;
  }
  EXPECT_GT(raised, 500);
}

/// A continent on each side, so placed that they meet at longitude 180.
SphereState two_continents(const SampledSphere& world, double gap_km, double relative_mm_yr) {
  SphereState state = hemispheres(world, relative_mm_yr);
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& at = world.samples.position(i);
    const double from_180_km = (180.0 - std::abs(longitude_deg(at))) * kKmPerDegree;
    const double wide_km = state.crust.plate[i] == 0 ? 4000.0 : 1500.0;
    if (std::abs(latitude_deg(at)) > 15.0 || from_180_km < 0.5 * gap_km ||
        from_180_km > 0.5 * gap_km + wide_km) {
      continue;
    }
    state.crust.continental[i] = 1;
    state.crust.elevation_m[i] = 300.0F;
    state.crust.thickness_m[i] = 36000.0F;
  }
  return state;
}

TEST(SphereTectonics, ContinentsCollideWhenThreeHundredKilometresHaveGoneUnder) {
  const SampledSphere world(30000);
  // 500 km apart, 100 mm/yr: they touch after 5 Myr and collide after 8, at a step of 2 Myr and
  // samples 140 km apart.
  SphereTectonics model(world.mesh, quiet(), two_continents(world, 500.0, 100.0), 1);
  while (model.events.empty() && model.state.time_myr < 20.0) advance(model);
  ASSERT_EQ(model.events.size(), 1U);
  const SphereEvent& event = model.events.front();
  EXPECT_EQ(event.kind, SphereEvent::Kind::collision);
  EXPECT_GE(event.time_myr, 8.0);
  EXPECT_LE(event.time_myr, 12.0);
  EXPECT_EQ(event.first, 1);  // the smaller one
  EXPECT_EQ(event.second, 0);
  EXPECT_NEAR(event.area_km2, 1500.0 * 30.0 * kKmPerDegree, 0.06 * event.area_km2);
  // The mountains hold what was swallowed.
  const SphereBudget& budget = model.budget;
  EXPECT_GT(budget.swallowed_km3, 300.0 * 2000.0 * 30.0);
  double high = 0.0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    if (model.state.crust.orogeny[i] == static_cast<std::int8_t>(OrogenyType::himalayan)) {
      high = std::max(high, static_cast<double>(model.state.crust.elevation_m[i]));
    }
  }
  EXPECT_GT(high, 3000.0);
}

TEST(SphereTectonics, ATerraneThatTwoPlatesReachInOneStepGoesWithTheSecond) {
  // Continents round the equator on three plates; those of the outer ones come from both sides.
  const SampledSphere world(20000);
  SphereState state;
  state.crust.resize(world.mesh.size());
  for (const double eastward_mm_yr : {80.0, 0.0, -80.0}) {
    SpherePlate plate;
    plate.axis = {0.0, 0.0, eastward_mm_yr < 0.0 ? -1.0 : 1.0};
    plate.speed_rad_myr = std::abs(eastward_mm_yr) / 6370.0;
    state.add_plate(plate);
  }
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& at = world.samples.position(i);
    const double east = longitude_deg(at);
    state.crust.plate[i] = east < -30.0 ? 0 : east < 30.0 ? 1 : 2;
    state.crust.elevation_m[i] = -5000.0F;
    state.crust.thickness_m[i] = 7000.0F;
    state.crust.age_myr[i] = 50.0F;
    if (std::abs(latitude_deg(at)) > 20.0 || std::abs(east) > 120.0) continue;
    state.crust.continental[i] = 1;
    state.crust.elevation_m[i] = 300.0F;
    state.crust.thickness_m[i] = 36000.0F;
  }
  SphereTectonics model(world.mesh, quiet(), std::move(state), 1);
  while (model.events.empty() && model.state.time_myr < 20.0) advance(model);
  ASSERT_EQ(model.events.size(), 2U);
  EXPECT_EQ(model.events[0].first, 1);
  EXPECT_EQ(model.events[1].first, 3);  // the terrane, which has left plate 1
  ASSERT_EQ(model.state.plates.size(), 4U);
  EXPECT_EQ(model.state.plates[3].carrier, model.events[1].second);
  EXPECT_NE(model.events[0].second, model.events[1].second);
}

TEST(SphereTectonics, CollisionsKeepTheVolumeOfContinents) {
  const SampledSphere world(30000);
  SphereSettings settings = quiet();
  settings.law.erosion_mm_yr = 0.0;
  settings.law.uplift_mm_yr = 0.0;
  SphereTectonics model(world.mesh, settings, two_continents(world, 500.0, 100.0), 1);
  advance(model);
  const double before = model.budget.continental_km3;
  double lost = 0.0, resampling = 0.0;
  while (model.state.time_myr < 20.0) {
    advance(model);
    lost += model.budget.lost_km3;
    resampling += model.budget.resampling_km3;
  }
  ASSERT_EQ(model.events.size(), 1U);
  EXPECT_NEAR(model.budget.continental_km3, before - lost + resampling, 1e-6 * before);
  EXPECT_NEAR(resampling, 0.0, 0.02 * before);
  EXPECT_EQ(lost, 0.0);
}

TEST(SphereTectonics, RiftsSplitAPlateIntoPartsThatPart) {
  const SampledSphere world(20000);
  SphereTectonics model(world.mesh, quiet(), hemispheres(world, 0.0), 1);
  const std::vector<Vector3> places{place(0.0, 60.0), place(0.0, 120.0)};
  rift_plate(model, 1, places, 40.0);
  ASSERT_EQ(model.state.plates.size(), 3U);
  std::array<int, 3> count{};
  for (const std::int16_t plate : model.state.crust.plate) ++count[plate];
  EXPECT_GT(count[1], 2000);
  EXPECT_GT(count[2], 2000);
  EXPECT_NEAR(count[1] + count[2], 10000, 30);
  // One moves west, the other east, at the speed that was asked for.
  const Vector3 west = cross(model.rotation[1], places[0]),
                east = cross(model.rotation[2], places[1]);
  const Vector3 eastward{-1.0, 0.0, 0.0};  // at longitude 90
  EXPECT_LT(dot(west, eastward), 0.0);
  EXPECT_GT(dot(east, eastward), 0.0);
  EXPECT_NEAR(6370.0 * length(model.rotation[1]), 40.0, 1e-9);
}

TEST(SphereTectonics, SlabPullBringsAPlateToItsFront) {
  const SampledSphere world(20000);
  SphereSettings settings = quiet();
  settings.slab_pull = 0.02;
  // Both plates turn about the axis; plate 1 subducts at longitude 180, north and south alike, so
  // its axis keeps; one trench alone, north of the equator, would tilt it.
  SphereTectonics model(world.mesh, settings, hemispheres(world, 100.0), 1);
  for (int k = 0; k < 5; ++k) advance(model);
  EXPECT_LT(length(add(model.state.plates[1].axis, {0.0, 0.0, 1.0}, -1.0)), 0.01);
  EXPECT_EQ(model.state.plates[0].axis, (Vector3{0.0, 0.0, -1.0}));
}

/// A plume below plate 1, which has gone 1200 km east of it in 24 Myr.
SphereTectonics chain_of_volcanoes(const SampledSphere& world, std::uint64_t seed) {
  SphereSettings settings = quiet();
  settings.law.damping_mm_yr = 0.0;
  settings.least_steps = 60;
  settings.plume_top_km = 10.0;
  settings.island_wear_myr = 0.0;
  SphereState state = hemispheres(world, 100.0);
  state.plumes = {{.place = place(10.0, 60.0), .growth_mm_yr = 1.0}};
  SphereTectonics model(world.mesh, settings, std::move(state), seed);
  for (int k = 0; k < 12; ++k) advance(model);
  return model;
}

TEST(SphereTectonics, APlumeLeavesAChainOfSeparateVolcanoes) {
  const SampledSphere world(400000);  // 36 km apart
  const SphereTectonics model = chain_of_volcanoes(world, 1);
  const SphereCrust& crust = model.state.crust;
  const Matrix3 frame = model.state.plates[1].turn.matrix();
  double built_km3 = 0.0;
  std::vector<double> summits_km;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3 at = times(frame, world.samples.position(i));
    if (crust.plate[i] != 1 || std::abs(longitude_deg(at) - 65.0) > 20.0) continue;
    if (std::abs(latitude_deg(at) - 10.0) > 10.0) continue;
    const double high_m = crust.elevation_m[i] + 5000.0;
    EXPECT_NEAR(crust.thickness_m[i] - 7000.0, high_m, 0.01);
    built_km3 += 1e-3 * high_m * world.samples.area_sr() * 6370.0 * 6370.0;
    if (high_m < 800.0) continue;
    EXPECT_NEAR(latitude_deg(at), 10.0, 1.5);
    bool is_summit = true;
    for (const std::int32_t j : world.mesh.neighbours(i)) {
      is_summit = is_summit && crust.elevation_m[j] < crust.elevation_m[i];
    }
    const double along_km =
        (longitude_deg(at) - 60.0) * kKmPerDegree * std::cos(10.0 * std::numbers::pi / 180.0);
    if (is_summit) summits_km.push_back(along_km);
  }
  // What the one mound would hold that grows by 1 mm/yr and halves at 60 km: pi 60^2 / ln 2.
  const double output_km3 = 24.0 * std::numbers::pi * 3600.0 / std::numbers::ln2;
  EXPECT_NEAR(built_km3, output_km3, 1e-3 * output_km3);
  // 50 mm/yr on the equator. One volcano for each 100 km of way, as far as samples part them.
  const double way_km = 24.0 * 50.0 * std::cos(10.0 * std::numbers::pi / 180.0);
  EXPECT_GE(std::ssize(summits_km), 8);
  EXPECT_LE(std::ssize(summits_km), 16);
  const auto [low, high] = std::minmax_element(summits_km.begin(), summits_km.end());
  EXPECT_NEAR(*low, 0.0, 120.0);
  EXPECT_NEAR(*high, way_km, 120.0);
  // Another seed has other volcanoes.
  EXPECT_NE(chain_of_volcanoes(world, 2).state.crust.elevation_m, crust.elevation_m);
}

TEST(SphereTectonics, IslandsSinkWithTheirFloorWearDownAndSwellsDecay) {
  const SampledSphere world(2000);
  SphereSettings settings = quiet();
  settings.floor_by_age = true;
  settings.least_steps = 60;
  SphereState state = hemispheres(world, 0.0);
  enum { kPlain = 500, kSeamount = 700, kSwell = 900, kIsland = 1100 };
  SphereCrust& crust = state.crust;
  for (float& age : crust.age_myr) age = 30.0F;
  for (float& z : crust.elevation_m) z = static_cast<float>(-ocean_depth_m(30.0));
  const auto lift = [&](std::int32_t i, float lava_m, float swell_m) {
    crust.elevation_m[i] += lava_m + swell_m;
    crust.thickness_m[i] += lava_m;
  };
  lift(kSeamount, 3000.0F, 0.0F);
  lift(kSwell, 0.0F, 1000.0F);
  lift(kIsland, 6000.0F, 0.0F);
  const double island_m = crust.elevation_m[kIsland];
  ASSERT_GT(island_m, 1000.0);
  SphereTectonics model(world.mesh, settings, std::move(state), 1);
  for (int k = 0; k < 15; ++k) advance(model);
  const auto& z = model.state.crust.elevation_m;
  EXPECT_NEAR(z[kPlain], -ocean_depth_m(60.0), 0.1);
  EXPECT_NEAR(z[kSeamount] - z[kPlain], 3000.0, 0.1);
  EXPECT_NEAR(z[kSwell] - z[kPlain], 1000.0 * std::exp(-30.0 / settings.swell_decay_myr), 1.0);
  // Sinking floor alone would leave it 800 m high.
  const double sunk_m = ocean_depth_m(60.0) - ocean_depth_m(30.0);
  EXPECT_LT(z[kIsland], 0.2 * (island_m - sunk_m));
  EXPECT_GT(z[kIsland], -sunk_m);
}

TEST(SphereTectonics, RiftsAlongALineToBothSidesOfIt) {
  const SampledSphere world(20000);
  SphereTectonics model(world.mesh, quiet(), hemispheres(world, 0.0), 1);
  // Northwards along 90 E, then north-east from 30 N.
  const std::vector<Vector3> line{place(-30.0, 90.0), place(30.0, 90.0), place(50.0, 120.0)};
  rift_plate_along(model, 1, GreatCircleLine(line), 2, 30.0);
  ASSERT_EQ(model.state.plates.size(), 3U);
  const auto plate_of = [&](double latitude, double longitude) {
    return model.state.crust.plate[world.samples.nearest(place(latitude, longitude))];
  };
  for (double latitude = -60.0; latitude <= 30.0; latitude += 5.0) {
    EXPECT_EQ(plate_of(latitude, 87.0), 1) << latitude;
    EXPECT_EQ(plate_of(latitude, 93.0), 2) << latitude;
  }
  for (const double along : {0.2, 0.5, 0.8, 1.3}) {
    const Vector3 turn = normalised(cross(line[1], line[2]));
    const Vector3 on = rotated(line[1], scaled(turn, along * angle_between(line[1], line[2])));
    EXPECT_EQ(
        model.state.crust.plate[world.samples.nearest(rotated(on, scaled(cross(turn, on), -0.05)))],
        1)
        << along;
    EXPECT_EQ(
        model.state.crust.plate[world.samples.nearest(rotated(on, scaled(cross(turn, on), 0.05)))],
        2)
        << along;
  }
  EXPECT_EQ(plate_of(0.0, -90.0), 0);
  // They part at twice the speed, across the line.
  const Vector3 middle = place(10.0, 90.0);
  const Vector3 parting =
      scaled(cross(add(model.rotation[2], model.rotation[1], -1.0), middle), 6370.0);
  EXPECT_GT(dot(parting, Vector3{-1.0, 0.0, 0.0}), 45.0);  // eastwards
  EXPECT_LT(length(parting), 60.1);
  EXPECT_EQ(model.budget.rifts, 1);
}

TEST(SphereTectonics, ALineCutsThreeAndFourFragments) {
  const SampledSphere world(20000);
  const std::vector<Vector3> line{place(-30.0, 90.0), place(30.0, 90.0)};
  for (const int fragments : {3, 4}) {
    SphereTectonics model(world.mesh, quiet(), hemispheres(world, 0.0), 1);
    rift_plate_along(model, 1, GreatCircleLine(line), fragments, 30.0);
    const auto plate_of = [&](double latitude, double longitude) {
      return model.state.crust.plate[world.samples.nearest(place(latitude, longitude))];
    };
    EXPECT_EQ(plate_of(-20.0, 60.0), 1);
    EXPECT_EQ(plate_of(-20.0, 120.0), 2);
    EXPECT_EQ(plate_of(20.0, 120.0), 3);
    EXPECT_EQ(plate_of(20.0, 60.0), fragments == 4 ? 4 : 1);
    EXPECT_NEAR(model.partition.cap(3).samples, 5000 / 2, 100);
  }
}

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

TEST(SphereTectonics, TakesTheNetRotationAway) {
  const SampledSphere world(5000);
  SphereSettings settings;
  settings.rift_per_myr = 0.0;
  settings.slab_pull = 0.0;
  SphereTectonics model(world.mesh, settings, start_sphere(world.mesh, {}, settings, 3), 3);
  for (int k = 0; k < 4; ++k) advance(model);
  resample(model);
  const auto plate = model.state.crust.plate;  // they fill the sphere
  advance(model);
  Vector3 sum{};
  double speeds = 0.0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& r = world.samples.position(i);
    const Vector3 v = cross(model.rotation[plate[i]], r);
    sum = add(sum, cross(r, v));
    speeds += length(v);
  }
  EXPECT_GT(speeds * 6370.0 / world.mesh.size(), 10.0);  // mm/yr
  EXPECT_LT(6370.0 * length(sum) / world.mesh.size(), 1e-12);
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

TEST(SphereTectonics, IslandArcsStandOneToFourHundredKilometresBehindTheirTrench) {
  const SampledSphere world(60000);
  SphereSettings settings = quiet();
  settings.floor_by_age = true;
  settings.arc_reach_km = 600.0;
  settings.elevation_weight = 0.7;
  settings.most_steps = settings.least_steps = 1000;
  SphereTectonics model(world.mesh, settings, hemispheres(world, 100.0), 1);
  int arcs = 0;
  for (int k = 0; k < 40 && arcs < 40; ++k) {
    advance(model);
    const SphereCrust& crust = model.state.crust;
    arcs = 0;
    for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
      if (crust.continental[i] == 0) continue;
      ++arcs;
      // On the plate that stays up, the younger one.
      ASSERT_EQ(crust.plate[i], 0);
      const std::int32_t trench = model.margins.nearest_trench[i];
      ASSERT_GE(trench, 0);
      const double far_km =
          6370.0 * angle_between(world.samples.position(i),
                                 world.samples.position(model.margins.trenches[trench].sample));
      EXPECT_GE(far_km, 100.0);
      EXPECT_LE(far_km, 400.0);
    }
  }
  EXPECT_GE(arcs, 40);
}

TEST(SphereTectonics, CordillerasRiseBehindTheTrenchesOfAWholePlanet) {
  const SampledSphere world(40000);
  SphereSettings settings;
  settings.floor_by_age = true;
  settings.law.erosion_mm_yr = 0.24;
  settings.arc_reach_km = 600.0;
  settings.elevation_weight = 0.7;
  SphereStart start;
  start.continental_share = 0.38;
  SphereTectonics model(world.mesh, settings, start_sphere(world.mesh, start, settings, 3), 3);
  // Mean height of continental ground beside active trenches, by distance.
  constexpr int kBins = 10;
  constexpr double kBin_km = 100.0;  // as far as samples are apart
  std::vector<double> sum(kBins, 0.0), count(kBins, 0.0);
  for (int k = 0; k < 60; ++k) {
    advance(model);
    if (k < 20) continue;
    const SphereCrust& crust = model.state.crust;
    for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
      const std::int32_t trench = model.margins.nearest_trench[i];
      if (trench < 0 || crust.continental[i] == 0 || crust.plate[i] < 0) continue;
      EXPECT_EQ(model.margins.hidden[i], 0);  // the side that stays up
      if (crust.orogeny[i] == static_cast<std::int8_t>(OrogenyType::himalayan)) continue;
      const double far_km =
          6370.0 * angle_between(world.samples.position(i),
                                 world.samples.position(model.margins.trenches[trench].sample));
      const int bin = static_cast<int>(far_km / kBin_km);
      if (bin >= kBins) continue;
      sum[bin] += crust.elevation_m[i];
      count[bin] += 1.0;
    }
  }
  double highest_m = -1e9, highest_km = 0.0;
  for (int bin = 0; bin < kBins; ++bin) {
    ASSERT_GT(count[bin], 100.0) << bin;
    if (sum[bin] / count[bin] > highest_m) {
      highest_m = sum[bin] / count[bin];
      highest_km = (bin + 0.5) * kBin_km;
    }
  }
  EXPECT_GE(highest_km, 100.0);
  EXPECT_LE(highest_km, 400.0);
  EXPECT_GT(highest_m, sum[0] / count[0] + 200.0);
  EXPECT_GT(highest_m, sum[kBins - 1] / count[kBins - 1] + 200.0);
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
      change_km3 += b.raised_km3 - b.eroded_km3 + b.deposited_km3 + b.emerged_km3 + b.changed_km3 -
                    b.lost_km3 + b.resampling_km3;
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
