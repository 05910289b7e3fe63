#include "geo/kernels/landscape/plastic_ice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/random.hpp"
#include "geo/kernels/landscape/stream_power.hpp"
#include "geo/kernels/numerics/area_sum.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "support/ice.hpp"
#include "support/terrain.hpp"

namespace geo {
namespace {

constexpr double kIce_m = 9.0;  // k = 80 kPa / (910 kg m-3 9.81 m s-2)

std::vector<IceGround> all_iced(const Grid& grid) {
  return std::vector<IceGround>(grid.size(), IceGround::iced);
}

/// Ice with a margin along the first column; the largest error against sqrt(2 k x), over its
/// height.
double error_of_parabola(int nx, bool along_rows) {
  constexpr double kLength_m = 1e6;
  const double dx = kLength_m / (nx - 1);
  const Grid grid = along_rows ? Grid::plane(nx, 5, dx, 1.7 * dx, Edges::closed)
                               : Grid::plane(5, nx, 1.7 * dx, dx, Edges::closed);
  std::vector<IceGround> ground = all_iced(grid);
  std::vector<float> bed(grid.size(), 0.0F);
  const auto steps_of = [&](Index c) { return along_rows ? grid.column(c) : grid.row(c); };
  for (Index c = 0; c < grid.size(); ++c) {
    if (steps_of(c) == 0) ground[c] = IceGround::away;
  }
  const IceSurface surface = plastic_ice_surface(grid, kIce_m, bed, ground);
  double worst = 0.0;
  const double whole = std::sqrt(2.0 * kIce_m * kLength_m);
  for (Index c = 0; c < grid.size(); ++c) {
    const double exact = std::sqrt(2.0 * kIce_m * steps_of(c) * dx);
    worst = std::max(worst, std::abs(surface.height_m[c] - exact) / whole);
  }
  return worst;
}

TEST(PlasticIce, LevelBedGivesNyesParabola) {
  for (const bool along_rows : {true, false}) {
    // Where the parabola rises like a wall a first cell is off by a share of sqrt(2 k dx): order
    // 1/2 at the margin itself.
    const double coarse = error_of_parabola(101, along_rows);
    const double fine = error_of_parabola(1601, along_rows);
    EXPECT_LT(fine, 0.009);
    EXPECT_NEAR(std::log2(coarse / fine) / 4.0, 0.5, 0.05);
  }
}

/// Upwind differences lose H (dH)² / k of each cell's rise: summed, that share of the height after
/// n cells.
double error_after(double cells) { return (std::log(cells) + 2.5) / (8.0 * cells); }

TEST(PlasticIce, CapOverThePoleIsRoundAndRisesAsSqrtOfTheWayFromItsMargin) {
  const Grid grid = Grid::sphere(360, 180);
  std::vector<IceGround> ground = all_iced(grid);
  const std::vector<float> bed(grid.size(), 0.0F);
  constexpr double kMargin_deg = 69.5;  // a row of cells
  for (Index c = 0; c < grid.size(); ++c) {
    if (grid.latitude_deg(grid.row(c)) <= kMargin_deg + 1e-9) ground[c] = IceGround::away;
  }
  const IceSurface surface = plastic_ice_surface(grid, kIce_m, bed, ground);
  const std::vector<float> height_m = surface.height_m.on_cells();
  for (int j = 0; j < grid.ny(); ++j) {
    if (grid.latitude_deg(j) < kMargin_deg + 5.0) continue;
    const double way_m =
        grid.figure().radius_m * (grid.latitude_deg(j) - kMargin_deg) * std::numbers::pi / 180.0;
    const double exact = std::sqrt(2.0 * kIce_m * way_m);
    const auto row = std::span(height_m).subspan(grid.cell(0, j), grid.nx());
    const auto [low, high] = std::minmax_element(row.begin(), row.end());
    EXPECT_LT(*high - *low, 1e-3 * exact) << grid.latitude_deg(j);
    EXPECT_NEAR(*low, exact, error_after(grid.latitude_deg(j) - kMargin_deg) * exact)
        << grid.latitude_deg(j);
  }
}

TEST(PlasticIce, CapOfAnyPlaceIsAsRound) {
  // Margin at 12 degrees from a place at 75 degrees north, where cells are slivers.
  const Grid grid = Grid::sphere(720, 360);
  std::vector<IceGround> ground = all_iced(grid);
  const std::vector<float> bed(grid.size(), 0.0F);
  constexpr double kRadians = std::numbers::pi / 180.0;
  const auto angle = [&](Index c) {
    const auto at = grid.unit_vector(grid.column(c), grid.row(c));
    return std::acos(
        std::clamp(at[0] * std::cos(75 * kRadians) + at[2] * std::sin(75 * kRadians), -1.0, 1.0));
  };
  for (Index c = 0; c < grid.size(); ++c) {
    if (angle(c) >= 12.0 * kRadians) ground[c] = IceGround::away;
  }
  const IceSurface surface = plastic_ice_surface(grid, kIce_m, bed, ground);
  for (Index c = 0; c < grid.size(); ++c) {
    if (angle(c) > 9.0 * kRadians) continue;
    const double exact =
        std::sqrt(2.0 * kIce_m * grid.figure().radius_m * (12.0 * kRadians - angle(c)));
    // The margin is a stair of cells: it lies up to half a cell nearer.
    const double cells = (12.0 - angle(c) / kRadians) / 0.5;
    EXPECT_NEAR(surface.height_m[c], exact, (error_after(cells) + 0.25 / cells) * exact)
        << grid.row(c) << ' ' << grid.column(c);
  }
}

TEST(PlasticIce, OnASlopeIsAsThickAsStressOverSlope) {
  const Grid grid = Grid::plane(200, 5, 500.0, 500.0, Edges::closed);
  std::vector<float> bed(grid.size());
  std::vector<IceGround> ground = all_iced(grid);
  constexpr double kSlope = 0.08;
  for (Index c = 0; c < grid.size(); ++c) {
    bed[c] = static_cast<float>(kSlope * 500.0 * grid.column(c));
    if (grid.column(c) == 0) ground[c] = IceGround::away;
  }
  const IceSurface surface = plastic_ice_surface(grid, kIce_m, bed, ground);
  const Index top = grid.cell(199, 2);
  EXPECT_NEAR(surface.height_m[top] - bed[top], kIce_m / kSlope, 0.1);
}

TEST(PlasticIce, BareGroundIsThatOfWaterThatLeaves) {
  for (const Grid& grid : test::small_grids()) {
    const auto z = test::random_terrain(grid, 4);
    std::vector<IceGround> ground(grid.size(), IceGround::bare);
    std::vector<std::uint8_t> outlets(grid.size(), 0);
    for (Index c = 0; c < grid.size(); ++c) {
      if (z[c] < 0.0F) ground[c] = IceGround::away, outlets[c] = 1;
    }
    const IceSurface surface = plastic_ice_surface(grid, kIce_m, z, ground);
    std::vector<float> filled(z.size());
    std::vector<float> dry(z);
    for (float& height : dry) height = std::max(0.0F, height);
    fill_depressions(grid, dry, outlets, filled);
    EXPECT_EQ(surface.height_m.on_cells(), filled);
  }
}

TEST(PlasticIce, EveryCellComesAfterTheOneThatItWasReachedFrom) {
  for (const Grid& grid : test::small_grids()) {
    const auto z = test::random_terrain(grid, 6);
    std::vector<IceGround> ground(grid.size());
    std::int64_t ice = 0;
    for (Index c = 0; c < grid.size(); ++c) {
      ground[c] = z[c] < 0.0F ? IceGround::away : c % 3 == 0 ? IceGround::bare : IceGround::iced;
      ice += ground[c] == IceGround::away ? 0 : 1;
    }
    const IceSurface surface = plastic_ice_surface(grid, kIce_m, z, ground);
    EXPECT_EQ(static_cast<std::int64_t>(surface.order.size()), ice);
    std::vector<int> place(grid.size(), -1);
    for (std::size_t n = 0; n < surface.order.size(); ++n) place[surface.order[n]] = int(n);
    for (const Index c : surface.order) {
      EXPECT_LT(place[surface.lowest[c]], place[c]);
      EXPECT_GE(surface.height_m[c], surface.height_m[surface.lowest[c]]);
      if (ground[c] == IceGround::iced) EXPECT_GT(surface.height_m[c], z[c]);
    }
  }
}

TEST(PlasticIce, SnowMeltAndCalvingCloseOnAnyRelief) {
  for (const Grid& grid : test::small_grids()) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      const auto z = test::random_terrain(grid, seed);
      const RandomStream random(seed, "snow");
      std::vector<IceGround> ground(grid.size());
      std::vector<float> balance(grid.size());
      for (Index c = 0; c < grid.size(); ++c) {
        ground[c] = z[c] < 0.0F ? IceGround::away : IceGround::iced;
        balance[c] = static_cast<float>(random.normal(c));
      }
      const IceSurface surface = plastic_ice_surface(grid, kIce_m, z, ground);
      const IceFlux flux = ice_flux(grid, z, ground, surface, test::of_surface(surface, balance));
      double snow = 0.0;
      for (Index c = 0; c < grid.size(); ++c) {
        if (z[c] >= 0.0F) snow += std::max(0.0F, balance[c]) * grid.area_m2(grid.row(c));
      }
      EXPECT_NEAR(flux.accumulated_m3_yr, snow, 1e-12 * snow) << seed;
      EXPECT_NEAR(flux.melted_m3_yr + flux.calved_m3_yr, snow, 1e-12 * snow) << seed;
      EXPECT_GT(flux.melted_m3_yr, 0.0);
      EXPECT_GT(flux.calved_m3_yr, 0.0);
    }
  }
}

TEST(PlasticIce, SeaFloorMakesNoIceOfItsOwn) {
  const Grid grid = Grid::plane(30, 30, 1000.0, 1000.0);
  std::vector<float> bed(grid.size(), -50.0F);
  std::vector<IceGround> ground(grid.size(), IceGround::bare);
  for (Index c = 0; c < grid.size(); ++c) {
    if (grid.column(c) == 0) ground[c] = IceGround::away;
  }
  const std::vector<float> snow(grid.size(), 1.0F);
  const IceSurface surface = plastic_ice_surface(grid, kIce_m, bed, ground);
  EXPECT_EQ(ice_flux(grid, bed, ground, surface, test::of_surface(surface, snow)).accumulated_m3_yr,
            0.0);
  bed[grid.cell(29, 15)] = 10.0F;  // an island feeds it
  const IceSurface with_island = plastic_ice_surface(grid, kIce_m, bed, ground);
  EXPECT_GT(
      ice_flux(grid, bed, ground, with_island, test::of_surface(with_island, snow)).calved_m3_yr,
      0.0);
}

TEST(PlasticIce, AGroundedSheetKeepsItsDivideOverABedBelowTheSea) {
  // A continent whose middle its ice has pressed below the sea: the divide, to which none flows.
  const Grid grid = Grid::plane(41, 41, 1e4, 1e4);
  std::vector<float> bed(grid.size());
  std::vector<IceGround> ground = all_iced(grid);
  for (Index c = 0; c < grid.size(); ++c) {
    const int from_edge =
        std::min({grid.column(c), 40 - grid.column(c), grid.row(c), 40 - grid.row(c)});
    bed[c] = from_edge > 10 ? -300.0F : 50.0F;
    if (from_edge == 0) ground[c] = IceGround::away;
  }
  const std::vector<float> snow(grid.size(), 0.2F);
  const IceSurface surface = plastic_ice_surface(grid, kIce_m, bed, ground);
  const IceFlux flux = ice_flux(grid, bed, ground, surface, test::of_surface(surface, snow));
  double fallen_m3_yr = 0.0;
  for (Index c = 0; c < grid.size(); ++c) {
    if (ground[c] == IceGround::away) continue;
    EXPECT_EQ(flux.share.of(c), 1.0F) << grid.column(c) << " " << grid.row(c);
    fallen_m3_yr += 0.2F * grid.area_m2(grid.row(c));
  }
  EXPECT_NEAR(flux.accumulated_m3_yr, fallen_m3_yr, 1e-9 * fallen_m3_yr);
}

/// Volume and area of each glacier: ice that leaves by one tongue.
std::vector<std::pair<double, double>> glaciers_of(const Grid& grid, const IceSurface& surface,
                                                   const IceFlux& flux, std::span<const float> bed,
                                                   std::span<const IceGround> ground) {
  std::vector<Index> end(grid.size(), kNoCell);
  std::map<Index, std::pair<double, double>> glaciers;
  for (const Index c : surface.order) {
    if (ground[c] != IceGround::iced || flux.share[c] <= 0.0F) continue;
    Index to = surface.lowest[c];
    double most = 0.0;
    IceOutflow(grid, surface).visit(c, [&](Index other, double part) {
      if (part > most) most = part, to = other;
    });
    end[c] = end[to] == kNoCell ? c : end[to];
    const double area = flux.share[c] * grid.area_m2(grid.row(c));
    auto& [volume, covered] = glaciers[end[c]];
    covered += area;
    volume += area * (surface.height_m[c] - bed[c]);
  }
  std::vector<std::pair<double, double>> all;
  for (const auto& [cell, glacier] : glaciers) all.push_back(glacier);
  return all;
}

double exponent_of(const std::vector<std::pair<double, double>>& glaciers, double least_m2) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [volume, area] : glaciers) {
    if (area < least_m2) continue;
    const double a = std::log(area), v = std::log(volume);
    n += 1, x += a, y += v, xx += a * a, xy += a * v;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

TEST(PlasticIce, RoundCapsHoldVolumeAsAreaToTheFiveQuarters) {
  const Grid grid = Grid::plane(300, 300, 1000.0, 1000.0);
  const std::vector<float> bed(grid.size(), 0.0F);
  std::vector<std::pair<double, double>> caps;
  for (const double radius : {20e3, 40e3, 80e3, 140e3}) {
    std::vector<IceGround> ground(grid.size(), IceGround::away);
    for (Index c = 0; c < grid.size(); ++c) {
      if (std::hypot(grid.x_m(grid.column(c)), grid.y_m(grid.row(c))) < radius) {
        ground[c] = IceGround::iced;
      }
    }
    const IceSurface surface = plastic_ice_surface(grid, kIce_m, bed, ground);
    double volume = 0.0, area = 0.0;
    for (Index c = 0; c < grid.size(); ++c) {
      if (ground[c] != IceGround::iced) continue;
      volume += 1e6 * surface.height_m[c], area += 1e6;
    }
    caps.emplace_back(volume, area);
  }
  // Bahr (1997): 1.25 for ice caps; cells of a kilometre are a twentieth of the smallest.
  EXPECT_NEAR(exponent_of(caps, 0.0), 1.25, 0.02);
}

TEST(PlasticIce, ValleyGlaciersScaleAsThoseOfTheEarth) {
  // Mountains in a steady state of uplift and rivers, 60 km wide, with a snow line at half height.
  const Grid grid = Grid::plane(200, 200, 300.0, 300.0);
  std::vector<std::uint8_t> outlets(grid.size(), 0);
  const RandomStream random(11, "mountains");
  std::vector<float> z(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    const bool edge = grid.is_open_edge(grid.column(c), grid.row(c));
    outlets[c] = edge ? 1 : 0;
    z[c] = edge ? 0.0F : static_cast<float>(1.0 + random.uniform(c));
  }
  const StreamPower law{.area_exponent = 0.5, .slope_exponent = 1.0, .dt_yr = 1e5};
  const std::vector<float> erodibility(grid.size(), 1e-5F);
  for (int step = 0; step < 120; ++step) {
    for (Index c = 0; c < grid.size(); ++c) z[c] += outlets[c] != 0 ? 0.0F : 100.0F;
    const FlowGraph graph = route_water(grid, z, outlets).graph;
    std::vector<double> area(grid.size(), 9e4);
    graph.accumulate(area);
    incise<float, float>(grid, graph, area, erodibility, law, z);
  }
  const float top = *std::max_element(z.begin(), z.end());
  std::vector<std::pair<double, double>> glaciers;
  for (const double line : {0.35, 0.5, 0.65}) {
    std::vector<IceGround> ground(grid.size());
    std::vector<float> balance(grid.size());
    for (Index c = 0; c < grid.size(); ++c) {
      ground[c] = outlets[c] != 0 ? IceGround::away : IceGround::bare;
    }
    IceSurface surface;
    IceFlux flux;
    std::vector<IceGround> used;
    for (int round = 0; round < 6; ++round) {
      used = ground;
      surface = plastic_ice_surface(grid, kIce_m, z, ground);
      for (Index c = 0; c < grid.size(); ++c) {
        balance[c] = std::min(2.0F, 0.006F * (surface.height_m[c] - float(line) * top));
      }
      flux = ice_flux(grid, z, ground, surface, test::of_surface(surface, balance));
      for (Index c = 0; c < grid.size(); ++c) {
        if (ground[c] == IceGround::away) continue;
        ground[c] = flux.share[c] > 0.02F ? IceGround::iced : IceGround::bare;
      }
    }
    const auto found = glaciers_of(grid, surface, flux, z, used);
    glaciers.insert(glaciers.end(), found.begin(), found.end());
  }
  const double exponent = exponent_of(glaciers, 2e6);
  RecordProperty("exponent", std::to_string(exponent));
  // Theory: 1.375 for valley glaciers, 1.25 for caps (Bahr et al. 1997). These fill whole valleys
  // of a relief that no ice has shaped, and are a little of both: 1.26 to 1.34 with the cell size.
  EXPECT_NEAR(exponent, 1.375, 0.1);
}

TEST(PlasticIce, WantsFieldsThatFitAndAStress) {
  const Grid grid = Grid::plane(4, 4, 1.0, 1.0);
  const std::vector<float> bed(16, 0.0F);
  EXPECT_THROW((void)plastic_ice_surface(grid, 0.0, bed, all_iced(grid)), InputError);
  EXPECT_THROW((void)plastic_ice_surface(grid, 1.0, std::span(bed).first(3), all_iced(grid)),
               InputError);
}

}  // namespace
}  // namespace geo
