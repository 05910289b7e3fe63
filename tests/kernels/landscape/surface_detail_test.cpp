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

}  // namespace
}  // namespace geo
