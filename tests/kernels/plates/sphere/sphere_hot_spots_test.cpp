// Volcanoes above plumes, and what becomes of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "geo/kernels/crust/ocean_depth.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "kernels/plates/sphere/hemispheres.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::hemispheres;
using test::kKmPerDegree;
using test::latitude_deg;
using test::longitude_deg;
using test::place;
using test::quiet;
using test::SampledSphere;

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

}  // namespace
}  // namespace geo
