// Ages of the sea floor, from its ridges.
#include "geo/kernels/plates/growth/crust_age.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geo/core/place.hpp"
#include "geo/kernels/plates/plate_boundaries.hpp"
#include "kernels/plates/two_hemispheres.hpp"

namespace geo {
namespace {

using test::TwoHemispheres;

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kRadius_km = 6371.0;

TEST(CrustAge, GrowsWithTheDistanceFromTheRidge) {
  const TwoHemispheres two;
  const auto points = find_boundaries(two.mesh, two.plate, two.rotation, 2.0, 430.0, kRadius_km);
  const auto age = ocean_age_myr(two.mesh, two.plate, points, two.rotation, 1e6, kRadius_km);
  for (const double longitude_deg : {15.0, 40.0, -30.0, -70.0}) {
    // 0.004 rad of longitude a million years; chords are a little shorter than arcs.
    const double expected_myr = 2.0 * std::sin(0.5 * std::abs(longitude_deg) * kRadians) / 0.004;
    EXPECT_NEAR(age[two.mesh.locate(unit_vector_of({0, longitude_deg}))], expected_myr,
                0.03 * expected_myr + 3.0);
  }
  const auto capped = ocean_age_myr(two.mesh, two.plate, points, two.rotation, 180.0, kRadius_km);
  for (const float myr : capped) EXPECT_TRUE(myr >= 0.0F && myr <= 180.0F);
}

}  // namespace
}  // namespace geo
