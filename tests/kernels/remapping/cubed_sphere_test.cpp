// The cubed sphere, its sides and sampling between its cells.
#include "geo/kernels/remapping/cubed_sphere.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <vector>

#include "geo/core/random.hpp"
#include "geo/kernels/plates/growth/crust_age.hpp"
#include "geo/kernels/remapping/mesh_sampling.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(CubedSphereMesh, CellsFillTheSphereAndAreFoundAtTheirCentres) {
  for (const int n : {1, 2, 7, 40}) {
    const CubedSphere mesh(n);
    double area = 0.0, least = 1e9, most = 0.0;
    for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
      ASSERT_EQ(mesh.locate(mesh.position(cell)), cell);
      ASSERT_NEAR(length(mesh.position(cell)), 1.0, 1e-14);
      area += mesh.area_sr(cell);
      least = std::min(least, mesh.area_sr(cell));
      most = std::max(most, mesh.area_sr(cell));
    }
    EXPECT_NEAR(area, 4.0 * kPi, 1e-12);
    EXPECT_LT(most / least, 1.45);
  }
}

TEST(CubedSphereMesh, NeighboursAreNearAndMutual) {
  const CubedSphere mesh(24);
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    for (const std::int32_t next : mesh.neighbours(cell)) {
      ASSERT_LT(angle_between(mesh.position(cell), mesh.position(next)), 1.9 * mesh.spacing());
      ASSERT_NE(next, cell);
    }
    // Sides, not corners, lead back.
    for (const int k : {0, 2, 4, 6}) {
      const auto& back = mesh.neighbours(mesh.neighbours(cell)[k]);
      ASSERT_NE(std::find(back.begin(), back.end(), cell), back.end());
    }
  }
}

TEST(CubedSphereMesh, SidesCloseRoundEachCellAndAreSharedWithTheNext) {
  for (const int n : {1, 2, 7, 40}) {
    const CubedSphere mesh(n);
    for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
      const auto sides = mesh.sides(cell);
      const auto& around = mesh.neighbours(cell);
      for (int k = 0; k < CubedSphere::kSides; ++k) {
        ASSERT_EQ(sides[k].to, sides[(k + 1) % CubedSphere::kSides].from);
        // The cell lies to the left.
        ASSERT_GT(dot(cross(sides[k].from, sides[k].to), mesh.position(cell)), 0.0);
        ASSERT_NE(std::find(around.begin(), around.end(), sides[k].beyond), around.end());
        double mismatch = 9.0;
        for (const auto& back : mesh.sides(sides[k].beyond)) {
          if (back.beyond != cell) continue;
          mismatch = std::min(mismatch, length(add(back.from, sides[k].to, -1.0)) +
                                            length(add(back.to, sides[k].from, -1.0)));
        }
        ASSERT_LT(mismatch, 1e-14);
      }
    }
  }
}

TEST(CubedSphereMesh, SamplingIsContinuousAndKeepsConstants) {
  const CubedSphere mesh(32);
  std::vector<float> height(mesh.size());
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    height[cell] = static_cast<float>(100.0 * mesh.position(cell)[2]);
  }
  const RandomStream random(3, "places");
  for (std::uint64_t k = 0; k < 20000; ++k) {
    const Vector3 here = random.direction(k);
    const Vector3 there = normalised(add(here, random.direction(k + 100000), 1e-4));
    const double a = read(stencil_at(mesh, here), height),
                 b = read(stencil_at(mesh, there), height);
    ASSERT_NEAR(a, 100.0 * here[2], 1.5);
    ASSERT_NEAR(a, b, 0.3);  // a tenth of the step from cell to cell
  }
}

}  // namespace
}  // namespace geo
