// What floodplains have on them after rivers have laid them.
#include "stages/island/island_floodplain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geo/kernels/landscape/surface_detail.hpp"
#include "stages/island/island_cells.hpp"

namespace geo {
namespace {

constexpr Centre kCentre{20.0, 10.0};
constexpr int kCells = 200;

struct Window {
  Grid coarse = Grid::sphere(256, 128);
  Grid fine = Grid::equal_area(kCells, kCells, 400.0, kCentre);
  PlanetCells cells{coarse, fine};
  std::vector<std::uint8_t> held;
  Window() : held(fine.size()) {}
};

double deviation_m(std::span<const float> z, std::span<const float> before) {
  double square_m2 = 0.0;
  for (std::size_t c = 0; c < z.size(); ++c) square_m2 += (z[c] - before[c]) * (z[c] - before[c]);
  return std::sqrt(square_m2 / static_cast<double>(z.size()));
}

// A plain that falls by a metre in ten kilometres.
TEST(IslandFloodplain, EvenGroundGetsTheLeastRoughness) {
  const Window window;
  std::vector<float> plain(window.fine.size());
  for (Index c = 0; c < window.fine.size(); ++c) {
    plain[c] = static_cast<float>(50.0 + 0.04 * window.fine.column(c));
  }
  const IslandParameters p;
  auto z = plain;
  roughen_floodplains(window.cells, p, 7, window.held, z);
  const double least_m = plain_roughness_m(p, plain_law(window.cells, 400.0));
  EXPECT_NEAR(deviation_m(z, plain) / least_m, 1.0, 0.15);
}

TEST(IslandFloodplain, RoughGroundStaysAsItIs) {
  const Window window;
  std::vector<float> hills(window.fine.size());
  unit_detail(window.fine, plain_law(window.cells, 400.0), 3, "hills", hills);
  for (float& z : hills) z = 500.0F + 50.0F * z;
  auto z = hills;
  roughen_floodplains(window.cells, {}, 7, window.held, z);
  EXPECT_LT(deviation_m(z, hills), 0.02);
}

TEST(IslandFloodplain, LandStaysLandTheSeaItsFloorAndHeldCellsTheirHeight) {
  Window window;
  std::vector<float> shore(window.fine.size());
  for (Index c = 0; c < window.fine.size(); ++c) {
    shore[c] = window.fine.column(c) < kCells / 2 ? -3.0F : 0.1F;
    window.held[c] = window.fine.row(c) % 5 == 0 ? 1 : 0;
  }
  auto z = shore;
  roughen_floodplains(window.cells, {}, 7, window.held, z);
  double changed = 0.0;
  for (Index c = 0; c < window.fine.size(); ++c) {
    if (shore[c] < 0.0F || window.held[c] != 0) {
      ASSERT_EQ(z[c], shore[c]);
    } else {
      ASSERT_GE(z[c], 0.0F);
      changed += z[c] != shore[c] ? 1.0 : 0.0;
    }
  }
  EXPECT_GT(changed, 0.3 * window.fine.size());
}

}  // namespace
}  // namespace geo
