#include "geo/core/turn.hpp"

#include <gtest/gtest.h>

#include <array>

#include "geo/core/place.hpp"
#include "geo/core/vector3.hpp"

namespace geo {
namespace {

/// Where a place of the planet comes to lie on a grid with a turn.
Vector3 laid_out(const Centre& place, const std::array<double, 3>& turn) {
  return Grid::sphere(8, 4, {}, turn).to_axis(unit_vector_of(place));
}

void expect_near(const Vector3& a, const Vector3& b) { EXPECT_LT(length(add(a, b, -1.0)), 1e-12); }

TEST(Turn, BringsAPlaceToTheNorthPole) {
  for (const Centre pole : {Centre{35.0, -120.0}, Centre{-60.0, 170.0}, Centre{0.0, 0.0},
                            Centre{-90.0, 40.0}, Centre{89.999, 10.0}}) {
    for (const double angle : {0.0, 75.0, -300.0}) {
      expect_near(laid_out(pole, turn_to_pole(pole, angle)), {0.0, 0.0, 1.0});
    }
  }
}

TEST(Turn, TiltsAlongTheMeridianOfThePlace) {
  // What lies 20 degrees from the place on its meridian is 20 degrees from the pole, on the same
  // meridian; across it, places that are 90 degrees off stay where they are.
  const auto turn = turn_to_pole({50.0, 30.0}, 0.0);
  expect_near(laid_out({30.0, 30.0}, turn), unit_vector_of({70.0, 30.0}));
  expect_near(laid_out({0.0, 120.0}, turn), unit_vector_of({0.0, 120.0}));
}

TEST(Turn, MovesThePrimeMeridianEast) {
  expect_near(laid_out({20.0, 65.0}, turn_to_pole({90.0, 0.0}, 65.0)), unit_vector_of({20.0, 0.0}));
  expect_near(laid_out({20.0, 65.0}, turn_to_pole({90.0, 77.0}, 65.0)),
              unit_vector_of({20.0, 0.0}));
  const auto turn = turn_to_pole({50.0, 30.0}, 65.0);
  expect_near(laid_out({30.0, 30.0}, turn), unit_vector_of({70.0, -35.0}));
}

TEST(Turn, OfNothingIsNone) {
  EXPECT_EQ(turn_to_pole({90.0, 0.0}, 0.0), (std::array{0.0, 0.0, 0.0}));
  EXPECT_LT(length(turn_to_pole({90.0, 135.0}, 0.0)), 1e-12);
}

}  // namespace
}  // namespace geo
