// Boundaries of plates, and the crust that they make and consume.
#include "geo/kernels/plates/plate_boundaries.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "geo/core/random.hpp"
#include "geo/kernels/plates/growth/plate_growth.hpp"
#include "geo/kernels/remapping/cubed_sphere.hpp"
#include "kernels/plates/two_hemispheres.hpp"

namespace geo {
namespace {

using test::TwoHemispheres;

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kRadius_km = 6371.0;

TEST(PlateBoundaries, ClassesFollowTheTable) {
  constexpr double kSpeed_cm_yr = 4.0;  // scale 5 cm/yr = 50 mm/yr: limits 7 and 9 mm/yr
  using enum BoundaryType;
  EXPECT_EQ(classify({7.1, 0, 9.0}, kSpeed_cm_yr), convergent);
  EXPECT_EQ(classify({6.9, 0, 0}, kSpeed_cm_yr), interior);
  EXPECT_EQ(classify({0, 7.1, 9.0}, kSpeed_cm_yr), divergent);
  EXPECT_EQ(classify({7.1, 0, 9.6}, kSpeed_cm_yr), transform);  // 0.75 x 9.6 = 7.2
  EXPECT_EQ(classify({0, 30.0, 41.0}, kSpeed_cm_yr), transform);
  EXPECT_EQ(classify({0, 0, 8.9}, kSpeed_cm_yr), interior);
  EXPECT_EQ(classify({0, 0, 9.1}, kSpeed_cm_yr), transform);
  EXPECT_EQ(classify({1.7, 0, 0}, 0.5), convergent);  // slow plates: scale 12 mm/yr
  EXPECT_EQ(classify({1.6, 0, 0}, 0.5), interior);
}

TEST(PlateBoundaries, MotionSplitsAcrossAndAlong) {
  const Vector3 here{1, 0, 0}, east{0, 1, 0};
  const auto closing = relative_motion({0, 20, 5}, {0, -10, 1}, east, here);
  EXPECT_DOUBLE_EQ(closing.closing, 30.0);
  EXPECT_DOUBLE_EQ(closing.opening, 0.0);
  EXPECT_DOUBLE_EQ(closing.shear, 4.0);
  EXPECT_DOUBLE_EQ(relative_motion({0, -20, 0}, {0, 10, 0}, east, here).opening, 30.0);
}

TEST(PlateBoundaries, TwoHemispheresPartOnOneSideAndCloseOnTheOther) {
  const TwoHemispheres two;
  const auto points = find_boundaries(two.mesh, two.plate, two.rotation, 2.0, 430.0, kRadius_km);
  ASSERT_GT(points.size(), 300U);
  for (const BoundaryPoint& point : points) {
    const Vector3& p = two.mesh.position(point.cell);
    const double latitude_deg = std::asin(p[2]) / kRadians;
    if (std::abs(latitude_deg) > 55.0) continue;  // slow near the poles of rotation
    EXPECT_EQ(point.type, p[0] > 0.0 ? BoundaryType::divergent : BoundaryType::convergent);
    const double rate = 0.008 * kRadius_km * std::cos(latitude_deg * kRadians);
    EXPECT_NEAR(point.motion.closing + point.motion.opening, rate, 0.05 * rate);
    EXPECT_GT(std::abs(point.towards[1]), 0.9);
    EXPECT_LE(point.strength, 1.0);
  }
}

TEST(CrustBudget, OfTwoHemispheresIsTheirGreatCirclesHoweverItLies) {
  // Half a great circle opens, half closes: the flux through each half is 2 R² of the rotation in
  // its plane. A rotation across the plane slides along it and makes nothing. The steps of the mesh
  // put the ends of the halves a cell off at most, on either side.
  for (std::uint64_t k = 0; k < 10; ++k) {
    const RandomStream random(7, "hemispheres");
    const Vector3 normal = random.direction(2 * k);
    const Vector3 turn = scaled(random.direction(2 * k + 1), 0.008);
    TwoHemispheres two;
    for (std::int32_t cell = 0; cell < two.mesh.size(); ++cell) {
      two.plate[cell] = dot(two.mesh.position(cell), normal) > 0.0 ? 0 : 1;
    }
    two.rotation = {turn, {0, 0, 0}};
    const auto points = find_boundaries(two.mesh, two.plate, two.rotation, 2.0, 430.0, kRadius_km);
    const auto crust = crust_budget(two.mesh, two.plate, points, two.rotation, kRadius_km);
    const double km2_yr = 1e-6 * kRadius_km * kRadius_km;
    const double expected = 2.0 * km2_yr * length(tangent(turn, normal));
    const double ends = 2.0 * km2_yr * length(turn) * two.mesh.spacing();
    EXPECT_NEAR(crust.created, crust.consumed, 1e-12) << "pair " << k;
    EXPECT_NEAR(crust.created, expected, ends) << "pair " << k;
  }
}

TEST(CrustBudget, OfGrownPlatesClosesToRoundOff) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const CubedSphere mesh(48);
    const PlateGrowth model;
    const auto plates = draw_plates(model, seed);
    const auto plate = grow_plates(model, mesh, plates, seed);
    std::vector<Vector3> rotation;
    for (const Plate& one : plates) rotation.push_back(one.rotation_rad_myr);
    const auto points = find_boundaries(mesh, plate, rotation, 5.0, 430.0, kRadius_km);
    const auto crust = crust_budget(mesh, plate, points, rotation, kRadius_km);
    EXPECT_GT(crust.created, 1.0) << "seed " << seed;
    EXPECT_NEAR(crust.created, crust.consumed, 1e-12 * crust.created) << "seed " << seed;
  }
}

TEST(PlateBoundaries, OfSmallPlanetsAreTakenOverNoMoreThanPartOfThem) {
  const TwoHemispheres two;
  const double widest_km = kWidestSmoothing_rad * kRadius_km;
  const auto widest =
      find_boundaries(two.mesh, two.plate, two.rotation, 2.0, widest_km, kRadius_km);
  const auto wider =
      find_boundaries(two.mesh, two.plate, two.rotation, 2.0, 1e4 * widest_km, kRadius_km);
  ASSERT_EQ(widest.size(), wider.size());
  for (std::size_t k = 0; k < widest.size(); ++k) {
    ASSERT_EQ(widest[k].towards, wider[k].towards);
    ASSERT_EQ(widest[k].type, wider[k].type);
  }
}

TEST(NearestCells, AreNearestByGreatCircle) {
  const CubedSphere mesh(40);
  std::vector<std::int32_t> sources;
  for (std::uint64_t k = 0; k < 25; ++k) {
    sources.push_back(mesh.locate(RandomStream(9, "sources").direction(k)));
  }
  const auto nearest = nearest_cells(mesh, sources);
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    double least = 10.0;
    for (const std::int32_t source : sources) {
      least = std::min(least, angle_between(mesh.position(cell), mesh.position(source)));
    }
    ASSERT_NEAR(nearest.angle[cell], least, 0.02 * mesh.spacing());
  }
  const auto near = nearest_cells(mesh, sources, 0.1);
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    ASSERT_EQ(near.source[cell] >= 0, near.angle[cell] <= 0.1F);
  }
}

}  // namespace
}  // namespace geo
