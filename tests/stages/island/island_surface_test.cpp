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

}  // namespace
}  // namespace geo
