// Where on a planet an island is worth looking at.
#include "geo/kernels/landscape/region_score.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geo/kernels/noise/noise.hpp"

namespace geo {
namespace {

TEST(RegionScore, IsTheFormulaOverTrueAreas) {
  const Grid planet = Grid::sphere(72, 36);
  const Noise noise(4, "heights");
  std::vector<float> z(planet.size());
  std::vector<std::int8_t> boundary(planet.size());
  for (Index cell = 0; cell < planet.size(); ++cell) {
    z[cell] = 9000.0F * noise.fbm(planet.unit_vector(planet.column(cell), planet.row(cell)), 2, 4);
    boundary[cell] = static_cast<std::int8_t>(cell % 7 == 0);
  }
  const Index centre = planet.cell(1, 26);  // the window wraps round
  const double width_m = 4e6, height_m = 2.2e6;
  const auto figures = region_figures(planet, z, boundary, centre, width_m, height_m);
  // Every window of odd size about the centre: one of them is meant.
  bool found = false;
  for (int rows = 1; rows <= 9; ++rows) {
    for (int columns = 1; columns <= 21; ++columns) {
      double area = 0, land = 0, coast = 0, edge = 0, low = 1e9, high = -1e9;
      for (int dj = 0; dj < rows; ++dj) {
        for (int di = 0; di < columns; ++di) {
          const int j = 26 - rows / 2 + dj, i = (1 - columns / 2 + di + 72) % 72;
          const Index cell = planet.cell(i, j);
          const double a = planet.area_m2(j);
          bool shore = false;
          for (const int k : {0, 2, 4, 6}) shore |= z[planet.neighbour(i, j, k)] < 0.0F;
          area += a;
          land += z[cell] >= 0.0F ? a : 0.0;
          coast += z[cell] >= 0.0F && shore ? a : 0.0;
          edge += boundary[cell] != 0 ? a : 0.0;
          low = std::min<double>(low, z[cell]);
          high = std::max<double>(high, z[cell]);
        }
      }
      if (std::abs(figures.land_fraction - land / area) > 1e-9 ||
          std::abs(figures.coast_fraction - coast / area) > 1e-9 ||
          std::abs(figures.boundary_fraction - edge / area) > 1e-9 ||
          std::abs(figures.elevation_range_m - (high - low)) > 0.01) {
        continue;
      }
      found = true;
      const double expected = (1.0 - std::abs(land / area - 0.4) * 2.5) * (coast / area) *
                                  std::min((high - low) / 5000.0, 1.0) *
                                  (1.0 + 2.0 * std::min(edge / area, 0.5)) +
                              0.3 * 0.25;
      EXPECT_NEAR(figures.score(0.25), expected, 1e-9);
      const double across_m = columns * planet.spacing_east_m(26);
      const double circumference_m = 2.0 * (across_m + area / across_m);
      const double shore = coast / planet.spacing_north_m(26) / circumference_m;
      EXPECT_NEAR(figures.coast_share, shore, 0.01 * shore);
      EXPECT_NEAR(figures.appeal(0.25) - 0.001 * 0.25,
                  (expected - 0.3 * 0.25) * area / coast * std::min(figures.coast_share, 1.0) *
                      (1.0 + 0.3 * 0.25),
                  1e-9);
    }
  }
  EXPECT_TRUE(found);
}

TEST(RegionScore, FindsTheCoastAndKeepsAwayFromThePoles) {
  const Grid planet = Grid::sphere(144, 72);
  std::vector<float> z(planet.size(), -3000.0F);
  for (int j = 30; j < 44; ++j) {
    for (int i = 60; i < 80; ++i) z[planet.cell(i, j)] = (i + j) % 3 == 0 ? 4000.0F : 300.0F;
  }
  for (int i = 0; i < 144; ++i) z[planet.cell(i, 70)] = 5000.0F;
  int near = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Index best = best_region(planet, z, {}, 2e6, 1e6, seed);
    const int i = planet.column(best), j = planet.row(best);
    EXPECT_LT(std::abs(planet.latitude_deg(j)), 81.0);
    near += i >= 54 && i <= 86 && j >= 26 && j <= 48;
  }
  EXPECT_GE(near, 7);
}

// An islet that takes a tenth of the window, or an island that takes a third of it: on any grid.
TEST(RegionScore, PrefersTheLargerIslandHoweverFineTheCellsAre) {
  for (const int ny : {90, 180, 360}) {
    const Grid planet = Grid::sphere(2 * ny, ny);
    std::vector<float> z(planet.size(), -3000.0F);
    const auto raise = [&](double west, double east, double south, double north) {
      for (Index c = 0; c < planet.size(); ++c) {
        const double latitude = planet.latitude_deg(planet.row(c));
        const double longitude = planet.longitude_deg(planet.column(c));
        if (longitude > west && longitude < east && latitude > south && latitude < north) {
          z[c] = 1000.0F;
        }
      }
    };
    raise(-70.0, -62.0, -4.0, 4.0);
    raise(60.0, 72.0, -8.0, 8.0);
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const Index best = best_region(planet, z, {}, 3.2e6, 2.2e6, seed);
      EXPECT_GT(planet.longitude_deg(planet.column(best)), 0.0) << ny << " rows, seed " << seed;
    }
  }
}

/// A rectangle of land, cells from the middle of a planet of 360 x 180.
void raise_land(const Grid& planet, std::vector<float>& z, int west, int east, int south,
                int north) {
  for (int j = south; j <= north; ++j) {
    for (int i = west; i <= east; ++i) z[planet.cell(180 + i, 90 + j)] = 1000.0F;
  }
}

TEST(RegionLand, TellsIslandsFromCoastsAndStraits) {
  const Grid planet = Grid::sphere(360, 180);
  const double cell_m = planet.step_north_m();
  const Index centre = planet.cell(180, 90);
  const auto land = [&](auto... rectangles) {
    std::vector<float> z(planet.size(), -3000.0F);
    (raise_land(planet, z, rectangles[0], rectangles[1], rectangles[2], rectangles[3]), ...);
    return region_land(planet, z, centre, 21 * cell_m, 11 * cell_m);  // columns +-10, rows +-5
  };
  using Box = std::array<int, 4>;
  const RegionLand island = land(Box{-6, 4, -3, 3});
  EXPECT_DOUBLE_EQ(island.whole, 1.0);
  EXPECT_DOUBLE_EQ(island.weight(), 1.0);
  const RegionLand coast = land(Box{0, 40, -20, 20});
  EXPECT_DOUBLE_EQ(coast.main, 1.0);
  EXPECT_DOUBLE_EQ(coast.weight(), 0.6);
  const RegionLand strait = land(Box{3, 40, -20, 20}, Box{-40, -3, -20, 20});
  EXPECT_NEAR(strait.main, 0.5, 1e-9);
  EXPECT_NEAR(strait.others, 0.5, 1e-9);
  EXPECT_DOUBLE_EQ(strait.weight(), 0.0);
  // Lands that hang together beyond the window are two in it; those that touch at a corner one.
  const RegionLand bay = land(Box{3, 40, -20, 20}, Box{-40, -3, -20, 20}, Box{-40, 40, 15, 20});
  EXPECT_NEAR(bay.others, 0.5, 1e-9);
  EXPECT_DOUBLE_EQ(land(Box{1, 40, 1, 20}, Box{-40, 0, -20, 0}).main, 1.0);
  // An island off a coast.
  const RegionLand both = land(Box{5, 40, -20, 20}, Box{-6, -3, -2, 2});
  EXPECT_NEAR(both.whole, 20.0 / 86.0, 1e-3);
  EXPECT_DOUBLE_EQ(both.others, 0.0);
  EXPECT_DOUBLE_EQ(land().weight(), 1.0);
}

TEST(RegionScore, LooksForMuchLandThatIsWholeOrOneCoast) {
  const Grid planet = Grid::sphere(512, 256);
  const double width_m = 1.6e6, height_m = 0.8e6;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    const Noise noise(seed, "land");
    std::vector<float> z(planet.size());
    for (Index c = 0; c < planet.size(); ++c) {
      const auto place = planet.unit_vector(planet.column(c), planet.row(c));
      z[c] = 8000.0F * noise.fbm(place, 3.0, 6) - 700.0F;
    }
    const Index best = best_region(planet, z, {}, width_m, height_m, seed);
    EXPECT_LT(region_land(planet, z, best, width_m, height_m).others, 0.02);
    const auto figures = region_figures(planet, z, {}, best, width_m, height_m);
    EXPECT_NEAR(figures.land_fraction, 0.4, 0.2);
    EXPECT_GT(figures.coast_share, 0.3);
  }
}

TEST(RegionScore, WindowsOfOneCellStandOnLandAtTheShore) {
  const Grid planet = Grid::sphere(128, 64);
  std::vector<float> z(planet.size());
  const Noise noise(4, "land");
  for (Index c = 0; c < planet.size(); ++c) {
    const float wave = noise.fbm(planet.unit_vector(planet.column(c), planet.row(c)), 2.0, 4);
    z[c] = 8000.0F * wave - 1000.0F;
  }
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Index best = best_region(planet, z, {}, 100e3, 50e3, seed);
    int land = 0, sea = 0;
    for (int dj = -1; dj <= 1; ++dj) {
      for (int di = -1; di <= 1; ++di) {
        const int i = (planet.column(best) + di + planet.nx()) % planet.nx();
        (z[planet.cell(i, planet.row(best) + dj)] >= 0.0F ? land : sea) += 1;
      }
    }
    EXPECT_GT(land, 0) << "seed " << seed;
    EXPECT_GT(sea, 0) << "seed " << seed;
  }
}

}  // namespace
}  // namespace geo
