// Detail of fine surfaces.
#include "geo/kernels/landscape/surface_detail.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace geo {
namespace {

TEST(SurfaceDetail, DetailHasUnitVarianceAndNoEdge) {
  const Grid fine = Grid::equal_area(256, 128, 400.0, Centre{30, 40});
  std::vector<float> detail(fine.size());
  unit_detail(fine, {}, 3, "island.detail", detail);
  double sum = 0.0, squares = 0.0;
  for (const float value : detail) {
    sum += value;
    squares += value * value;
  }
  EXPECT_NEAR(sum / fine.size(), 0.0, 0.35);
  EXPECT_NEAR(squares / fine.size(), 1.0, 0.5);
}

TEST(SurfaceDetail, ASingleMountIsRoughAllRoundNotInASquare) {
  const Grid planet = Grid::sphere(360, 180);
  const Grid fine = Grid::equal_area(128, 64, 8000.0, Centre{0.5, 0.5});
  const PlanetCells cells(planet, fine);
  std::vector<float> z(planet.size(), -4000.0F);
  const int i = 180, j = 90;
  z[planet.cell(i, j)] = -2000.0F;
  std::vector<float> rough_m(cells.size());
  local_roughness(cells, z, rough_m);
  const auto there_m = [&](int di, int dj) { return rough_m[cells.at(i + di, j + dj)]; };
  EXPECT_NEAR(there_m(1, 0), there_m(0, 1), 1.0);
  EXPECT_GT(there_m(0, 0), 1.2 * there_m(1, 0));
  EXPECT_GT(there_m(1, 0), 1.2 * there_m(1, 1));
  EXPECT_GT(there_m(1, 1), 0.0);
  EXPECT_EQ(there_m(3, 0), 0.0);
}

}  // namespace
}  // namespace geo
