// How far continents are thrust below each other before they collide.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "geo/kernels/plates/sphere/sphere_start.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::kRadius_km;
using test::latitude_deg;
using test::longitude_deg;
using test::SampledSphere;

/// The farthest that any place of a plate can have gone over another one since no plates
/// overlapped.
double way_km(const SphereState& state, int a, int b) {
  const Matrix3 turn = back_times(state.plates[a].turn.matrix(), state.plates[b].turn.matrix());
  const double trace = turn[0][0] + turn[1][1] + turn[2][2];
  return kRadius_km * std::acos(std::clamp(0.5 * (trace - 1.0), -1.0, 1.0));
}

double fastest_closing_mm_yr(const SphereTectonics& model) {
  double fastest = 0.0;
  for (const Vector3& a : model.rotation) {
    for (const Vector3& b : model.rotation) {
      fastest = std::max(fastest, kRadius_km * length(add(a, b, -1.0)));
    }
  }
  return fastest;
}

TEST(SpherePenetration, NoContinentsCollideSoonerThanTheyCanHaveMet) {
  const SampledSphere world(30000);
  SphereSettings settings;
  settings.rift_per_myr = 0.0;
  settings.initiation_per_myr = 0.0;
  settings.penetration_km = 500.0;
  settings.least_steps = settings.most_steps = 1000;
  constexpr double kSlack_km = 40.0;  // a quarter of the spacing, 140 km
  int collisions = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SphereStart start;
    start.plates = 20;
    start.continental_share = 0.6;
    SphereTectonics model(world.mesh, settings, start_sphere(world.mesh, start, settings, seed),
                          seed);
    double fastest_km = 0.0;
    std::size_t told = 0;
    for (int k = 0; k < 10; ++k) {
      begin_step(model);
      fastest_km += fastest_closing_mm_yr(model) * settings.law.step_myr;
      advance(model);
      for (; told < model.events.size(); ++told, ++collisions) {
        const SphereEvent& event = model.events[told];
        const std::string where =
            "seed " + std::to_string(seed) + ", " + std::to_string(event.time_myr) +
            " Myr, plates " + std::to_string(event.first) + " and " + std::to_string(event.second);
        EXPECT_GE(fastest_km, settings.penetration_km - kSlack_km) << where;
        EXPECT_GE(way_km(model.state, event.first, event.second),
                  settings.penetration_km - kSlack_km)
            << where;
      }
    }
  }
  EXPECT_GT(collisions, 10);
}

/// Two plates on both sides of the meridians 0 and 180, all continent. The second turns about a
/// pole on the equator at longitude 0 to 90: at 180 E it meets the first at 0 head on and passes it
/// at 90.
SphereTectonics oblique(const SampledSphere& world, double pole_deg, double speed_mm_yr,
                        std::int64_t steps_between = 1000) {
  SphereSettings settings;
  settings.rift_per_myr = 0.0;
  settings.initiation_per_myr = 0.0;
  settings.slab_pull = 0.0;
  settings.no_net_rotation = false;
  settings.least_steps = settings.most_steps = steps_between;
  SphereState state;
  state.crust.resize(world.mesh.size());
  state.add_plate({});
  const double latitude = pole_deg * std::numbers::pi / 180.0;
  SpherePlate moving;
  moving.axis = {std::sin(latitude), 0.0, std::cos(latitude)};
  moving.speed_rad_myr = speed_mm_yr / kRadius_km;
  state.add_plate(moving);
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& at = world.samples.position(i);
    const bool is_land = std::abs(latitude_deg(at)) < 25.0 && std::abs(longitude_deg(at)) > 140.0;
    state.crust.plate[i] = longitude_deg(at) < 0.0 ? 0 : 1;
    state.crust.continental[i] = is_land ? 1 : 0;
    state.crust.thickness_m[i] = is_land ? 36000.0F : 7000.0F;
    state.crust.elevation_m[i] = is_land ? 300.0F : -5000.0F;
    state.crust.age_myr[i] = state.crust.plate[i] == 0 ? 50.0F : 60.0F;
  }
  return {world.mesh, settings, std::move(state), 1};
}

TEST(SpherePenetration, ObliqueContinentsCollideWhenTheirClosingHasBroughtThemThere) {
  const SampledSphere world(40000);  // 120 km apart
  constexpr double kSpeed_mm_yr = 80.0;
  for (const double degrees : {0.0, 30.0, 55.0}) {
    SphereTectonics model = oblique(world, degrees, kSpeed_mm_yr);
    while (model.events.empty() && model.state.time_myr < 40.0) advance(model);
    ASSERT_EQ(model.events.size(), 1U) << degrees;
    const double closing_mm_yr = kSpeed_mm_yr * std::cos(degrees * std::numbers::pi / 180.0);
    EXPECT_GE(model.events[0].time_myr, (300.0 - 60.0) / closing_mm_yr) << degrees;
    EXPECT_LE(model.events[0].time_myr, (300.0 + 2.0 * 120.0) / closing_mm_yr + 2.0) << degrees;
  }
}

TEST(SpherePenetration, ContinentsThatGoOnMeetingCollideThoughCrustIsResampledBetween) {
  const SampledSphere world(40000);
  constexpr double kSpeed_mm_yr = 20.0;
  // Resampled every 10 Myr, in which they come 200 km; 300 km are due after 15.
  SphereTectonics model = oblique(world, 0.0, kSpeed_mm_yr, 5);
  while (model.events.empty() && model.state.time_myr < 60.0) advance(model);
  ASSERT_EQ(model.events.size(), 1U);
  EXPECT_GE(model.events[0].time_myr, (300.0 - 60.0) / kSpeed_mm_yr);
  EXPECT_LE(model.events[0].time_myr, (300.0 + 3.0 * 120.0) / kSpeed_mm_yr + 2.0);
}

}  // namespace
}  // namespace geo
