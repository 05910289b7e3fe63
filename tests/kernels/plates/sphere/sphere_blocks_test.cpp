// Blocks that break off continents which other continents indent.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "kernels/plates/sphere/hemispheres.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::hemispheres;
using test::kKmPerDegree;
using test::latitude_deg;
using test::longitude_deg;
using test::quiet;
using test::SampledSphere;

SphereSettings breaking() {
  SphereSettings settings = quiet();
  settings.penetration_km = 3000.0;  // nothing collides to its end
  settings.indentation_per_myr = 0.5;
  settings.indentation_km = 1200.0;
  return settings;
}

/// Two hemispheres that close at longitude 180, with continents on both sides of that up to 60
/// degrees from the equator: the western one, whose continent is wider, stays above.
SphereState meeting(const SampledSphere& world, double relative_mm_yr) {
  SphereState state = hemispheres(world, relative_mm_yr);
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const double longitude = longitude_deg(world.samples.position(i));
    const double wide = longitude < 0.0 ? 60.0 : 40.0;
    if (std::abs(latitude_deg(world.samples.position(i))) > 60.0) continue;
    if (180.0 - std::abs(longitude) > wide) continue;
    state.crust.continental[i] = 1;
    state.crust.thickness_m[i] = 35000.0F;
    state.crust.elevation_m[i] = 300.0F;
  }
  return state;
}

std::vector<int> blocks(const SphereTectonics& model) {
  std::vector<int> found;
  for (int p = 0; p < std::ssize(model.state.plates); ++p) {
    const SpherePlate& plate = model.state.plates[p];
    if (plate.alive && plate.id >= 0 &&
        model.state.lives[plate.id].origin == PlateLife::Origin::block) {
      found.push_back(p);
    }
  }
  return found;
}

TEST(SphereBlocks, TheContinentAboveBreaksBehindTheFront) {
  const SampledSphere world(20000);
  SphereTectonics model(world.mesh, breaking(), meeting(world, 60.0), 1);
  while (blocks(model).empty() && model.state.steps < 30) advance(model);
  ASSERT_EQ(blocks(model).size(), 1U);
  const int block = blocks(model).front();
  EXPECT_EQ(model.state.lives[model.state.plates[block].id].parent, model.state.plates[0].id);
  EXPECT_EQ(model.events.back().kind, SphereEvent::Kind::indentation);
  EXPECT_EQ(model.rotation[block], model.rotation[0]);  // it moves as before at first
  const double spacing_km = test::kRadius_km * world.samples.spacing();
  double area_km2 = 0.0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    if (model.state.crust.plate[i] != block) continue;
    area_km2 += model.sample_km2();
    EXPECT_NE(model.state.crust.continental[i], 0);
    // Its edge has come closer since, by 30 mm/yr, while the front has stayed on its plate's edge.
    const double behind_km = (180.0 + longitude_deg(world.samples.position(i))) * kKmPerDegree *
                             std::cos(std::asin(world.samples.position(i)[2]));
    EXPECT_LT(behind_km, 1200.0 + 2.0 * spacing_km);
  }
  EXPECT_GT(area_km2, 1e6);
  EXPECT_LT(area_km2, 1300.0 * 3300.0);
  // What has gone below the continent stays below the block.
  advance(model);
  std::ptrdiff_t above = 0;
  for (const std::int32_t i : model.margins.contacts) {
    if (model.state.crust.plate[i] != block) continue;
    if (model.state.crust.plate[model.margins.partner[i]] != 1) continue;
    EXPECT_EQ(model.margins.hidden[i], 0);
    ++above;
  }
  EXPECT_GT(above, 5);
  EXPECT_NEAR(model.budget.area_error, 0.0, 1e-12);
}

TEST(SphereBlocks, NoneWhereContinentsMeetSlowlyOrFloorMeetsThem) {
  const SampledSphere world(20000);
  SphereState floor = meeting(world, 60.0);
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    if (floor.crust.plate[i] == 1) floor.crust.continental[i] = 0;
  }
  SphereSettings never = breaking();
  never.indentation_per_myr = 0.0;
  SphereTectonics slow(world.mesh, breaking(), meeting(world, 8.0), 1);
  SphereTectonics oceanic(world.mesh, breaking(), floor, 1);
  SphereTectonics off(world.mesh, never, meeting(world, 60.0), 1);
  for (SphereTectonics* model : {&slow, &oceanic, &off}) {
    for (int k = 0; k < 20; ++k) advance(*model);
    EXPECT_TRUE(blocks(*model).empty());
    EXPECT_FALSE(model->margins.trenches.empty());
  }
}

TEST(SphereBlocks, OneThatHasComeToRestIsPartOfItsContinentAgain) {
  const SampledSphere world(20000);
  for (const double lasts_myr : {200.0, 1.0}) {
    SphereSettings settings = breaking();
    settings.indentation_lasts_myr = lasts_myr;
    settings.welding_mm_yr = 5.0;
    settings.welding_continental = 1.0;
    SphereTectonics model(world.mesh, settings, meeting(world, 60.0), 1);
    while (blocks(model).empty() && model.state.steps < 30) advance(model);
    ASSERT_FALSE(blocks(model).empty());
    model.settings.indentation_per_myr = 1e-12;  // no more of them
    advance(model);
    finish(model);
    EXPECT_EQ(blocks(model).empty(), lasts_myr < 100.0);
  }
}

}  // namespace
}  // namespace geo
