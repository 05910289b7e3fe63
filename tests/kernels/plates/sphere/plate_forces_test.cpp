// Forces on plates, with torques worked out by hand.
#include "geo/kernels/plates/sphere/plate_forces.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <numbers>

#include "geo/kernels/plates/sphere/sphere_start.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "kernels/plates/sphere/hemispheres.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::hemispheres;
using test::SampledSphere;

constexpr double kPi = std::numbers::pi;
constexpr double kRadius_m = 6.37e6;
constexpr double kMmYr = 1e-3 / 3.15576e7;  // m/s

TEST(PlateForces, AreThoseWorkedOutByHand) {
  // 100 Myr are 3.15576e15 s: sqrt(kappa t / pi) = 31694 m, rho alpha Delta T = 128.7 kg/m3,
  // 2 x 128.7 x 31694 x 9.81 x 6e5 m = 4.802e13 N/m.
  PlateForces k;
  k.slab_share = 1.0;
  EXPECT_NEAR(slab_pull_n_m(100.0, k), 4.8017e13, 1e10);
  EXPECT_NEAR(slab_pull_n_m(25.0, k), 2.4008e13, 1e10);
  EXPECT_EQ(slab_pull_n_m(0.0, k), 0.0);
  k.suction_share = 0.25;
  EXPECT_NEAR(slab_suction_n_m(100.0, k), 1.2004e13, 1e10);
  EXPECT_EQ(slab_suction_n_m(100.0), 0.0);
  // 9.81 x 128.7 x (1 + 257.4 / (pi x 2270)) x 3.15576e9 = 4.128e12.
  EXPECT_NEAR(ridge_push_n_m(100.0), 4.1280e12, 1e9);
  EXPECT_NEAR(ridge_push_n_m(50.0), 2.0640e12, 1e9);
  EXPECT_DOUBLE_EQ(basal_drag_pa_s_m(), 5e14);
}

double longitude(const Vector3& at) { return std::atan2(at[1], at[0]); }

SphereSettings by_forces() {
  SphereSettings settings;
  settings.rift_per_myr = 0.0;
  settings.no_net_rotation = false;
  settings.by_forces = true;
  settings.least_steps = settings.most_steps = 1000;
  return settings;
}

void make_continental(const SampledSphere& world, SphereState& state, std::int16_t plate) {
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    if (state.crust.plate[i] != plate) continue;
    state.crust.continental[i] = 1;
    state.crust.elevation_m[i] = 300.0F;
    state.crust.thickness_m[i] = 36000.0F;
  }
}

/// Of a hemisphere that turns about an axis in its edge: int (1 - z^2) dOmega = 4 pi / 3.
double drag_of_hemisphere_n_m_s() { return 5e14 * std::pow(kRadius_m, 4) * 4.0 * kPi / 3.0; }

TEST(SphereForces, AStraightTrenchFromPoleToPoleTurnsAHemisphereByItsPullTimesTwiceTheRadius) {
  const SampledSphere world(60000);
  SphereTectonics model(world.mesh, by_forces(), hemispheres(world, 100.0), 1);
  for (int k = 0; k < 3; ++k) advance(model);
  const auto all = torques(model);
  // Floor of both pushes to the trench and has its ridge in the gap; only plate 1 has a slab.
  // R^2 int F dl along a meridian: F times R^2 times the way from pole to pole, 2. The ends of the
  // trench are known to a sample or two, of 0.014 radians.
  const double lever_m2 = 2.0 * kRadius_m * kRadius_m;
  const double pull = lever_m2 * (slab_pull_n_m(66.0) + ridge_push_n_m(66.0));
  const double push = lever_m2 * ridge_push_n_m(56.0);
  EXPECT_NEAR(all[1].driving_n_m[2], pull, 0.02 * pull);
  EXPECT_NEAR(all[0].driving_n_m[2], -push, 0.02 * push);
  for (const int plate : {0, 1}) {
    EXPECT_NEAR(all[plate].driving_n_m[0], 0.0, 0.03 * pull);
    EXPECT_NEAR(all[plate].driving_n_m[1], 0.0, 0.03 * pull);
    EXPECT_NEAR(all[plate].drag_n_m_s[2][2], drag_of_hemisphere_n_m_s(),
                1e-3 * drag_of_hemisphere_n_m_s());
    EXPECT_NEAR(all[plate].drag_n_m_s[0][1], 0.0, 1e-3 * drag_of_hemisphere_n_m_s());
  }
}

TEST(SphereForces, ASlabDrawsThePlateAboveToItsTrench) {
  const SampledSphere world(60000);
  SphereSettings settings = by_forces();
  settings.force.suction_share = 0.1;
  SphereTectonics model(world.mesh, settings, hemispheres(world, 100.0), 1);
  for (int k = 0; k < 3; ++k) advance(model);
  for (const bool fresh : {false, true}) {  // before and after new samples along the trench
    if (fresh) resample(model);
    const auto all = torques(model);
    const double lever_m2 = 2.0 * kRadius_m * kRadius_m;
    const double pull = lever_m2 * (slab_pull_n_m(66.0, settings.force) + ridge_push_n_m(66.0));
    const double drawn = lever_m2 * (slab_suction_n_m(66.0, settings.force) + ridge_push_n_m(56.0));
    EXPECT_NEAR(all[1].driving_n_m[2], pull, 0.03 * pull);
    EXPECT_NEAR(all[0].driving_n_m[2], -drawn, 0.03 * drawn);
  }
}

TEST(SphereForces, EndAtTheSpeedOfPullOverDrag) {
  const SampledSphere world(60000);
  SphereSettings settings = by_forces();
  settings.force.slab_share = 0.02;
  settings.force.response_myr = 1.0;
  SphereTectonics model(world.mesh, settings, hemispheres(world, 20.0), 1);
  for (int k = 0; k < 10; ++k) advance(model);
  const double pull = slab_pull_n_m(80.0, settings.force) + ridge_push_n_m(80.0);
  const double wanted_m_s = 2.0 * std::pow(kRadius_m, 3) * pull / drag_of_hemisphere_n_m_s();
  const double speed_m_s = 6370.0 * model.rotation[1][2] * kMmYr;
  EXPECT_GT(wanted_m_s, 15.0 * kMmYr);
  // It grows with the floor's age, by 2 per cent a step, and lags by a part of that.
  EXPECT_NEAR(speed_m_s, wanted_m_s, 0.03 * wanted_m_s);
}

TEST(SphereForces, DragAloneBringsPlatesToRest) {
  const SampledSphere world(8000);
  SphereSettings settings = by_forces();
  SphereState state = hemispheres(world, 80.0);
  state.plates[0].axis = {0.0, 0.0, 1.0};  // both turn as one: nothing meets, nothing parts
  SphereTectonics model(world.mesh, settings, std::move(state), 1);
  advance(model);
  const double driving = length(torques(model)[1].driving_n_m);
  EXPECT_LT(driving, 1e-9 * 2.0 * kRadius_m * kRadius_m * ridge_push_n_m(60.0));
  for (int k = 1; k < 20; ++k) advance(model);
  // e^(-40 / 4) of 40 mm/yr.
  for (const Vector3& rotation : model.rotation) {
    EXPECT_NEAR(6370.0 * length(rotation), 40.0 * std::exp(-10.0), 1e-6);
  }
}

TEST(SphereForces, ContinentsDragMore) {
  const SampledSphere world(8000);
  SphereState state = hemispheres(world, 10.0);
  make_continental(world, state, 1);
  SphereSettings settings = by_forces();
  settings.force.continental_drag = 3.0;
  const SphereTectonics model(world.mesh, settings, std::move(state), 1);
  const auto all = torques(model);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(all[1].drag_n_m_s[c][c], 3.0 * all[0].drag_n_m_s[c][c],
                1e-2 * all[1].drag_n_m_s[c][c]);
  }
}

TEST(SphereForces, ASutureResistsBothContinentsAlike) {
  const SampledSphere world(60000);
  SphereState state = hemispheres(world, 100.0);
  make_continental(world, state, 0);
  make_continental(world, state, 1);
  SphereSettings settings = by_forces();
  settings.penetration_km = 5000.0;  // they go on without becoming one
  SphereTectonics model(world.mesh, settings, std::move(state), 1);
  for (int k = 0; k < 3; ++k) advance(model);
  const auto all = torques(model);
  const double wanted = 2.0 * kRadius_m * kRadius_m * 5e12;
  // Against their motion, which is eastwards for plate 1.
  EXPECT_NEAR(all[1].driving_n_m[2], -wanted, 0.03 * wanted);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(all[0].driving_n_m[c], -all[1].driving_n_m[c], 1e-9 * wanted);
  }
}

TEST(SphereForces, AContinentalMarginIsPushedByTheFloorBesideIt) {
  // The eastern half of plate 1 is a continent; its western half grows older eastwards from the
  // ridge at longitude 0 up to the margin at longitude 90, where it is 100 Myr old.
  const SampledSphere world(60000);
  SphereState state = hemispheres(world, 0.0);
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const double east = longitude(world.samples.position(i));
    if (state.crust.plate[i] == 0) state.crust.age_myr[i] = 0.0F;
    if (state.crust.plate[i] != 1) continue;
    state.crust.age_myr[i] = static_cast<float>(std::max(0.0, 100.0 * east / (0.5 * kPi)));
    if (east < 0.5 * kPi) continue;
    state.crust.continental[i] = 1;
    state.crust.thickness_m[i] = 36000.0F;
  }
  const SphereTectonics model(world.mesh, by_forces(), std::move(state), 1);
  const double wanted = 2.0 * kRadius_m * kRadius_m * ridge_push_n_m(100.0);
  EXPECT_NEAR(torques(model)[1].driving_n_m[2], wanted, 0.02 * wanted);
}

TEST(SphereForces, LeaveNoNetRotation) {
  const SampledSphere world(8000);
  SphereSettings settings;
  settings.by_forces = true;
  SphereTectonics model(world.mesh, settings, start_sphere(world.mesh, {}, settings, 3), 3);
  for (int k = 0; k < 14; ++k) advance(model);
  resample(model);
  begin_step(model);
  Vector3 sum{};
  double speeds = 0.0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& r = world.samples.position(i);
    const Vector3 v = cross(model.rotation[model.state.crust.plate[i]], r);
    sum = add(sum, cross(r, v));
    speeds += length(v);
  }
  EXPECT_GT(speeds * 6370.0 / world.mesh.size(), 10.0);
  EXPECT_LT(6370.0 * length(sum) / world.mesh.size(), 1e-12);
}

TEST(SphereForces, MovePlatesWithSlabsFasterThanContinentsAtTheSpeedsOfTheEarth) {
  const SampledSphere world(12000);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    SphereSettings settings;
    settings.by_forces = true;
    settings.floor_by_age = true;
    SphereTectonics model(world.mesh, settings, start_sphere(world.mesh, {}, settings, seed), seed);
    double with_slab = 0.0, slab_area = 0.0, continents = 0.0, land_area = 0.0, all = 0.0,
           area = 0.0;
    for (int step = 0; step < 60; ++step) {
      advance(model);
      if (step < 20) continue;
      const std::size_t plates = model.state.plates.size();
      std::vector<double> speed(plates), size(plates), land(plates), slab(plates);
      for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
        const int own = model.state.crust.plate[i];
        if (own < 0) continue;
        const int root = model.state.root(own);
        const Vector3 at = times(model.state.plates[own].turn.matrix(), world.samples.position(i));
        speed[root] += 6370.0 * length(cross(model.rotation[own], at));
        size[root] += 1.0;
        land[root] += model.state.crust.continental[i];
      }
      for (const auto& trench : model.margins.trenches) slab[model.state.root(trench.lower)] += 1.0;
      for (std::size_t p = 0; p < plates; ++p) {
        if (size[p] == 0.0) continue;
        all += speed[p];
        area += size[p];
        // A trench along a fifth of the outline of a round plate, 3.5 sqrt(area).
        if (slab[p] > 0.7 * std::sqrt(size[p])) {
          with_slab += speed[p];
          slab_area += size[p];
        }
        if (land[p] > 0.5 * size[p]) {
          continents += speed[p];
          land_area += size[p];
        }
      }
    }
    // PB2002 without net rotation: 37.6 mm/yr over the Earth, Pacific 65, continents 12 to 30.
    EXPECT_GT(all / area, 20.0);
    EXPECT_LT(all / area, 60.0);
    EXPECT_GT(with_slab / slab_area, 35.0);
    EXPECT_LT(with_slab / slab_area, 100.0);
    EXPECT_LT(continents / land_area, 0.6 * with_slab / slab_area);
  }
}

TEST(SphereForces, GiveTheSameBitsOnAnyNumberOfThreads) {
  const SampledSphere world(8000);
  SphereSettings settings;
  settings.by_forces = true;
  settings.rift_per_myr = 0.02;
  const int threads = omp_get_max_threads();
  std::vector<std::vector<Vector3>> ends;
  for (const int number : {1, 2, 4}) {
    omp_set_num_threads(number);
    SphereTectonics model(world.mesh, settings, start_sphere(world.mesh, {}, settings, 5), 5);
    for (int k = 0; k < 30; ++k) advance(model);
    ends.push_back(model.rotation);
  }
  omp_set_num_threads(threads);
  EXPECT_EQ(ends[0], ends[1]);
  EXPECT_EQ(ends[0], ends[2]);
}

}  // namespace
}  // namespace geo
