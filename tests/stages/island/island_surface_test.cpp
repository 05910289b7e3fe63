// The surface of an island before any erosion, on planets made for the purpose.
#include "stages/island/island_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace geo {
namespace {

constexpr Centre kCentre{20.0, 10.0};

struct Surface {
  Grid fine;
  std::vector<float> planet_m, elevation_m;
};

IslandParameters window() {
  IslandParameters p;
  p.nx = 160;
  p.ny = 160;
  p.cell_m = 5000.0;
  return p;
}

Surface raise(const Grid& coarse, std::span<const float> elevation_m, const IslandParameters& p,
              std::uint64_t seed) {
  Surface made{Grid::equal_area(p.nx, p.ny, p.cell_m, kCentre), {}, {}};
  made.planet_m.resize(made.fine.size());
  made.elevation_m.resize(made.fine.size());
  PlanetTerrain planet;
  planet.elevation_m = elevation_m;
  raise_island(PlanetCells(coarse, made.fine), planet, p, nullptr, seed, made.planet_m,
               made.elevation_m);
  return made;
}

// Bays and headlands have different slopes: what the one takes, the other does not give back.
TEST(IslandSurface, WindingCoastsKeepThePlanetsMeans) {
  const Grid coarse = Grid::sphere(256, 128);
  std::vector<float> coast(coarse.size());
  for (Index c = 0; c < coarse.size(); ++c) {
    const double x = std::sin(0.7 * coarse.column(c)) + std::sin(0.5 * coarse.row(c));
    coast[c] = static_cast<float>(x > 0.0 ? 1500.0 * x * x : 3000.0 * x);
  }
  IslandParameters p = window();
  p.detail_amplitude = p.least_roughness_m = 0.0;
  const Surface made = raise(coarse, coast, p, 5);
  const PlanetCells cells(coarse, made.fine);
  const auto own = cells.means(made.elevation_m, {}, 0.0F),
             planets = cells.means(made.planet_m, {}, 0.0F);
  double square_m2 = 0.0, bias_m = 0.0;
  for (std::size_t k = 0; k < own.size(); ++k) {
    square_m2 += (own[k] - planets[k]) * (own[k] - planets[k]);
    bias_m += own[k] - planets[k];
  }
  // 6 m where nothing is given back.
  EXPECT_LT(std::sqrt(square_m2 / own.size()), 4.0);
  EXPECT_LT(std::abs(bias_m / own.size()), 0.1);
}

// On low ground detail rises as far as it likes, and dips no deeper than the sea: alone it would
// lift a plain of 8 m to 17 m.
TEST(IslandSurface, LowCoastsKeepThePlanetsMeans) {
  const Grid coarse = Grid::sphere(256, 128);
  std::vector<float> coast(coarse.size());
  for (Index c = 0; c < coarse.size(); ++c) {
    const int i = coarse.column(c), j = coarse.row(c);
    const double x = std::sin(0.7 * i) + std::sin(0.5 * j);
    const double knoll_m = 12.0 * ((7 * i + 3 * j) % 5);
    coast[c] = static_cast<float>(x > -0.5 ? 4.0 + knoll_m : -60.0 + 20.0 * x);
  }
  const Surface made = raise(coarse, coast, window(), 5);
  const PlanetCells cells(coarse, made.fine);
  std::vector<float> inside(made.fine.size());
  for (Index c = 0; c < made.fine.size(); ++c) {
    const int i = made.fine.column(c), j = made.fine.row(c);
    inside[c] = std::min({i, made.fine.nx() - 1 - i, j, made.fine.ny() - 1 - j}) > 8 ? 1.0F : 0.0F;
  }
  const auto own = cells.means(made.elevation_m, {}, 0.0F),
             planets = cells.means(made.planet_m, {}, 0.0F), within = cells.means(inside, {}, 0.0F);
  int low = 0;
  double bias_m = 0.0;
  for (std::size_t k = 0; k < own.size(); ++k) {
    if (within[k] < 1.0F || planets[k] < 0.0F) continue;
    EXPECT_NEAR(own[k], planets[k], std::max(1.0, 0.1 * planets[k])) << "planet cell " << k;
    bias_m += own[k] - planets[k];
    ++low;
  }
  ASSERT_GT(low, 8);
  EXPECT_LT(std::abs(bias_m / low), 0.5);
}

}  // namespace
}  // namespace geo
