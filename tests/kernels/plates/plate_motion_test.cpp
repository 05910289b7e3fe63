// Rigid motion of plates, against values worked out by hand.
#include "geo/kernels/plates/plate_motion.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "geo/core/place.hpp"
#include "geo/core/random.hpp"
#include "geo/kernels/plates/growth/plate_growth.hpp"
#include "geo/kernels/remapping/cubed_sphere.hpp"

namespace geo {
namespace {

constexpr double kRadius_km = 6371.0;

// Velocities of NNR-MORVEL56 (Argus et al. 2011), worked out by hand on a sphere.
TEST(PlateMotion, VelocitiesOfKnownPlates) {
  struct Case {
    double pole_lat, pole_lon, rate, lat, lon, east, north;
  };
  for (const Case& c : {Case{-63.58, 114.70, 0.651, 19.5, -155.5, -61.147, 32.209},
                        Case{33.86, 37.94, 0.632, -25, 135, 32.455, 57.914},
                        Case{50.37, -3.29, 0.544, 20, 77, 41.553, 38.029}}) {
    const Vector3 rotation = euler_rotation(c.pole_lat, c.pole_lon, c.rate);
    const Vector3 place = unit_vector_of({c.lat, c.lon});
    const auto v = east_north(velocity_mm_yr(rotation, place, kRadius_km), place);
    EXPECT_NEAR(v.east, c.east, 0.02);
    EXPECT_NEAR(v.north, c.north, 0.02);
  }
}

TEST(PlateMotion, RotationIsFoundAgainFromVelocities) {
  constexpr double kRadius_km = 6371.0;
  const RandomStream random(5, "velocities");
  const Vector3 rotation = euler_rotation(-20.0, 130.0, 0.7);
  VelocityFit fit;
  for (std::uint64_t k = 0; k < 50; ++k) {
    const Vector3 at = normalised(add({1.0, 0.5, -0.3}, random.direction(k), 0.4));
    fit.add(at, east_north(velocity_mm_yr(rotation, at, kRadius_km), at), 1.0 + 0.01 * k);
  }
  EXPECT_LT(length(add(fit.rotation_rad_myr(kRadius_km), rotation, -1.0)), 1e-12);
  EXPECT_EQ(VelocityFit().rotation_rad_myr(kRadius_km), Vector3{});
  // Of one place the turn about itself cannot be told, and is left out.
  VelocityFit single;
  const Vector3 at{0.0, 0.6, 0.8};
  single.add(at, east_north(velocity_mm_yr(rotation, at, kRadius_km), at), 2.0);
  EXPECT_LT(length(add(single.rotation_rad_myr(kRadius_km), tangent(rotation, at), -1.0)), 1e-12);
}

TEST(PlateMotion, NetRotationOfOnePlateIsItsOwnAndOfNoneIsLeft) {
  const CubedSphere mesh(32);
  std::vector<Vector3> unit(mesh.size());
  std::vector<double> area(mesh.size());
  std::vector<std::int16_t> plate(mesh.size(), 0);
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    unit[cell] = mesh.position(cell);
    area[cell] = mesh.area_sr(cell);
  }
  const Vector3 rotation{0.001, -0.004, 0.007};
  const Vector3 net = net_rotation(plate, unit, area, std::vector<Vector3>{rotation});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(net[c], rotation[c], 2e-5 * length(rotation));

  PlateGrowth model;
  auto plates = draw_plates(model, 4);
  plate = grow_plates(model, mesh, plates, 4);
  std::vector<Vector3> rotations;
  for (const Plate& p : plates) rotations.push_back(p.rotation_rad_myr);
  // Pieces that are points, not cells, leave a small remainder; a few turns of it leave none.
  double before = 0.0;
  for (int turn = 0; turn < 5; ++turn) {
    const Vector3 common = net_rotation(plate, unit, area, rotations);
    if (turn == 0) before = length(common);
    for (Vector3& r : rotations) r = add(r, common, -1.0);
  }
  EXPECT_GT(before, 1e-4);
  EXPECT_LT(length(net_rotation(plate, unit, area, rotations)), 1e-15);
}

}  // namespace
}  // namespace geo
