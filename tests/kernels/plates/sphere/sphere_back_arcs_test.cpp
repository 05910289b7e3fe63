// Arcs that follow their trenches, and the basins that open behind them.
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
using test::kRadius_km;
using test::quiet;
using test::SampledSphere;

SphereSettings retreating() {
  SphereSettings settings = quiet();
  settings.back_arc_per_myr = 0.5;
  settings.back_arc_mm_yr = 40.0;
  settings.back_arc_km = 500.0;
  return settings;
}

/// The eastern hemisphere, of old floor, goes below the western one at longitude 180. That one
/// moves away from the trench, or towards it.
SphereState closing(const SampledSphere& world, float age_myr, double west_mm_yr) {
  SphereState state = hemispheres(world, west_mm_yr, 60.0);
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    if (state.crust.plate[i] == 1) state.crust.age_myr[i] = age_myr;
  }
  return state;
}

std::vector<int> arcs(const SphereTectonics& model) {
  std::vector<int> found;
  for (int p = 0; p < std::ssize(model.state.plates); ++p) {
    const SpherePlate& plate = model.state.plates[p];
    if (plate.alive && plate.id >= 0 &&
        model.state.lives[plate.id].origin == PlateLife::Origin::back_arc) {
      found.push_back(p);
    }
  }
  return found;
}

TEST(SphereBackArcs, AnArcAboveOldFloorFollowsItsTrench) {
  const SampledSphere world(20000);
  SphereTectonics model(world.mesh, retreating(), closing(world, 100.0F, 10.0), 1);
  while (arcs(model).empty() && model.state.steps < 30) advance(model);
  const std::vector<int> found = arcs(model);
  ASSERT_FALSE(found.empty());
  const int arc = found.front();
  EXPECT_EQ(model.state.lives[model.state.plates[arc].id].parent, model.state.plates[0].id);
  EXPECT_EQ(model.events.back().kind, SphereEvent::Kind::back_arc);
  // Of the western plate, at its edge; it leaves that plate towards the trench, to the west, at
  // 40 mm/yr.
  const Vector3 opening = add(model.rotation[arc], model.rotation[0], -1.0);
  EXPECT_NEAR(length(opening) * kRadius_km, 40.0, 1e-9);
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    if (model.state.crust.plate[i] != arc) continue;
    const Vector3 at = times(model.frame[arc], world.samples.position(i));
    EXPECT_LT(test::longitude_deg(at), -165.0);
    const Vector3 west{at[1], -at[0], 0.0};
    EXPECT_GT(dot(cross(opening, at), west), 0.0);
  }
}

TEST(SphereBackArcs, NeitherAboveYoungFloorNorWhereThePlateAdvances) {
  const SampledSphere world(20000);
  SphereTectonics young(world.mesh, retreating(), closing(world, 30.0F, 10.0), 1);
  SphereTectonics advancing(world.mesh, retreating(), closing(world, 100.0F, -30.0), 1);
  SphereSettings never = retreating();
  never.back_arc_per_myr = 0.0;
  SphereTectonics off(world.mesh, never, closing(world, 100.0F, 10.0), 1);
  for (SphereTectonics* model : {&young, &advancing, &off}) {
    for (int k = 0; k < 10; ++k) advance(*model);  // until the young floor is 50 Myr old
    EXPECT_TRUE(arcs(*model).empty());
    EXPECT_FALSE(model->margins.trenches.empty());
  }
}

TEST(SphereBackArcs, NewFloorFillsTheBasinBehindThem) {
  const SampledSphere world(20000);
  SphereSettings settings = retreating();
  SphereTectonics model(world.mesh, settings, closing(world, 100.0F, 10.0), 1);
  while (arcs(model).empty() && model.state.steps < 30) advance(model);
  ASSERT_FALSE(arcs(model).empty());
  model.settings.back_arc_per_myr = 1e-12;  // no more of them
  for (int k = 0; k < 8; ++k) advance(model);
  finish(model);
  // 8 steps of 2 Myr at 40 mm/yr open 640 km; behind the trench that is young floor, far from the
  // ridge at longitude 0.
  double young_km2 = 0.0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const double longitude = test::longitude_deg(world.samples.position(i));
    if (model.state.crust.plate[i] == 1 || std::abs(longitude) < 120.0) continue;
    if (model.state.crust.age_myr[i] < 20.0F) young_km2 += model.sample_km2();
  }
  EXPECT_GT(young_km2, 3e5);
  EXPECT_LT(young_km2, 2100.0 * 700.0 * 2.0);
  EXPECT_NEAR(model.budget.area_error, 0.0, 1e-12);
  EXPECT_NEAR(model.budget.ocean_error_km2, 0.0, 0.03 * model.budget.created_km2);
}

TEST(SphereBackArcs, AnArcIsPartOfANeighbourWhenItsTimeHasPassed) {
  const SampledSphere world(20000);
  for (const double lasts_myr : {200.0, 1.0}) {
    SphereSettings settings = retreating();
    settings.back_arc_lasts_myr = lasts_myr;
    settings.smallest_piece_km2 = 4e6;
    SphereTectonics model(world.mesh, settings, closing(world, 100.0F, 10.0), 1);
    while (arcs(model).empty() && model.state.steps < 30) advance(model);
    ASSERT_FALSE(arcs(model).empty());
    model.settings.back_arc_per_myr = 1e-12;  // no more of them
    for (int k = 0; k < 3; ++k) advance(model);
    finish(model);
    EXPECT_EQ(arcs(model).empty(), lasts_myr < 100.0);
  }
}

}  // namespace
}  // namespace geo
