// Old floor that breaks off at a passive margin.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::latitude_deg;
using test::longitude_deg;
using test::SampledSphere;

SphereSettings settings() {
  SphereSettings s;
  s.rift_per_myr = 0.0;
  s.slab_pull = 0.0;
  s.no_net_rotation = false;
  s.floor_by_age = true;
  s.least_steps = s.most_steps = 1000;
  s.initiation_per_myr = 1e3;  // whatever is old enough does
  return s;
}

/// Two hemispheres at rest. In the middle of the eastern one a continent of 40 by 40 degrees; floor
/// east of it is old.
SphereState beginning(const SampledSphere& world, float old_myr) {
  SphereState state;
  state.crust.resize(world.mesh.size());
  state.add_plate({});
  state.add_plate({});
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& at = world.samples.position(i);
    const double lon = longitude_deg(at), lat = latitude_deg(at);
    const bool land = std::abs(lon - 90.0) < 20.0 && std::abs(lat) < 20.0;
    state.crust.plate[i] = lon < 0.0 ? 0 : 1;
    state.crust.continental[i] = land ? 1 : 0;
    state.crust.thickness_m[i] = land ? 36000.0F : 7000.0F;
    state.crust.elevation_m[i] = land ? 500.0F : -5000.0F;
    state.crust.age_myr[i] = lon > 110.0 && std::abs(lat) < 20.0 ? old_myr : 40.0F;
  }
  return state;
}

TEST(SubductionInitiation, OldFloorBreaksOffAlongItsMarginAndSubductsBelowTheContinent) {
  const SampledSphere world(20000);
  SphereTectonics model(world.mesh, settings(), beginning(world, 130.0F), 1);
  advance(model);
  EXPECT_EQ(model.budget.subduction_initiations, 1);
  EXPECT_EQ(model.budget.rifts, 0);
  ASSERT_EQ(model.events.size(), 1U);
  EXPECT_EQ(model.events[0].kind, SphereEvent::Kind::subduction_initiation);
  EXPECT_NEAR(longitude_deg(model.events[0].place), 110.0, 3.0);
  ASSERT_EQ(model.state.plates.size(), 3U);
  const SphereCrust& crust = model.state.crust;
  int sinking = 0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& at = world.samples.position(i);
    if (crust.continental[i] != 0) {
      EXPECT_EQ(crust.plate[i], 1);
    }
    if (crust.plate[i] != 2) continue;
    ++sinking;
    EXPECT_GT(longitude_deg(at), 105.0);
  }
  // From the margin to longitude 180, 40 degrees and more wide.
  EXPECT_GT(sinking, 20000 * 70 * 40 / 41253 / 2);
  // The rest stays as it was; the new plate goes west, and soon below the continent.
  EXPECT_EQ(model.state.plates[1].speed_rad_myr, 0.0);
  const Vector3 at_margin{std::cos(2.0), std::sin(2.0), 0.0},
      west{std::sin(2.0), -std::cos(2.0), 0.0};
  EXPECT_NEAR(6370.0 * dot(cross(model.rotation[2], at_margin), west), 50.0, 5.0);
  for (int k = 0; k < 10; ++k) advance(model);
  const auto subducts = [&](const TrenchSample& trench) {
    return trench.lower == 2 && crust.plate[trench.sample] == 1 &&
           crust.continental[trench.sample] != 0;
  };
  EXPECT_GT(std::count_if(model.margins.trenches.begin(), model.margins.trenches.end(), subducts),
            10);
}

TEST(SubductionInitiation, NeedsOldFloorARateAndAPlateThatIsFree) {
  const SampledSphere world(20000);
  const auto subduction_initiations = [&](const SphereSettings& s, float old_myr, bool is_held) {
    SphereState state = beginning(world, old_myr);
    state.plates[1].is_held = is_held;
    SphereTectonics model(world.mesh, s, std::move(state), 1);
    advance(model);
    return model.budget.subduction_initiations;
  };
  EXPECT_EQ(subduction_initiations(settings(), 100.0F, false), 0);
  EXPECT_EQ(subduction_initiations(settings(), 130.0F, true), 0);
  SphereSettings never = settings();
  never.initiation_per_myr = 0.0;
  EXPECT_EQ(subduction_initiations(never, 130.0F, false), 0);
  EXPECT_EQ(subduction_initiations(settings(), 130.0F, false), 1);
  // Floor of a sea subducts also where plates of its size would not stay.
  SphereSettings large_plates = settings();
  large_plates.smallest_piece_km2 = 1e8;
  EXPECT_EQ(subduction_initiations(large_plates, 130.0F, false), 1);
}

TEST(SubductionInitiation, LeavesASeaOfLessThanAMillionSquareKilometres) {
  const SampledSphere world(20000);
  SphereSettings s = settings();
  s.smallest_piece_km2 = 1e8;
  // Old floor in the midst of the continent: 0.6 and 2.4 million km2, and young floor all around
  // it.
  for (const auto& [half_deg, subduction_initiations] : {std::pair{3.5, 0}, std::pair{7.0, 1}}) {
    SphereState state = beginning(world, 40.0F);
    for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
      const Vector3& at = world.samples.position(i);
      if (std::abs(longitude_deg(at) - 90.0) > half_deg) continue;
      if (std::abs(latitude_deg(at)) > half_deg) continue;
      state.crust.continental[i] = 0;
      state.crust.thickness_m[i] = 7000.0F;
      state.crust.elevation_m[i] = -5000.0F;
      state.crust.age_myr[i] = 130.0F;
    }
    SphereTectonics model(world.mesh, s, std::move(state), 1);
    advance(model);
    EXPECT_EQ(model.budget.subduction_initiations, subduction_initiations) << half_deg;
  }
}

TEST(SubductionInitiation, IsAsLikelyAsItsMarginIsLong) {
  const SampledSphere world(20000);
  SphereSettings s = settings();
  // 40 degrees of margin are 4400 km: 0.44 per step of 2 Myr.
  s.initiation_per_myr = 0.05;
  int count = 0;
  constexpr int kTries = 120;
  for (int seed = 0; seed < kTries; ++seed) {
    SphereTectonics model(world.mesh, s, beginning(world, 130.0F),
                          static_cast<std::uint64_t>(seed));
    advance(model);
    count += model.budget.subduction_initiations;
  }
  const double chance = -std::expm1(-0.44);
  EXPECT_NEAR(count, kTries * chance, 4.0 * std::sqrt(kTries * chance * (1.0 - chance)));
}

}  // namespace
}  // namespace geo
