// Rules of Driftworld, each in a world made for it.
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "geo/kernels/plates/sphere/sphere_start.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "kernels/plates/sphere/hemispheres.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::kKmPerDegree;
using test::kRadius_km;
using test::latitude_deg;
using test::longitude_deg;
using test::quiet;
using test::SampledSphere;

/// Plates between meridians, each with its speed eastwards and the age of its floor.
struct Slice {
  double from_deg, eastward_mm_yr;
  float age_myr;
};
SphereState slices(const SampledSphere& world, const std::vector<Slice>& plates) {
  SphereState state;
  state.crust.resize(world.mesh.size());
  for (const Slice& slice : plates) {
    SpherePlate plate;
    plate.axis = {0.0, 0.0, slice.eastward_mm_yr < 0.0 ? -1.0 : 1.0};
    plate.speed_rad_myr = std::abs(slice.eastward_mm_yr) / kRadius_km;
    state.add_plate(plate);
  }
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const double east = longitude_deg(world.samples.position(i));
    std::size_t own = plates.size() - 1;
    for (std::size_t p = 0; p < plates.size(); ++p) {
      if (east >= plates[p].from_deg) own = p;
    }
    state.crust.plate[i] = static_cast<std::int16_t>(own);
    state.crust.age_myr[i] = plates[own].age_myr;
    state.crust.thickness_m[i] = 7000.0F;
    state.crust.elevation_m[i] = -5000.0F;
  }
  return state;
}

void add_land(const SampledSphere& world, SphereState& state,
              const std::function<bool(double, double)>& holds) {
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& at = world.samples.position(i);
    if (!holds(latitude_deg(at), longitude_deg(at))) continue;
    state.crust.continental[i] = 1;
    state.crust.elevation_m[i] = 300.0F;
    state.crust.thickness_m[i] = 36000.0F;
  }
}

/// Samples of a plate that lie below another one.
int hidden_of(const SphereTectonics& model, int plate, bool land) {
  int count = 0;
  for (std::int32_t i = 0; i < model.mesh->size(); ++i) {
    count += model.margins.hidden[i] != 0 && model.state.crust.plate[i] == plate &&
             (model.state.crust.continental[i] != 0) == land;
  }
  return count;
}

// The west moves eastwards and meets the east at longitude 0 and nowhere else: half-way round they
// part.
const std::vector<Slice> kMeeting{{-180.0, 50.0, 40.0F}, {0.0, -50.0, 80.0F}};

TEST(Driftworld, ThePlateWithMoreContinentStaysUpWhateverTheAgeOfItsFloor) {
  const SampledSphere world(20000);
  // A continent in the middle of the east, whose floor is the older one; an island of the west
  // where the two meet.
  SphereState state = slices(world, kMeeting);
  add_land(world, state, [](double lat, double lon) {
    return (std::abs(lat) < 30.0 && lon > 70.0 && lon < 110.0) ||
           (std::abs(lat) < 6.0 && lon > -8.0 && lon < 0.0);
  });
  for (const bool by_score : {false, true}) {
    SCOPED_TRACE(by_score);
    SphereSettings settings = quiet();
    settings.rank_by_score = by_score;
    SphereTectonics model(world.mesh, settings, state, 1);
    for (int k = 0; k < 3; ++k) advance(model);
    if (by_score) {
      EXPECT_GT(hidden_of(model, 0, false), 50);
      EXPECT_GT(hidden_of(model, 0, true), 3);  // the island as well
      EXPECT_EQ(hidden_of(model, 1, false), 0);
    } else {
      EXPECT_EQ(hidden_of(model, 0, false), 0);
      EXPECT_EQ(hidden_of(model, 0, true), 0);
      EXPECT_GT(hidden_of(model, 1, false), 50);
    }
    EXPECT_EQ(hidden_of(model, 1, true), 0);
  }
}

TEST(Driftworld, AScoreIsAHundredForEachSampleOfContinentLessOneForEachOfFloor) {
  const SampledSphere world(5000);
  SphereState state = slices(world, kMeeting);
  add_land(world, state, [](double lat, double lon) { return lat > 30.0 && lon > 0.0; });
  const SphereTectonics model(world.mesh, quiet(), state, 1);
  for (const int plate : {0, 1}) {
    int land = 0, floor = 0;
    for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
      if (state.crust.plate[i] == plate) ++(state.crust.continental[i] != 0 ? land : floor);
    }
    EXPECT_EQ(model.score[plate], 100.0 * land - floor);
  }
}

TEST(Driftworld, WhatGoesBelowFloorIsCountedAsLost) {
  const SampledSphere world(20000);
  SphereState state = slices(world, kMeeting);
  add_land(world, state, [](double lat, double lon) {
    return (std::abs(lat) < 30.0 && lon > 70.0 && lon < 110.0) ||
           (std::abs(lat) < 6.0 && lon > -8.0 && lon < 0.0);
  });
  SphereSettings settings = quiet();
  settings.rank_by_score = true;
  settings.law.erosion_mm_yr = settings.law.uplift_mm_yr = 0.0;
  settings.margin_km = 0.0;
  settings.least_steps = settings.most_steps = 1000;
  SphereTectonics model(world.mesh, settings, state, 1);
  for (int k = 0; k < 20; ++k) advance(model);
  resample(model);
  const double island_km3 = 36.0 * 8.0 * 12.0 * kKmPerDegree * kKmPerDegree;
  EXPECT_NEAR(model.budget.lost_km3, island_km3, 0.15 * island_km3);  // 70 samples
  EXPECT_LT(std::abs(model.budget.resampling_km3), 0.1 * island_km3);
}

TEST(Driftworld, PlatesBecomeOneAsSoonAsTheirContinentsTouch) {
  const SampledSphere world(30000);
  SphereState state = slices(world, kMeeting);
  // 500 km apart: at 100 mm/yr they touch after 5 Myr. Most of both plates is ocean.
  const double half_gap_deg = 250.0 / kKmPerDegree;
  add_land(world, state, [&](double lat, double lon) {
    return std::abs(lat) < 15.0 && std::abs(lon) > half_gap_deg && lon < half_gap_deg + 14.0 &&
           lon > -half_gap_deg - 30.0;
  });
  for (const bool merges : {false, true}) {
    SCOPED_TRACE(merges);
    SphereSettings settings = quiet();
    settings.merge_plates = merges;
    SphereTectonics model(world.mesh, settings, state, 1);
    while (model.events.empty() && model.state.time_myr < 20.0) advance(model);
    ASSERT_EQ(model.events.size(), 1U);
    EXPECT_GE(model.events[0].time_myr, merges ? 6.0 : 8.0);
    EXPECT_LE(model.events[0].time_myr, merges ? 8.0 : 12.0);
    EXPECT_EQ(model.state.root(1), merges ? 0 : 1);
    EXPECT_EQ(model.state.plates.size(), merges ? 2U : 3U);
    resample(model);
    EXPECT_EQ(model.budget.plates, merges ? 1 : 2);
  }
}

TEST(Driftworld, UpliftsOfAllSubductingPlatesAddUp) {
  const SampledSphere world(40000);
  // The middle plate, 1800 km wide, is the youngest; both neighbours subduct below it.
  SphereState state =
      slices(world, {{-180.0, 90.0, 90.0F}, {-8.0, 0.0, 10.0F}, {8.0, -70.0, 80.0F}});
  SphereSettings settings = quiet();
  settings.add_uplifts = true;
  settings.law.damping_mm_yr = 0.0;
  settings.accretion_width_km = 0.0;
  SphereTectonics model(world.mesh, settings, state, 1);
  advance(model);
  int both = 0;
  for (std::int32_t i = 0; i < world.mesh.size(); i += 3) {
    const Vector3& at = world.samples.position(i);
    if (state.crust.plate[i] != 1 || std::abs(latitude_deg(at)) > 50.0) continue;
    double rise_m = 0.0;
    int sources = 0;
    for (const int lower : {0, 2}) {
      double nearest_km = 1e9;
      for (const auto& trench : model.margins.trenches) {
        if (trench.lower != lower) continue;
        nearest_km = std::min(
            nearest_km, kRadius_km * angle_between(at, world.samples.position(trench.sample)));
      }
      // 0.6 mm/yr f g h with g = v / 100 and h = (5 / 20)^2, for 2 Myr.
      const double speed = (lower == 0 ? 90.0 : 70.0) * std::hypot(at[0], at[1]);
      const double part_m =
          1200.0 * uplift_by_distance(nearest_km, 200.0, 1800.0) * speed / 100.0 / 16.0;
      rise_m += part_m;
      sources += part_m > 0.1;
    }
    // Trenches are handed from sample to sample, so that now and then a neighbour's is taken.
    ASSERT_NEAR(model.state.crust.elevation_m[i], -5000.0 + rise_m, 0.1 + 0.03 * rise_m);
    both += sources == 2;
  }
  EXPECT_GT(both, 100);
}

TEST(Driftworld, SedimentPilesOnAllDeepFloor) {
  const SampledSphere world(5000);
  SphereState state = slices(world, {{-180.0, 0.0, 50.0F}, {0.0, 0.0, 50.0F}});
  state.crust.elevation_m[7] = -3500.0F;
  state.crust.elevation_m[8] = -4100.0F;
  SphereSettings settings = quiet();
  settings.law.damping_mm_yr = 0.0;
  settings.fill_abyss = true;
  settings.accretion_top_km = -4.0;
  SphereTectonics model(world.mesh, settings, std::move(state), 1);
  advance(model);
  EXPECT_EQ(model.state.crust.elevation_m[7], -3500.0F);
  EXPECT_EQ(model.state.crust.elevation_m[8], -4000.0F);
  EXPECT_NEAR(model.state.crust.elevation_m[9], -4400.0F, 1e-3);  // 0.3 mm/yr for 2 Myr
  const double sample_km2 = 4.0 * std::numbers::pi * kRadius_km * kRadius_km / 5000.0;
  EXPECT_NEAR(model.budget.accreted_km3, sample_km2 * (4998 * 0.6 + 0.1), 1e-3 * sample_km2);
}

TEST(Driftworld, OnlyTheLargestPlateRiftsAndIntoTwo) {
  const SampledSphere world(8000);
  const SphereState state = slices(
      world, {{-180.0, 0.0, 50.0F}, {-60.0, 0.0, 50.0F}, {-10.0, 0.0, 50.0F}, {140.0, 0.0, 50.0F}});
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SphereSettings settings = quiet();
    settings.rift_largest = true;
    settings.rift_per_myr = 0.1;
    SphereTectonics model(world.mesh, settings, state, seed);
    while (model.events.empty() && model.state.time_myr < 200.0) advance(model);
    ASSERT_EQ(model.events.size(), 1U);
    EXPECT_EQ(model.events[0].first, 2);
    EXPECT_EQ(model.state.plates.size(), 5U);
  }
}

TEST(Driftworld, AllItsRulesTogetherGiveTheSameBitsOnAnyNumberOfThreads) {
  const SampledSphere world(8000);
  SphereSettings settings;
  settings.driftworld_uplift = settings.rank_by_score = settings.merge_plates = true;
  settings.add_uplifts = settings.fill_abyss = settings.rift_largest = true;
  settings.rift_per_myr = 0.1;
  settings.accretion_top_km = -4.0;
  const int threads = omp_get_max_threads();
  std::vector<std::vector<float>> ends;
  for (const int number : {1, 2, 4}) {
    omp_set_num_threads(number);
    SphereTectonics model(world.mesh, settings, start_sphere(world.mesh, {}, settings, 5), 5);
    for (int k = 0; k < 30; ++k) advance(model);
    ends.push_back(model.state.crust.elevation_m);
  }
  omp_set_num_threads(threads);
  EXPECT_EQ(ends[0], ends[1]);
  EXPECT_EQ(ends[0], ends[2]);
}

}  // namespace
}  // namespace geo
