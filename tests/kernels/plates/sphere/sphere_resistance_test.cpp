// Rifts that open slowly at first, and continents that slow each other where they meet.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "geo/kernels/plates/great_circle_line.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::kKmPerDegree;
using test::kRadius_km;
using test::latitude_deg;
using test::longitude_deg;
using test::SampledSphere;

constexpr double kSpeed_mm_yr = 60.0;

SphereSettings settings() {
  SphereSettings s;
  s.rift_per_myr = s.initiation_per_myr = s.slab_pull = 0.0;
  s.no_net_rotation = false;
  s.floor_by_age = true;
  s.penetration_km = 5000.0;
  s.least_steps = s.most_steps = 1000;
  return s;
}

/// Two hemispheres that meet at longitude 0, each with a round continent beside it there; the
/// eastern one moves west.
SphereState two_continents(const SampledSphere& world) {
  SphereState state;
  state.crust.resize(world.mesh.size());
  state.add_plate({});
  SpherePlate eastern;
  eastern.axis = {0.0, 0.0, -1.0};
  eastern.speed_rad_myr = kSpeed_mm_yr / kRadius_km;
  state.add_plate(eastern);
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& at = world.samples.position(i);
    const double lon = longitude_deg(at), lat = latitude_deg(at);
    const bool land = std::hypot(std::abs(lon) - 6.0, lat) < 5.0;
    state.crust.plate[i] = lon < 0.0 ? 0 : 1;
    state.crust.continental[i] = land ? 1 : 0;
    state.crust.thickness_m[i] = land ? 36000.0F : 7000.0F;
    state.crust.elevation_m[i] = land ? 500.0F : -5000.0F;
    state.crust.age_myr[i] = 40.0F;
  }
  return state;
}

int overlapping(const SphereTectonics& model) {
  const SphereCrust& crust = model.state.crust;
  int count = 0;
  for (std::int32_t i = 0; i < crust.size(); ++i) {
    const std::int32_t other = model.margins.partner[i];
    const bool is_both = other >= 0 && crust.continental[i] != 0 && crust.continental[other] != 0;
    count += is_both && model.margins.hidden[i] != 0 ? 1 : 0;
  }
  return count;
}

/// Rotation about the pole by which the eastern plate meets the western one, mm/yr at the equator.
double meeting_mm_yr(const SphereTectonics& model) {
  return kRadius_km * (model.rotation[0][2] - model.rotation[1][2]);
}

TEST(ContinentsThatMeet, AreSlowedAsTheirOverlapAndTheirPlatesHaveIt) {
  const SampledSphere world(60000);
  SphereSettings s = settings();
  s.suture_drag = 100.0;
  SphereTectonics model(world.mesh, s, two_continents(world), 1);
  double slowest_mm_yr = kSpeed_mm_yr;
  for (int k = 0; k < 14; ++k) {
    advance(model);
    const int overlap = overlapping(model);
    // The drag on a hemisphere is a third of its sphere's samples for any rotation; that of an
    // overlap near the equator, turned about the pole, the samples that it has. With equal plates
    // v = v0 / (1 + k N_overlap (3 / N + 3 / N)).
    const double ratio = 6.0 * s.suture_drag * overlap / world.mesh.size();
    EXPECT_NEAR(meeting_mm_yr(model), kSpeed_mm_yr / (1.0 + ratio), 0.01 * kSpeed_mm_yr);
    slowest_mm_yr = std::min(slowest_mm_yr, meeting_mm_yr(model));
    // What one plate loses the other gains.
    EXPECT_NEAR(kRadius_km * (model.rotation[0][2] + model.rotation[1][2]), -kSpeed_mm_yr,
                0.01 * kSpeed_mm_yr);
    // What drives them stays.
    EXPECT_NEAR(kRadius_km * model.state.plates[1].speed_rad_myr, kSpeed_mm_yr, 1e-9);
  }
  EXPECT_LT(slowest_mm_yr, 0.6 * kSpeed_mm_yr);
}

TEST(ContinentsThatMeet, AreSlowedAsMuchWhenWhatWentBelowHasBecomeARoot) {
  const SampledSphere world(60000);
  SphereSettings s = settings();
  s.suture_drag = 100.0;
  SphereTectonics model(world.mesh, s, two_continents(world), 1);
  for (int k = 0; k < 8; ++k) advance(model);
  const double before_mm_yr = meeting_mm_yr(model);
  ASSERT_LT(before_mm_yr, 0.9 * kSpeed_mm_yr);
  resample(model);
  for (int k = 0; k < 3; ++k) advance(model);
  EXPECT_LT(meeting_mm_yr(model), 1.1 * before_mm_yr);
  EXPECT_GT(meeting_mm_yr(model), 0.4 * before_mm_yr);
}

TEST(ContinentsThatMeet, GoOnAsTheyAreDrivenWithoutDragOrWhereTheyAreHeld) {
  const SampledSphere world(20000);
  const auto meeting = [&](double drag, bool is_held) {
    SphereSettings s = settings();
    s.suture_drag = drag;
    SphereState state = two_continents(world);
    for (SpherePlate& plate : state.plates) plate.is_held = is_held;
    SphereTectonics model(world.mesh, s, std::move(state), 1);
    for (int k = 0; k < 8; ++k) advance(model);
    EXPECT_GT(overlapping(model), 0);
    return meeting_mm_yr(model);
  };
  EXPECT_DOUBLE_EQ(meeting(0.0, false), kSpeed_mm_yr);
  EXPECT_DOUBLE_EQ(meeting(100.0, true), kSpeed_mm_yr);
  EXPECT_LT(meeting(100.0, false), 0.9 * kSpeed_mm_yr);
}

TEST(ContinentsThatMeet, AreSlowedWhereForcesMoveThem) {
  const SampledSphere world(60000);
  SphereSettings s = settings();
  s.suture_drag = 100.0;
  s.by_forces = true;
  s.force.response_myr = 1e9;  // what drives them stays
  s.force.continental_drag = 10.0;
  SphereTectonics model(world.mesh, s, two_continents(world), 1);
  const SphereCrust& crust = model.state.crust;
  for (int k = 0; k < 14; ++k) {
    advance(model);
    std::array<double, 2> drag{};
    for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
      const double z = world.samples.position(i)[2];
      drag[crust.plate[i]] += (crust.continental[i] != 0 ? 10.0 : 1.0) * (1.0 - z * z);
    }
    const double ratio = s.suture_drag * overlapping(model) * (1.0 / drag[0] + 1.0 / drag[1]);
    EXPECT_NEAR(meeting_mm_yr(model), kSpeed_mm_yr / (1.0 + ratio), 0.01 * kSpeed_mm_yr);
  }
  EXPECT_LT(meeting_mm_yr(model), 0.7 * kSpeed_mm_yr);
}

TEST(PlatesOfOneSample, MoveAsForcesHaveItAndAreNotLost) {
  const SampledSphere world(6000);
  SphereSettings s = settings();
  s.by_forces = true;
  for (std::int32_t alone = 3; alone < world.mesh.size(); alone += 150) {
    SphereState state = two_continents(world);
    state.add_plate({});
    state.crust.plate[alone] = 2;
    SphereTectonics model(world.mesh, s, std::move(state), 1);
    advance(model);
    for (const Vector3& rotation : model.rotation) {
      ASSERT_TRUE(std::isfinite(length(rotation))) << alone;
      ASSERT_LE(kRadius_km * length(rotation), s.law.speed_mm_yr * 1.0001);
    }
  }
}

TEST(ContinentsThatMeet, ObeyAMotionThatIsGivenFromItsFirstStep) {
  const SampledSphere world(20000);
  SphereSettings s = settings();
  s.suture_drag = 100.0;
  SphereTectonics model(world.mesh, s, two_continents(world), 1);
  for (int k = 0; k < 8; ++k) advance(model);
  set_motion(model, 1, {0.0, 0.0, 1.0}, 0.01);
  EXPECT_DOUBLE_EQ(model.rotation[1][2], 0.01);
}

/// One plate, which is all there is.
SphereState one_plate(const SampledSphere& world) {
  SphereState state;
  state.crust.resize(world.mesh.size());
  state.add_plate({});
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    state.crust.plate[i] = 0;
    state.crust.continental[i] = 1;
    state.crust.thickness_m[i] = 36000.0F;
  }
  return state;
}

const std::vector<Vector3> kSides{{0.0, 1.0, 0.0}, {0.0, -1.0, 0.0}};

/// Speed of the first two plates beside each other, mm/yr.
double parting_mm_yr(const SphereTectonics& model) {
  return kRadius_km * length(add(model.rotation[0], model.rotation[1], -1.0));
}

TEST(Rifts, ComeToTheirSpeedSteadilyOverTheirOnset) {
  const SampledSphere world(12000);
  SphereSettings s = settings();
  s.rift_onset_myr = 20.0;
  SphereTectonics model(world.mesh, s, one_plate(world), 1);
  rift_plate(model, 0, kSides, 30.0);
  ASSERT_EQ(model.state.plates.size(), 2U);
  EXPECT_NEAR(parting_mm_yr(model), 0.0, 1e-9);
  for (int k = 1; k <= 15; ++k) {
    advance(model);
    const double whole = std::min(1.0, k * s.law.step_myr / s.rift_onset_myr);
    EXPECT_NEAR(parting_mm_yr(model), 60.0 * whole, 1e-6);
  }
}

TEST(Rifts, AreSlowForLongWithAPowerAboveOne) {
  const SampledSphere world(12000);
  SphereSettings s = settings();
  s.rift_onset_myr = 20.0;
  s.rift_onset_power = 2.0;
  SphereTectonics model(world.mesh, s, one_plate(world), 1);
  rift_plate(model, 0, kSides, 30.0);
  for (int k = 1; k <= 12; ++k) {
    advance(model);
    const double share = std::min(1.0, k * s.law.step_myr / s.rift_onset_myr);
    EXPECT_NEAR(parting_mm_yr(model), 60.0 * share * share, 1e-6);
  }
}

TEST(Rifts, BreakAgainWithoutLosingWhatTheyHadStillToGain) {
  const SampledSphere world(12000);
  SphereSettings s = settings();
  s.rift_onset_myr = 20.0;
  SphereTectonics model(world.mesh, s, one_plate(world), 1);
  rift_plate(model, 0, kSides, 30.0);
  for (int k = 0; k < 5; ++k) advance(model);
  const std::vector<Vector3> again{normalised({0.5, 1.0, 0.0}), normalised({-0.5, 1.0, 0.0})};
  rift_plate(model, 0, again, 0.0);
  for (int k = 0; k < 10; ++k) advance(model);
  for (std::size_t p = 0; p < model.state.plates.size(); ++p) {
    EXPECT_NEAR(kRadius_km * length(model.rotation[p]), 30.0, 1e-6);
  }
}

TEST(Rifts, ComeToTheirSpeedWhereStepsDoNotFitTheOnset) {
  const SampledSphere world(12000);
  SphereSettings s = settings();
  s.rift_onset_myr = 5.0;
  SphereTectonics model(world.mesh, s, one_plate(world), 1);
  rift_plate(model, 0, kSides, 30.0);
  for (int k = 0; k < 4; ++k) advance(model);
  EXPECT_NEAR(parting_mm_yr(model), 60.0, 1e-6);
}

TEST(Rifts, OpenAtOnceWithoutAnOnset) {
  const SampledSphere world(12000);
  SphereTectonics model(world.mesh, settings(), one_plate(world), 1);
  rift_plate(model, 0, kSides, 30.0);
  for (const SpherePlate& plate : model.state.plates) {
    EXPECT_NEAR(kRadius_km * plate.speed_rad_myr, 30.0, 1e-9);
  }
}

}  // namespace
}  // namespace geo
