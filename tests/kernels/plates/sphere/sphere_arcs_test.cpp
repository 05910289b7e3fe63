// Arcs and ranges behind trenches.
#include <gtest/gtest.h>

#include <vector>

#include "geo/kernels/plates/sphere/sphere_start.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "kernels/plates/sphere/hemispheres.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::hemispheres;
using test::quiet;
using test::SampledSphere;

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

}  // namespace
}  // namespace geo
