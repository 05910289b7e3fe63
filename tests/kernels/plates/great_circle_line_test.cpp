// Lines that part a sphere.
#include "geo/kernels/plates/great_circle_line.hpp"

#include <gtest/gtest.h>

#include "geo/core/place.hpp"

namespace geo {
namespace {

Vector3 place(double latitude_deg, double longitude_deg) {
  return unit_vector_of({latitude_deg, longitude_deg});
}
GreatCircleLine line_of(const std::vector<Centre>& places) {
  std::vector<Vector3> vectors;
  for (const Centre& at : places) vectors.push_back(unit_vector_of(at));
  return GreatCircleLine(vectors);
}

TEST(GreatCircleLine, OfTwoPlacesPartsTheSphereInHalves) {
  const GreatCircleLine equator = line_of({{0.0, 10.0}, {0.0, 40.0}});
  EXPECT_NEAR(length(add(equator.middle(), place(0.0, 25.0), -1.0)), 0.0, 1e-15);
  for (double longitude = -180.0; longitude < 180.0; longitude += 7.0) {
    for (const double latitude : {0.5, 10.0, 45.0, 85.0}) {
      EXPECT_TRUE(equator.is_left(place(latitude, longitude))) << latitude << ' ' << longitude;
      EXPECT_FALSE(equator.is_left(place(-latitude, longitude))) << latitude << ' ' << longitude;
      EXPECT_EQ(equator.is_beyond_middle(place(latitude, longitude)),
                longitude > 25.0 || longitude < -155.0);
    }
  }
}

TEST(GreatCircleLine, HasItsMiddleAtHalfItsLengthNotHalfItsPlaces) {
  // Arcs of 10, 2, 2 and 26 degrees: the middle is 6 degrees into the last one.
  const GreatCircleLine line = line_of({{0, 0}, {0, 10}, {0, 12}, {0, 14}, {0, 40}});
  EXPECT_NEAR(length(add(line.middle(), place(0.0, 20.0), -1.0)), 0.0, 1e-15);
}

TEST(GreatCircleLine, KeepsItsSidesAtSharpCorners) {
  // North along the meridian, then back south-east: a wedge that opens to the south.
  const GreatCircleLine wedge = line_of({{-20, 0}, {20, 0}, {-20, 20}});
  EXPECT_TRUE(wedge.is_left(place(0.0, -3.0)));
  EXPECT_FALSE(wedge.is_left(place(0.0, 3.0)));
  EXPECT_TRUE(wedge.is_left(place(0.0, 15.0)));
  EXPECT_TRUE(wedge.is_left(place(23.0, 0.5)));   // beyond the corner, near to both
  EXPECT_FALSE(wedge.is_left(place(15.0, 1.0)));  // within it
}

TEST(GreatCircleLine, PassesOverPlacesThatAreNamedTwice) {
  const GreatCircleLine line = line_of({{0, 10}, {0, 10}, {0, 40}, {0, 40}});
  EXPECT_NEAR(length(add(line.middle(), place(0.0, 25.0), -1.0)), 0.0, 1e-15);
  EXPECT_TRUE(line.is_left(place(1.0, 80.0)));
}

}  // namespace
}  // namespace geo
