#include "geo/kernels/landscape/glacial_erosion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geo/core/random.hpp"
#include "support/ice.hpp"
#include "support/terrain.hpp"

namespace geo {
namespace {

constexpr double kIce_m = 9.0;

struct Glaciation {
  std::vector<IceGround> ground;
  IceSurface surface;
  IceFlux flux;
};

Glaciation glaciate(const Grid& grid, const std::vector<float>& z, std::vector<IceGround> ground,
                    const std::vector<float>& balance) {
  Glaciation ice{std::move(ground), {}, {}};
  ice.surface = plastic_ice_surface(grid, kIce_m, z, ice.ground);
  ice.flux = ice_flux(grid, z, ice.ground, ice.surface, test::of_surface(ice.surface, balance));
  return ice;
}

TEST(GlacialErosion, RockTakenIsLaidOrLetOut) {
  for (const Grid& grid : test::small_grids()) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      auto z = test::random_terrain(grid, seed);
      const auto before = z;
      const RandomStream random(seed, "snow");
      std::vector<IceGround> ground(grid.size());
      std::vector<float> balance(grid.size());
      for (Index c = 0; c < grid.size(); ++c) {
        ground[c] = z[c] < -100.0F ? IceGround::away : IceGround::iced;
        balance[c] = static_cast<float>(0.5 + random.normal(c));
      }
      const Glaciation ice = glaciate(grid, z, ground, balance);
      const auto let_out = erode_under_ice(grid, {}, 1e5, ice.surface, ice.flux, ice.ground, {}, z);
      double lost = 0.0, gone = 0.0, taken = 0.0, laid = 0.0;
      for (Index c = 0; c < grid.size(); ++c) {
        const double volume = grid.area_m2(grid.row(c)) * (double(before[c]) - z[c]);
        lost += volume;
        taken += std::max(0.0, volume);
        laid += std::max(0.0, -volume);
        gone += let_out[c];
      }
      EXPECT_GT(taken, 0.0);
      EXPECT_GT(laid, 0.0);
      EXPECT_NEAR(lost, gone, 1e-12 * taken) << seed;
    }
  }
}

/// A valley down to the sea along the columns of a plane; the first column is deep sea.
struct Valley {
  Grid grid = Grid::plane(60, 9, 5000.0, 5000.0, Edges::closed);
  std::vector<float> z = std::vector<float>(grid.size());
  std::vector<IceGround> ground = std::vector<IceGround>(grid.size(), IceGround::iced);
  Valley() {
    for (Index c = 0; c < grid.size(); ++c) {
      const int i = grid.column(c), from_axis = std::abs(grid.row(c) - 4);
      z[c] = i == 0 ? -400.0F : static_cast<float>(5.0 + 25.0 * i + 300.0 * from_axis);
      if (i == 0) ground[c] = IceGround::away;
    }
  }
  SparseValues<double> erode(const GlacialErosion& law, double years) {
    const Glaciation ice = glaciate(grid, z, ground, std::vector<float>(grid.size(), 1.0F));
    return erode_under_ice(grid, law, years, ice.surface, ice.flux, ground, {}, z);
  }
};

TEST(GlacialErosion, LowersByTheWayThatIceMoves) {
  Valley valley;
  const auto before = valley.z;
  const Glaciation ice =
      glaciate(valley.grid, valley.z, valley.ground, std::vector<float>(valley.grid.size(), 1.0F));
  const GlacialErosion law;
  const double years = 10.0;
  (void)erode_under_ice(valley.grid, law, years, ice.surface, ice.flux, valley.ground, {},
                        valley.z);
  const Index cell = valley.grid.cell(30, 4);
  const double q = ice.flux.through_m3_yr[cell];
  const double width = std::min(5000.0, 1.63 * std::pow(q, 0.375));
  const double speed = q / (width * (ice.surface.height_m[cell] - before[cell]));
  // Floats of heights near 800 m: 6e-5 m.
  EXPECT_NEAR(before[cell] - valley.z[cell], law.abrasion * speed * years, 1e-4);
  EXPECT_GT(speed * law.abrasion * years, 1e-3);
}

TEST(GlacialErosion, CutsAFjordThatTheSeaReachesAndNoneBehindLand) {
  Valley valley;
  for (int time = 0; time < 8; ++time) (void)valley.erode({}, 2e5);
  int fjord = 0;
  while (valley.z[valley.grid.cell(fjord + 1, 4)] < 0.0F) ++fjord;
  EXPECT_GE(fjord, 3);
  EXPECT_LT(valley.z[valley.grid.cell(2, 4)], -100.0F);
  // The sea comes over neighbours.
  std::vector<std::uint8_t> sea(valley.grid.size(), 0);
  std::vector<Index> front;
  for (int j = 0; j < valley.grid.ny(); ++j) front.push_back(valley.grid.cell(0, j));
  for (const Index c : front) sea[c] = 1;
  while (!front.empty()) {
    const Index c = front.back();
    front.pop_back();
    for (int k = 0; k < kDirections; ++k) {
      const Index to = valley.grid.neighbour(c, k);
      if (to == kNoCell || sea[to] != 0 || valley.z[to] >= 0.0F) continue;
      sea[to] = 1;
      front.push_back(to);
    }
  }
  for (Index c = 0; c < valley.grid.size(); ++c) EXPECT_EQ(sea[c] != 0, valley.z[c] < 0.0F);
}

TEST(GlacialErosion, BedsClimbNoSteeperThanWaterBelowTheIceAllows) {
  for (const double steepest : {0.0, 1.5}) {
    Valley valley;
    const GlacialErosion law{.overdeepening = steepest, .till_share = 0.0};
    const Glaciation ice = glaciate(valley.grid, valley.z, valley.ground,
                                    std::vector<float>(valley.grid.size(), 1.0F));
    (void)erode_under_ice(valley.grid, law, 1e9, ice.surface, ice.flux, valley.ground, {},
                          valley.z);
    bool climbs = false;
    for (int i = 2; i < 59; ++i) {
      const Index c = valley.grid.cell(i, 4), down = valley.grid.cell(i - 1, 4);
      const double climb = valley.z[down] - valley.z[c];
      const double fall = ice.surface.height_m[c] - ice.surface.height_m[down];
      EXPECT_LE(climb, steepest * fall + 1e-3);
      climbs = climbs || climb > 1.0;
    }
    EXPECT_EQ(climbs, steepest > 0.0);
  }
}

TEST(GlacialErosion, MorainesLieWhereIceEnds) {
  const Grid grid = Grid::plane(60, 9, 5000.0, 5000.0, Edges::closed);
  std::vector<float> z(grid.size()), balance(grid.size());
  std::vector<IceGround> ground(grid.size(), IceGround::iced);
  for (Index c = 0; c < grid.size(); ++c) {
    const int i = grid.column(c);
    z[c] = static_cast<float>(10.0 + 20.0 * i + 100.0 * std::abs(grid.row(c) - 4));
    balance[c] = i > 30 ? 1.0F : -25.0F;
    if (i == 0) ground[c] = IceGround::away;
  }
  const auto before = z;
  const Glaciation ice = glaciate(grid, z, ground, balance);
  (void)erode_under_ice(grid, {}, 1e5, ice.surface, ice.flux, ice.ground, {}, z);
  int end = 59;
  while (end > 0 && ice.flux.share[grid.cell(end, 4)] > 0.0F) --end;
  ASSERT_GT(end, 0);
  EXPECT_GT(z[grid.cell(end + 1, 4)], before[grid.cell(end + 1, 4)]);
  EXPECT_LT(z[grid.cell(40, 4)], before[grid.cell(40, 4)]);
  EXPECT_EQ(z[grid.cell(end - 1, 4)], before[grid.cell(end - 1, 4)]);
}

}  // namespace
}  // namespace geo
