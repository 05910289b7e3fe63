// Rivers on a graph of places, and on plates that move.
#include "geo/kernels/water/surface_rivers.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include "geo/core/random.hpp"
#include "geo/kernels/plates/sphere/sphere_start.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::SampledSphere;

constexpr double kRadius_m = 6.371e6;

SurfaceGraph whole_sphere(const SampledSphere& world) {
  SurfaceGraph graph;
  const std::int32_t n = world.mesh.size();
  graph.is_there.assign(n, 1);
  graph.is_open.assign(n, 0);
  graph.area_m2 = world.samples.area_sr() * kRadius_m * kRadius_m;
  graph.first = {0};
  for (std::int32_t i = 0; i < n; ++i) {
    for (const std::int32_t j : world.mesh.neighbours(i)) {
      graph.neighbour.push_back(j);
      graph.distance_m.push_back(static_cast<float>(
          kRadius_m * angle_between(world.samples.position(i), world.samples.position(j))));
    }
    graph.first.push_back(static_cast<std::int32_t>(graph.neighbour.size()));
  }
  return graph;
}

/// Places in a row, a kilometre apart and a square kilometre large.
SurfaceGraph row_of(std::int32_t n) {
  SurfaceGraph graph;
  graph.is_there.assign(n, 1);
  graph.is_open.assign(n, 0);
  graph.area_m2 = 1e6;
  graph.first = {0};
  for (std::int32_t i = 0; i < n; ++i) {
    if (i > 0) graph.neighbour.push_back(i - 1);
    if (i + 1 < n) graph.neighbour.push_back(i + 1);
    graph.first.push_back(static_cast<std::int32_t>(graph.neighbour.size()));
  }
  graph.distance_m.assign(graph.neighbour.size(), 1000.0F);
  return graph;
}

/// A rough continent of a radius about the north pole, sea around.
std::vector<float> rough_continent(const SampledSphere& world, double radius_rad,
                                   std::uint64_t seed) {
  const RandomStream random(seed, "test");
  std::vector<float> z(world.mesh.size());
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const double inland = radius_rad - std::acos(std::min(1.0, world.samples.position(i)[2]));
    z[i] = static_cast<float>(inland > 0.0 ? 1.0 + 3000.0 * inland + 600.0 * random.uniform(i)
                                           : -4000.0 + random.uniform(i));
  }
  return z;
}

TEST(SurfaceRivers, DrainAllLandToTheSeaWithoutCycles) {
  const SampledSphere world(20000);
  const SurfaceGraph graph = whole_sphere(world);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto z = rough_continent(world, 0.5, seed);
    const SurfaceRivers rivers = route_rivers(graph, z);
    std::vector<std::int32_t> turn(z.size(), -1);
    double land = 0.0, drained_m2 = 0.0;
    for (const float height : z) land += height >= 0.0F ? 1.0 : 0.0;
    ASSERT_EQ(static_cast<double>(rivers.order.size()), land);
    for (std::size_t k = 0; k < rivers.order.size(); ++k) {
      const std::int32_t i = rivers.order[k], to = rivers.receiver[i];
      turn[i] = static_cast<std::int32_t>(k);
      ASSERT_GE(to, 0);
      ASSERT_GT(rivers.distance_m[i], 0.0F);
      if (z[to] < 0.0F) {
        drained_m2 += rivers.area_m2[i];
      } else {
        ASSERT_GE(turn[to], 0) << "a receiver stands before its donors";
      }
    }
    EXPECT_NEAR(drained_m2, land * graph.area_m2, 1e-9 * drained_m2);
  }
}

TEST(SurfaceRivers, CrossLakesTowardsTheSillThatOverflows) {
  // Sea, and two pits behind a sill of 5: the outer one of 1, the inner one of 2 behind 3.
  const SurfaceGraph graph = row_of(7);
  const std::vector<float> z{-10.0F, 5.0F, 1.0F, 3.0F, 2.0F, 6.0F, 9.0F};
  const SurfaceRivers rivers = route_rivers(graph, z);
  for (std::int32_t i = 1; i < 7; ++i) {
    EXPECT_EQ(rivers.receiver[i], i - 1);
    EXPECT_EQ(rivers.area_m2[i], 1e6 * (7 - i));
  }
}

TEST(SurfaceRivers, FillLakesToTheirSillAndNoFarther) {
  // What 6 and 9 lose is 60 times what the pits hold.
  SurfaceGraph graph = row_of(7);
  std::vector<float> z{-10.0F, 5.0F, 1.0F, 3.0F, 2.0F, 600.0F, 900.0F}, rock(7);
  RiverLaw law;
  law.rebound = 1.0;
  law.erodibility_yr = 1e-3;
  law.dt_yr = 1e3;
  const std::vector<std::int8_t> is_rock{0, 0, 0, 0, 0, 1, 1};  // the sill stays
  const auto work = run_rivers(graph, route_rivers(graph, z), law, is_rock, z, rock);
  for (const int i : {1, 2, 3, 4}) EXPECT_FLOAT_EQ(z[i], 5.0F);
  EXPECT_NEAR(work.on_land_m3, 1e6 * (4.0 + 2.0 + 3.0), 1.0);
  // K dt A^m / d: 1 for the last place of 1 km2, sqrt 2 for the one before, above a lake of 5.
  const double before = 5.0 + 595.0 / (1.0 + std::sqrt(2.0));
  EXPECT_NEAR(z[5], before, 1e-3);
  EXPECT_NEAR(z[6], before + (900.0 - before) / 2.0, 1e-3);
}

TEST(SurfaceRivers, SteadySlopesFallWithTheRootOfTheAreaThatTheyDrain) {
  const SampledSphere world(20000);
  const SurfaceGraph graph = whole_sphere(world);
  auto z = rough_continent(world, 0.4, 2);
  std::vector<std::int8_t> is_rock(z.size());
  for (std::size_t i = 0; i < z.size(); ++i) is_rock[i] = z[i] >= 0.0F;
  RiverLaw law;
  law.erodibility_yr = 2e-6;
  law.settling_km = 3000.0;
  constexpr double kUplift_m_yr = 2e-4;
  std::vector<float> rock(z.size());
  SurfaceRivers rivers;
  std::vector<float> before;
  for (int step = 0; step < 400; ++step) {
    before = z;
    for (std::size_t i = 0; i < z.size(); ++i) {
      // The sea keeps its depth.
      z[i] = is_rock[i] != 0 ? z[i] + static_cast<float>(kUplift_m_yr * law.dt_yr) : -4000.0F;
    }
    rivers = route_rivers(graph, z);
    run_rivers(graph, rivers, law, is_rock, z, rock);
  }
  const double wanted = kUplift_m_yr * law.rebound / law.erodibility_yr;  // S sqrt(A), m
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  const auto count = static_cast<double>(rivers.order.size());
  for (const std::int32_t i : rivers.order) {
    ASSERT_NEAR(z[i], before[i], 1e-3 * z[i]);  // steady
    const std::int32_t to = rivers.receiver[i];
    const double slope = (z[i] - std::max(0.0F, z[to])) / rivers.distance_m[i];
    ASSERT_NEAR(slope * std::sqrt(rivers.area_m2[i]), wanted, 1e-3 * wanted);
    const double log_area = std::log(rivers.area_m2[i]), log_slope = std::log(slope);
    x += log_area;
    y += log_slope;
    xx += log_area * log_area;
    xy += log_area * log_slope;
  }
  EXPECT_GT(count, 500.0);
  EXPECT_NEAR((count * xy - x * y) / (count * xx - x * x), -0.5, 1e-4);
}

TEST(SurfaceRivers, LoseNothing) {
  const SampledSphere world(20000);
  const SurfaceGraph graph = whole_sphere(world);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    auto z = rough_continent(world, 0.6, seed);
    const auto before = z;
    std::vector<std::int8_t> is_rock(z.size());
    for (std::size_t i = 0; i < z.size(); ++i) is_rock[i] = z[i] >= 0.0F;
    std::vector<float> rock(z.size());
    const RiverLaw law{.erodibility_yr = 1e-6};
    const auto work = run_rivers(graph, route_rivers(graph, z), law, is_rock, z, rock);
    EXPECT_GT(work.eroded_m3, 0.0);
    EXPECT_GT(work.on_land_m3, 0.0);
    EXPECT_NEAR(work.on_land_m3 + work.in_sea_m3, work.eroded_m3, 1e-12 * work.eroded_m3);
    double laid_m = 0.0, gone_m = 0.0;
    for (std::size_t i = 0; i < z.size(); ++i) {
      (rock[i] < 0.0F ? gone_m : laid_m) += std::abs(rock[i]);
      const double per_rock = before[i] < 0.0F ? law.load : 1.0 / law.rebound;
      ASSERT_NEAR(z[i] - before[i], per_rock * rock[i], 2e-3);
      if (before[i] < 0.0F) {
        ASSERT_LE(z[i], -law.shelf_m + 1e-3);
      }
    }
    EXPECT_NEAR(laid_m, gone_m, 1e-6 * gone_m);
  }
}

TEST(SurfaceRivers, SettleInTheSeaByAnExponentialOfTheWayFromTheCoast) {
  // One hill at the head of a row of sea: each place keeps 1 - e^(-1/20) of what comes.
  SurfaceGraph graph = row_of(200);
  std::vector<float> z(200, -4000.0F), rock(200);
  z[0] = 500.0F;
  std::vector<std::int8_t> is_rock(200, 0);
  is_rock[0] = 1;
  RiverLaw law;
  law.settling_km = 20.0;
  law.erodibility_yr = 1e-3;
  law.dt_yr = 1e6;
  run_rivers(graph, route_rivers(graph, z), law, is_rock, z, rock);
  EXPECT_GT(rock[1], 1.0F);
  // What has not settled after six lengths, e^-6, lies evenly everywhere.
  const double rest_m = rock[150];
  EXPECT_NEAR(rest_m, -rock[0] * std::exp(-6.0) / 199.0, 0.1 * rest_m);
  for (int i = 2; i < 100; ++i) {
    EXPECT_NEAR((rock[i] - rest_m) / (rock[i - 1] - rest_m), std::exp(-0.05), 1e-4) << i;
  }
}

TEST(SurfaceRivers, EnclosedLandKeepsNoTower) {
  SurfaceGraph graph = row_of(5);
  std::vector<float> z{900.0F, 20.0F, 10.0F, 15.0F, 900.0F}, rock(5);
  const std::vector<std::int8_t> is_rock(5, 1);
  RiverLaw law;
  law.erodibility_yr = 1e-2;
  const SurfaceRivers rivers = route_rivers(graph, z);
  EXPECT_EQ(rivers.receiver[2], SurfaceRivers::kSink);
  EXPECT_EQ(rivers.area_m2[2], 5e6);
  run_rivers(graph, rivers, law, is_rock, z, rock);
  EXPECT_LE(z[2], 20.0F);
}

/// A continent from 20 W to 20 E that slopes from a coast range in the west to the east, on one
/// plate or cut at the zero meridian, both of which turn alike.
SphereState slope(const SampledSphere& world, int plates) {
  SphereState state;
  state.crust.resize(world.mesh.size());
  for (int p = 0; p < plates; ++p) {
    SpherePlate plate;
    plate.axis = {0.0, 0.0, 1.0};
    plate.speed_rad_myr = 0.01;
    state.add_plate(plate);
  }
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& at = world.samples.position(i);
    const double east = std::atan2(at[1], at[0]) * 180.0 / std::numbers::pi;
    const double north = std::asin(at[2]) * 180.0 / std::numbers::pi;
    state.crust.plate[i] = plates == 2 && east >= 0.0 ? 1 : 0;
    const bool land = std::abs(east) < 20.0 && std::abs(north) < 30.0;
    state.crust.continental[i] = land ? 1 : 0;
    state.crust.elevation_m[i] =
        land ? static_cast<float>(50.0 * (22.0 - east) + 30.0 * std::sin(i)) : -4000.0F;
    state.crust.thickness_m[i] = land ? 36000.0F : 7000.0F;
  }
  return state;
}

TEST(SphereRivers, DoNotFeelAPlateBoundaryAtRest) {
  const SampledSphere world(20000);
  SphereSettings settings;
  settings.rift_per_myr = 0.0;
  settings.no_net_rotation = false;
  settings.by_rivers = true;
  settings.rivers.erodibility_yr = 1e-6;
  settings.least_steps = settings.most_steps = 1000;
  std::vector<std::vector<float>> ends;
  for (const int plates : {1, 2}) {
    SphereTectonics model(world.mesh, settings, slope(world, plates), 1);
    for (int k = 0; k < 5; ++k) advance(model);
    ends.push_back(model.state.crust.elevation_m);
  }
  double lowered = 0.0;
  const SphereState start = slope(world, 1);
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    ASSERT_NEAR(ends[0][i], ends[1][i], 0.05) << i;
    lowered = std::max(lowered, static_cast<double>(start.crust.elevation_m[i] - ends[0][i]));
  }
  EXPECT_GT(lowered, 300.0);
}

SphereSettings with_rivers() {
  SphereSettings settings;
  settings.by_rivers = true;
  settings.floor_by_age = true;
  settings.law.uplift_mm_yr = 0.2;
  settings.rivers.erodibility_yr = 1e-7;
  return settings;
}

TEST(SphereRivers, KeepTheMassBalanceOfContinents) {
  const SampledSphere world(12000);
  SphereTectonics model(world.mesh, with_rivers(), start_sphere(world.mesh, {}, with_rivers(), 4),
                        4);
  advance(model);
  double before = model.budget.continental_km3, eroded = 0.0, laid = 0.0;
  for (int k = 0; k < 40; ++k) {
    advance(model);
    const SphereBudget& b = model.budget;
    EXPECT_NEAR(b.continental_km3 - before,
                b.raised_km3 - b.eroded_km3 + b.deposited_km3 + b.scraped_km3 + b.emerged_km3 -
                    b.lost_km3 + b.resampling_km3,
                1e-6 * b.continental_km3);
    EXPECT_NEAR(b.deposited_km3 + b.sea_floor_km3, b.eroded_km3, 1e-5 * b.eroded_km3);
    before = b.continental_km3;
    eroded += b.eroded_km3;
    laid += b.deposited_km3;
  }
  EXPECT_GT(eroded, 1e8);
  EXPECT_GT(laid, 1e6);
  EXPECT_LT(laid, 0.6 * eroded);
}

TEST(SphereRivers, GiveTheSameBitsOnAnyNumberOfThreads) {
  const SampledSphere world(8000);
  const int threads = omp_get_max_threads();
  std::vector<std::vector<float>> ends;
  for (const int number : {1, 2, 4}) {
    omp_set_num_threads(number);
    SphereTectonics model(world.mesh, with_rivers(), start_sphere(world.mesh, {}, with_rivers(), 5),
                          5);
    for (int k = 0; k < 30; ++k) advance(model);
    ends.push_back(model.state.crust.elevation_m);
    ends.push_back(model.state.crust.thickness_m);
  }
  omp_set_num_threads(threads);
  for (const int k : {0, 1}) {
    EXPECT_EQ(ends[k], ends[2 + k]);
    EXPECT_EQ(ends[k], ends[4 + k]);
  }
}

TEST(SurfaceRivers, ThatDepositAreSteadyWhereTheyCarryWhatRises) {
  // K A^m S = (1 + G) U everywhere, with K over the rebound.
  const SurfaceGraph graph = row_of(40);
  RiverLaw law;
  law.erodibility_yr = 1e-5;
  law.deposition = 1.5;
  law.dt_yr = 1e5;
  law.settling_km = 1.0;
  constexpr double kUplift_m_yr = 1e-4;
  std::vector<float> z(40, 1.0F), rock(40);
  z[0] = -5000.0F;
  const std::vector<std::int8_t> is_rock(40, 1);
  for (int step = 0; step < 4000; ++step) {
    for (int i = 1; i < 40; ++i) z[i] += static_cast<float>(kUplift_m_yr * law.dt_yr);
    z[0] = -5000.0F;
    run_rivers(graph, route_rivers(graph, z), law, is_rock, z, rock);
  }
  for (int i = 2; i < 39; ++i) {
    const double area_m2 = 1e6 * (40 - i), slope = (z[i] - z[i - 1]) / 1000.0;
    const double lowering = law.erodibility_yr / law.rebound * std::sqrt(area_m2) * slope;
    EXPECT_NEAR(lowering, (1.0 + law.deposition) * kUplift_m_yr, 0.01 * lowering) << i;
  }
}

TEST(SurfaceRivers, ThatDepositLoseNothing) {
  const SampledSphere world(20000);
  const SurfaceGraph graph = whole_sphere(world);
  for (const double deposition : {0.3, 1.0, 10.0}) {
    RiverLaw law;
    law.deposition = deposition;
    std::vector<float> z = rough_continent(world, 0.7, 5), rock(z.size());
    const std::vector<std::int8_t> is_rock(z.size(), 1);
    for (int step = 0; step < 3; ++step) {
      const auto work = run_rivers(graph, route_rivers(graph, z), law, is_rock, z, rock);
      EXPECT_GT(work.on_land_m3, 0.0);
      EXPECT_NEAR(work.on_land_m3 + work.in_sea_m3, work.eroded_m3, 1e-9 * work.eroded_m3);
    }
  }
}

TEST(SurfaceRivers, FillLandlockedSeasUntilTheyAreLand) {
  const SurfaceGraph graph = row_of(12);
  // The ocean, a sill, a shallow sea behind it, a mountain.
  std::vector<float> z{-4000.0F, -4000.0F, -3000.0F, -3000.0F, 50.0F,   -200.0F,
                       -300.0F,  -200.0F,  10.0F,    900.0F,   2000.0F, 2500.0F};
  std::vector<float> rock(z.size());
  const std::vector<std::int8_t> is_rock(z.size(), 1);
  RiverLaw law;
  law.erodibility_yr = 1e-6;
  const SurfaceRivers first = route_rivers(graph, z);
  EXPECT_EQ(first.receiver[6], 5);
  EXPECT_EQ(first.receiver[4], 3);
  for (int step = 0; step < 40; ++step) {
    run_rivers(graph, route_rivers(graph, z), law, is_rock, z, rock);
  }
  for (int i = 5; i < 8; ++i) EXPECT_GE(z[i], 0.0F) << i;
  // Deep water behind a sill is a sea like any other.
  z = {-4000.0F, -4000.0F, -3000.0F, -3000.0F, 50.0F,  -200.0F,
       -1500.0F, -200.0F,  10.0F,    900.0F,   900.0F, 900.0F};
  EXPECT_EQ(route_rivers(graph, z).receiver[8], 7);
  EXPECT_EQ(route_rivers(graph, z).receiver[7], SurfaceRivers::kSink);
}

TEST(SurfaceRivers, DrainLandWithoutASeaIntoTheLakeOnIt) {
  // Two rows that nothing joins: an ocean with a coast, and land about a shallow hollow below 0.
  SurfaceGraph graph = row_of(14);
  graph.distance_m.assign(graph.neighbour.size(), 1000.0F);
  const auto part = [&](std::int32_t from, std::int32_t to) {
    for (std::int32_t k = graph.first[from]; k < graph.first[from + 1]; ++k) {
      if (graph.neighbour[k] == to) graph.neighbour[k] = from == 6 ? 5 : 8;
    }
  };
  part(6, 7);
  part(7, 6);
  std::vector<float> z{-4000.0F, -4000.0F, -4000.0F, -4000.0F, 10.0F,  20.0F, 30.0F,
                       300.0F,   100.0F,   -20.0F,   -30.0F,   -10.0F, 50.0F, 200.0F};
  std::vector<float> rock(z.size());
  const std::vector<std::int8_t> is_rock(z.size(), 1);
  const SurfaceRivers rivers = route_rivers(graph, z);
  EXPECT_EQ(rivers.order, (std::vector<std::int32_t>{4, 5, 6, 10, 9, 11, 12, 8, 13, 7}));
  EXPECT_EQ(rivers.receiver[10], SurfaceRivers::kSink);
  EXPECT_EQ(rivers.receiver[7], 8);
  EXPECT_EQ(rivers.receiver[13], 12);
  EXPECT_EQ(rivers.area_m2[10], 7e6);
  const auto work = run_rivers(graph, rivers, {}, is_rock, z, rock);
  EXPECT_NEAR(work.on_land_m3 + work.in_sea_m3, work.eroded_m3, 1e-9 * work.eroded_m3);
}

TEST(SurfaceRivers, AreAsLargeAsTheRunoffOfWhatTheyDrain) {
  const SurfaceGraph graph = row_of(5);
  const std::vector<float> z{-10.0F, 1.0F, 2.0F, 3.0F, 4.0F}, runoff{1.0F, 0.5F, 2.0F, 0.0F, 3.0F};
  const SurfaceRivers rivers = route_rivers(graph, z, [&](std::int32_t i) { return runoff[i]; });
  EXPECT_EQ(rivers.area_m2[4], 3e6);
  EXPECT_EQ(rivers.area_m2[3], 3e6);
  EXPECT_EQ(rivers.area_m2[2], 5e6);
  EXPECT_EQ(rivers.area_m2[1], 5.5e6);
}

}  // namespace
}  // namespace geo
