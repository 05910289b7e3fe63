// The laws of tectonics on a sphere, with values worked out by hand.
#include "geo/kernels/plates/tectonic_laws.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "geo/kernels/numerics/quaternion.hpp"
#include "geo/kernels/plates/plate_motion.hpp"

namespace geo {
namespace {

void expect_near(const Vector3& a, const Vector3& b, double tolerance = 1e-12) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << "component " << c;
}

TEST(TectonicLaws, HaveTheConstantsOfTable3) {
  const TectonicConstants k;
  EXPECT_EQ(k.step_myr, 2.0);
  EXPECT_EQ(k.ridge_km, -1.0);
  EXPECT_EQ(k.abyss_km, -6.0);
  EXPECT_EQ(k.trench_km, -10.0);
  EXPECT_EQ(k.summit_km, 10.0);
  EXPECT_EQ(k.subduction_distance_km, 1800.0);
  EXPECT_EQ(k.collision_distance_km, 4200.0);
  EXPECT_EQ(k.collision_per_km, 1.3e-5);
  EXPECT_EQ(k.speed_mm_yr, 100.0);
  EXPECT_EQ(k.damping_mm_yr, 0.04);
  EXPECT_EQ(k.erosion_mm_yr, 0.03);
  EXPECT_EQ(k.accretion_mm_yr, 0.3);
  EXPECT_EQ(k.uplift_mm_yr, 0.6);
}

TEST(TectonicLaws, UpliftPeaksAtTheControlDistanceAndEndsAtTheReach) {
  EXPECT_EQ(uplift_by_distance(-1.0, 200.0, 1800.0), 0.0);
  EXPECT_EQ(uplift_by_distance(0.0, 200.0, 1800.0), 0.0);
  EXPECT_DOUBLE_EQ(uplift_by_distance(50.0, 200.0, 1800.0), 0.15625);  // 3/16 - 2/64
  EXPECT_DOUBLE_EQ(uplift_by_distance(100.0, 200.0, 1800.0), 0.5);
  EXPECT_DOUBLE_EQ(uplift_by_distance(200.0, 200.0, 1800.0), 1.0);
  EXPECT_DOUBLE_EQ(uplift_by_distance(1000.0, 200.0, 1800.0), 0.125);  // half way: 1/8
  EXPECT_EQ(uplift_by_distance(1800.0, 200.0, 1800.0), 0.0);
}

TEST(TectonicLaws, DriftworldsUpliftPeaksAtItsControlDistance) {
  // c = 1, r = 2: the denominator is (8 - 1) / 6 + (2 - 4) / 2 = 1/6, and above it stands
  // d^3 / 3 - 3 d^2 / 2 + 2 d + 8/6 - 2: -2/3 at 0, 1/3 - 3/2 + 2 - 2/3 = 1/6 at 1, 0 at 2.
  EXPECT_NEAR(uplift_by_distance_driftworld(0.0, 1.0, 2.0), -4.0, 1e-12);
  EXPECT_NEAR(uplift_by_distance_driftworld(1.0, 1.0, 2.0), 1.0, 1e-12);
  EXPECT_NEAR(uplift_by_distance_driftworld(1.5, 1.0, 2.0), 0.5, 1e-12);
  EXPECT_EQ(uplift_by_distance_driftworld(2.0, 1.0, 2.0), 0.0);
  // As in its table, 0.1 and 0.283 of the radius: rising from the trench.
  EXPECT_NEAR(uplift_by_distance_driftworld(0.0, 0.1, 0.283), -0.22216, 1e-5);
  EXPECT_NEAR(uplift_by_distance_driftworld(0.1, 0.1, 0.283), 1.0, 1e-12);
}

TEST(TectonicLaws, UpliftGrowsWithSpeedAndWithTheSquareOfElevation) {
  EXPECT_DOUBLE_EQ(uplift_by_speed(25.0, 100.0), 0.25);
  EXPECT_DOUBLE_EQ(uplift_by_elevation(-10.0, -10.0, 10.0), 0.0);
  EXPECT_DOUBLE_EQ(uplift_by_elevation(-6.0, -10.0, 10.0), 0.04);  // (4 / 20)^2
  EXPECT_DOUBLE_EQ(uplift_by_elevation(0.0, -10.0, 10.0), 0.25);
  EXPECT_DOUBLE_EQ(uplift_by_elevation(10.0, -10.0, 10.0), 1.0);
  EXPECT_DOUBLE_EQ(uplift_by_elevation(12.0, -10.0, 10.0), 1.0);
}

TEST(TectonicLaws, FoldsTurnTowardsTheRelativeMotion) {
  expect_near(turned_fold({1.0, 0.0, 0.0}, {0.0, 50.0, 0.0}, 0.01, 2.0), {1.0, 1.0, 0.0});
}

TEST(TectonicLaws, SlabPullTurnsThePlateTowardsItsFront) {
  // Centre on x, trench 30 degrees north: the axis that carries x to the north is -y.
  const double s = std::sin(std::numbers::pi / 6), c = std::cos(std::numbers::pi / 6);
  expect_near(slab_pull({1, 0, 0}, {c, 0, s}), {0, -1, 0});
  const Vector3 motion = cross(slab_pull({1, 0, 0}, {c, 0, s}), Vector3{1, 0, 0});
  expect_near(motion, {0, 0, 1});
  expect_near(slab_pull({1, 0, 0}, {1, 0, 0}), {0, 0, 0});
}

TEST(TectonicLaws, CollisionsReachFartherForLargeAndFastTerranes) {
  // 4200 sqrt(25 / 100) 2e6 / 1e7 = 420.
  EXPECT_NEAR(collision_radius_km(25.0, 2e6, 1e7), 420.0, 1e-9);
  EXPECT_NEAR(collision_radius_km(100.0, 3e7, 1e7), 4200.0, 1e-9);
  // 1.3e-5 * 1e5 = 1.3 km at the terrane; (1 - 1/4)^2 = 0.5625 of it half way out.
  EXPECT_NEAR(collision_surge_km(1e5, 0.0, 400.0), 1.3, 1e-12);
  EXPECT_NEAR(collision_surge_km(1e5, 200.0, 400.0), 0.73125, 1e-12);
  EXPECT_EQ(collision_surge_km(1e5, 400.0, 400.0), 0.0);
}

TEST(TectonicLaws, FoldsOfACollisionLieInTheGroundAndPointAway) {
  const Vector3 p{1, 0, 0}, q = normalised({1, 1, 0});
  const Vector3 fold = collision_fold(p, q);
  EXPECT_NEAR(dot(fold, p), 0.0, 1e-15);
  // (p - q) / |p - q| has the part -sin 45 / (2 sin 22.5) = -0.92388 along y.
  expect_near(fold, {0.0, -0.9238795325112867, 0.0});
}

TEST(TectonicLaws, NewFloorGoesFromTheRidgeToThePlates) {
  EXPECT_DOUBLE_EQ(ridge_share(0.0, 500.0), 0.0);
  EXPECT_DOUBLE_EQ(ridge_share(500.0, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(ridge_share(100.0, 300.0), 0.25);
  EXPECT_DOUBLE_EQ(ridge_profile_km(0.0, 300.0), -1.0);
  EXPECT_DOUBLE_EQ(ridge_profile_km(300.0, 300.0), -3.5);
  EXPECT_DOUBLE_EQ(ridge_profile_km(600.0, 300.0), -4.75);
  EXPECT_NEAR(ridge_profile_km(1e5, 300.0), -6.0, 1e-12);
  EXPECT_DOUBLE_EQ(new_floor_km(0.25, -4.0, -2.0), -2.5);
}

TEST(TectonicLaws, LargeContinentsRiftMoreOften) {
  EXPECT_NEAR(rift_probability(0.1, 0.5, 2.0), 0.1 * std::exp(-0.1), 1e-15);
  EXPECT_NEAR(rift_probability(0.1, 0.5, 2.0), 0.09048374180359595, 1e-15);
  EXPECT_EQ(rift_probability(0.1, 0.5, 0.0), 0.0);
}

TEST(TectonicLaws, ReliefWearsDown) {
  EXPECT_DOUBLE_EQ(erosion_km(5.0), -0.03);   // half of 0.03 mm/yr in 2 Myr
  EXPECT_DOUBLE_EQ(damping_km(-5.0), -0.04);  // half of 0.04 mm/yr in 2 Myr
  EXPECT_DOUBLE_EQ(damping_km(-10.0), 0.0);
  EXPECT_DOUBLE_EQ(accretion_km(), 0.6);
}

TEST(TectonicLaws, CrustThatThickensRisesMoreBelowTheSea) {
  EXPECT_DOUBLE_EQ(water_loaded(-1000.0), -1450.0);
  EXPECT_DOUBLE_EQ(dry_height(-1450.0), -1000.0);
  EXPECT_DOUBLE_EQ(dry_height(700.0), 700.0);
  EXPECT_DOUBLE_EQ(height_after(500.0, 3300.0, 6.6), 1000.0);
  EXPECT_DOUBLE_EQ(height_after(-2900.0, 3300.0, 6.6), -2175.0);  // dry -2000 and -1500
  EXPECT_DOUBLE_EQ(height_after(-1450.0, 9900.0, 6.6), 500.0);    // dry -1000 and 500
}

TEST(TectonicLaws, NeckedMarginsAreThinSooner) {
  EXPECT_DOUBLE_EQ(stretched_share(0.0, 2.0), 1.0);
  EXPECT_DOUBLE_EQ(stretched_share(1.0, 2.0), 0.25);
  EXPECT_DOUBLE_EQ(stretched_share(0.5), 0.625);
  EXPECT_DOUBLE_EQ(stretched_share(0.5, 2.0), 0.4375);  // 1/4 + 3/4 (1/2)^2
}

TEST(Quaternion, TurnsLikeItsRotationVector) {
  const Vector3 r = normalised({0.3, -0.5, 0.8}), rotation{0.4, 1.1, -0.2};
  expect_near(times(Quaternion::about(rotation).matrix(), r), rotated(r, rotation));
  expect_near(back(Quaternion::about(rotation).matrix(), rotated(r, rotation)), r);
  const Vector3 second{-0.7, 0.1, 0.3};
  const Quaternion both = Quaternion::about(second).after(Quaternion::about(rotation));
  expect_near(times(both.matrix(), r), rotated(rotated(r, rotation), second));
  const Matrix3 between =
      back_times(Quaternion::about(second).matrix(), Quaternion::about(rotation).matrix());
  expect_near(times(between, r), rotated(rotated(r, rotation), scaled(second, -1.0)));
}

TEST(Quaternion, StaysARotationThroughManySteps) {
  Quaternion turn;
  const Vector3 step = scaled(euler_rotation(-63.58, 114.70, 0.651), 2.0);
  for (int k = 0; k < 1000; ++k) turn = Quaternion::about(step).after(turn);
  expect_near(times(turn.matrix(), {0, 0, 1}), rotated({0, 0, 1}, scaled(step, 1000.0)), 1e-11);
}

}  // namespace
}  // namespace geo
