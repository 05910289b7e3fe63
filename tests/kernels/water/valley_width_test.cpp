// Valleys are as wide along a meridian as along a parallel, however narrow the cells.
#include "geo/kernels/water/valley_width.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace geo {
namespace {

const Grid& grid() {
  static const Grid kGrid = Grid::sphere(720, 360);
  return kGrid;
}

/// What a step leaves of a plateau of 1000 m whose cell `bed` it cut to 900 m.
std::vector<double> widened(Index bed, const std::vector<std::uint8_t>& fixed,
                            std::vector<double> before) {
  std::vector<double> z = before;
  z[bed] -= 100.0;
  widen_valleys<double>(grid(), before, fixed, z);
  return z;
}

TEST(ValleyWidth, RiversAlongMeridiansTakeAsMuchPerLengthAsThoseAlongParallels) {
  const std::vector<std::uint8_t> none(grid().size(), 0);
  const std::vector<double> plateau(grid().size(), 1000.0);
  for (const int j : {3, 10, 30, 329, 350}) {
    const Index bed = grid().cell(100, j);
    const auto z = widened(bed, none, plateau);
    const double width = grid().spacing_east_m(j), height = grid().face_east_m(j);
    double taken_m2 = 0.0;  // per length of the river
    for (Index c = 0; c < grid().size(); ++c) {
      if (grid().row(c) != j) {
        ASSERT_EQ(z[c], 1000.0);
        continue;
      }
      const double x = std::abs(std::remainder(grid().column(c) - 100.0, grid().nx())) * width;
      const double bell =
          x < height ? std::pow(std::cos(0.5 * std::numbers::pi * x / height), 2) : 0.0;
      ASSERT_NEAR(z[c], 1000.0 - 100.0 * bell, 1e-9) << "row " << j << ", " << x << " m away";
      taken_m2 += (1000.0 - z[c]) * width;
    }
    // A river along the parallel lowers a whole row.
    EXPECT_NEAR(taken_m2, 100.0 * height, 0.02 * 100.0 * height) << "row " << j;
  }
}

TEST(ValleyWidth, NothingSinksBelowTheBedThatLowersItOrBeyondTheSea) {
  const int j = 5;
  std::vector<std::uint8_t> fixed(grid().size(), 0);
  std::vector<double> before(grid().size(), 1000.0);
  fixed[grid().cell(103, j)] = 1;
  before[grid().cell(99, j)] = 930.0;
  before[grid().cell(97, j)] = 860.0;  // lower than the bed already
  const auto z = widened(grid().cell(100, j), fixed, before);
  EXPECT_EQ(z[grid().cell(100, j)], 900.0);
  EXPECT_EQ(z[grid().cell(99, j)], 900.0);
  EXPECT_EQ(z[grid().cell(97, j)], 860.0);
  EXPECT_LT(z[grid().cell(102, j)], 1000.0);
  EXPECT_EQ(z[grid().cell(103, j)], 1000.0);
  EXPECT_EQ(z[grid().cell(104, j)], 1000.0);
}

TEST(ValleyWidth, CellsAsWideAsHighAndOtherGridsStayAsTheyAre) {
  const std::vector<std::uint8_t> none(grid().size(), 0);
  const std::vector<double> plateau(grid().size(), 1000.0);
  const Index bed = grid().cell(100, 180);
  const auto z = widened(bed, none, plateau);
  for (const int away : {-1, 1}) EXPECT_GT(z[bed + away], 999.9);

  const Grid plane = Grid::plane(30, 20, 1e3, 9e3);
  const std::vector<double> before(plane.size(), 10.0);
  std::vector<double> after = before;
  after[200] = 3.0;
  const auto cut = after;
  const std::vector<std::uint8_t> dry(plane.size(), 0);
  widen_valleys<double>(plane, before, dry, after);
  EXPECT_EQ(after, cut);
}

}  // namespace
}  // namespace geo
