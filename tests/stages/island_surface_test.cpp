// The surface of an island before any erosion, on planets made for the purpose.
#include "stages/island/island_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geo/kernels/water/depressions.hpp"

namespace geo {
namespace {

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
  Surface made{Grid::equal_area(p.nx, p.ny, p.cell_m, {20.0, 10.0}), {}, {}};
  made.planet_m.resize(made.fine.size());
  made.elevation_m.resize(made.fine.size());
  PlanetTerrain planet;
  planet.elevation_m = elevation_m;
  raise_island(PlanetCells(coarse, made.fine), planet, p, nullptr, seed, made.planet_m,
               made.elevation_m);
  return made;
}

// The edge keeps the planet's height, a few metres, and the detail dips the ground behind it below
// the sea: a plain at the level of the sea would be a lake as wide as the window.
TEST(IslandSurface, PlainsThatTheEdgeHoldsClosedRiseFromThere) {
  const Grid coarse = Grid::sphere(256, 128);
  std::vector<float> plain(coarse.size());
  for (Index c = 0; c < coarse.size(); ++c) plain[c] = 2.0F + 3.0F * static_cast<float>(std::abs(coarse.latitude_deg(coarse.row(c)) - 20.0));
  IslandParameters p = window();
  p.least_roughness_m = 20.0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Surface made = raise(coarse, plain, p, seed);
    std::vector<std::uint8_t> outlets(made.fine.size());
    for (Index c = 0; c < made.fine.size(); ++c) {
      outlets[c] = made.fine.is_open_edge(made.fine.column(c), made.fine.row(c)) ? 1 : 0;
    }
    std::vector<float> filled(made.fine.size());
    fill_depressions(made.fine, made.elevation_m, outlets, filled);
    double under = 0.0;
    for (Index c = 0; c < made.fine.size(); ++c) {
      EXPECT_GE(made.elevation_m[c], 0.0F);
      if (filled[c] > made.elevation_m[c] + 1.0F) under += 1.0;
    }
    std::printf("under %g\n", under / made.fine.size());
  }
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
  const auto own = cells.means(made.elevation_m, {}, 0.0F), planets = cells.means(made.planet_m, {}, 0.0F);
  double square = 0.0, bias = 0.0, n = 0.0;
  for (std::size_t k = 0; k < own.size(); ++k) {
    square += (own[k] - planets[k]) * (own[k] - planets[k]); bias += own[k] - planets[k]; n += 1.0;
  }
  std::printf("rms %g bias %g n %g\n", std::sqrt(square / n), bias / n, n);
}

}  // namespace
}  // namespace geo
