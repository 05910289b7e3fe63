// The equal-area map that an island is laid out on.
#include "geo/core/projection.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "geo/core/grid.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(EqualArea, ProjectsThereAndBackAndKeepsAreas) {
  for (const double flattening : {0.0, 1.0 / 298.257}) {
    const Ellipsoid figure{6371e3, flattening};
    for (const Centre centre : {Centre{0, 0}, Centre{47, 179}, Centre{-90, 0}, Centre{88, 10}}) {
      const EqualAreaProjection map(centre, figure);
      for (const double x : {-200e3, 13e3, 250e3}) {
        for (const double y : {-150e3, 0.5e3, 90e3}) {
          const Centre place = map.unproject(x, y);
          const auto [east, north] = map.project(place);
          EXPECT_NEAR(east, x, 1e-3);
          EXPECT_NEAR(north, y, 1e-3);
        }
      }
    }
  }
  // A square of a sphere by the solid angle of its corners.
  const EqualAreaProjection map(Centre{60, 20});
  const auto corner = [&](double x, double y) {
    const Centre c = map.unproject(x, y);
    return std::pair{std::sin(c.latitude_deg * kPi / 180.0), c.longitude_deg * kPi / 180.0};
  };
  double area = 0.0;  // integral of sin(lat) d lon round a finely divided edge
  constexpr int kSteps = 4000;
  constexpr double kHalf_m = 100e3;
  auto last = corner(-kHalf_m, -kHalf_m);
  for (int k = 1; k <= 4 * kSteps; ++k) {
    const double t = 2.0 * kHalf_m * (k % kSteps) / kSteps - kHalf_m;
    const int side = (k - 1) / kSteps;
    const double run = k % kSteps == 0 ? kHalf_m : t;
    const double x = side == 0 ? run : side == 1 ? kHalf_m : side == 2 ? -run : -kHalf_m;
    const double y = side == 0 ? -kHalf_m : side == 1 ? run : side == 2 ? kHalf_m : -run;
    const auto here = corner(x, y);
    area -= 0.5 * (here.first + last.first) * (here.second - last.second);
    last = here;
  }
  EXPECT_NEAR(std::abs(area) * 6371e3 * 6371e3, 4e10, 4e4);
}

// Rounding could put the antipode of a cell's centre at the centre of the map, with the rivers
// there.
TEST(EqualArea, AntipodeIsNowhere) {
  const Grid grid = Grid::sphere(256, 128);
  for (Index c = 0; c < grid.size(); c += 37) {
    const Centre centre = grid.position(grid.column(c), grid.row(c));
    const EqualAreaProjection map(centre, grid.figure());
    const auto [x, y] = map.project({-centre.latitude_deg, centre.longitude_deg + 180.0});
    EXPECT_FALSE(std::isfinite(x)) << "cell " << c;
    EXPECT_FALSE(std::isfinite(y)) << "cell " << c;
    const auto [far_x, far_y] = map.project({-centre.latitude_deg, centre.longitude_deg + 178.0});
    EXPECT_GT(std::hypot(far_x, far_y), 1.9 * grid.figure().radius_m);
  }
}

}  // namespace
}  // namespace geo
