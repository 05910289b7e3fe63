// Plates and crust that drift begins with.
#include "geo/kernels/plates/sphere/sphere_start.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::SampledSphere;

constexpr double kSphere_km2 = 4.0 * std::numbers::pi * 6370.0 * 6370.0;

/// Areas of the seas, largest first: pieces of ocean that hang together, km2.
std::vector<double> seas_km2(const SampledSphere& world, const SphereCrust& crust) {
  std::vector<double> seas;
  std::vector<std::uint8_t> seen(crust.continental.begin(), crust.continental.end());
  for (std::int32_t i = 0; i < crust.size(); ++i) {
    if (seen[i] != 0) continue;
    std::vector<std::int32_t> sea{i};
    seen[i] = 1;
    for (std::size_t k = 0; k < sea.size(); ++k) {
      for (const std::int32_t j : world.mesh.neighbours(sea[k])) {
        if (seen[j] == 0) sea.push_back(j);
        seen[j] = 1;
      }
    }
    seas.push_back(kSphere_km2 * static_cast<double>(sea.size()) / crust.size());
  }
  std::ranges::sort(seas, std::greater<>());
  return seas;
}

TEST(FirstContinents, HoldNoSeaThatIsTooSmallAndKeepTheirShare) {
  const SampledSphere world(60000);
  SphereStart start;
  start.continental_share = 0.4;
  int holes = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    start.smallest_sea_km2 = 0.0;
    const auto open = seas_km2(world, start_sphere(world.mesh, start, {}, seed).crust);
    holes += static_cast<int>(std::ranges::count_if(open, [](double km2) { return km2 < 2e6; }));
    start.smallest_sea_km2 = 2e6;
    const SphereCrust crust = start_sphere(world.mesh, start, {}, seed).crust;
    EXPECT_GE(seas_km2(world, crust).back(), 2e6) << seed;
    const double land = static_cast<double>(std::ranges::count(crust.continental, 1));
    EXPECT_NEAR(land / crust.size(), 0.4, 1e-3) << seed;
  }
  EXPECT_GT(holes, 5);
}

TEST(FirstContinents, LeaveTheLargestSea) {
  const SampledSphere world(5000);
  SphereStart start;
  start.smallest_sea_km2 = 1e8;
  for (const double share : {0.0, 0.3, 0.95}) {
    start.continental_share = share;
    const SphereCrust crust = start_sphere(world.mesh, start, {}, 3).crust;
    EXPECT_EQ(seas_km2(world, crust).size(), 1U) << share;
  }
}

}  // namespace
}  // namespace geo
