// Which fragments a rift leaves, round given centres and along a given line.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "geo/kernels/plates/great_circle_line.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "kernels/plates/sphere/hemispheres.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::hemispheres;
using test::place;
using test::quiet;
using test::SampledSphere;

TEST(SphereTectonics, RiftsSplitAPlateIntoPartsThatPart) {
  const SampledSphere world(20000);
  SphereTectonics model(world.mesh, quiet(), hemispheres(world, 0.0), 1);
  const std::vector<Vector3> places{place(0.0, 60.0), place(0.0, 120.0)};
  rift_plate(model, 1, places, 40.0);
  ASSERT_EQ(model.state.plates.size(), 3U);
  std::array<int, 3> count{};
  for (const std::int16_t plate : model.state.crust.plate) ++count[plate];
  EXPECT_GT(count[1], 2000);
  EXPECT_GT(count[2], 2000);
  EXPECT_NEAR(count[1] + count[2], 10000, 30);
  // One moves west, the other east, at the speed that was asked for.
  const Vector3 west = cross(model.rotation[1], places[0]),
                east = cross(model.rotation[2], places[1]);
  const Vector3 eastward{-1.0, 0.0, 0.0};  // at longitude 90
  EXPECT_LT(dot(west, eastward), 0.0);
  EXPECT_GT(dot(east, eastward), 0.0);
  EXPECT_NEAR(6370.0 * length(model.rotation[1]), 40.0, 1e-9);
}

TEST(SphereTectonics, RiftsAlongALineToBothSidesOfIt) {
  const SampledSphere world(20000);
  SphereTectonics model(world.mesh, quiet(), hemispheres(world, 0.0), 1);
  // Northwards along 90 E, then north-east from 30 N.
  const std::vector<Vector3> line{place(-30.0, 90.0), place(30.0, 90.0), place(50.0, 120.0)};
  rift_plate_along(model, 1, GreatCircleLine(line), 2, 30.0);
  ASSERT_EQ(model.state.plates.size(), 3U);
  const auto plate_of = [&](double latitude, double longitude) {
    return model.state.crust.plate[world.samples.nearest(place(latitude, longitude))];
  };
  for (double latitude = -60.0; latitude <= 30.0; latitude += 5.0) {
    EXPECT_EQ(plate_of(latitude, 87.0), 1) << latitude;
    EXPECT_EQ(plate_of(latitude, 93.0), 2) << latitude;
  }
  for (const double along : {0.2, 0.5, 0.8, 1.3}) {
    const Vector3 turn = normalised(cross(line[1], line[2]));
    const Vector3 on = rotated(line[1], scaled(turn, along * angle_between(line[1], line[2])));
    EXPECT_EQ(
        model.state.crust.plate[world.samples.nearest(rotated(on, scaled(cross(turn, on), -0.05)))],
        1)
        << along;
    EXPECT_EQ(
        model.state.crust.plate[world.samples.nearest(rotated(on, scaled(cross(turn, on), 0.05)))],
        2)
        << along;
  }
  EXPECT_EQ(plate_of(0.0, -90.0), 0);
  // They part at twice the speed, across the line.
  const Vector3 middle = place(10.0, 90.0);
  const Vector3 parting =
      scaled(cross(add(model.rotation[2], model.rotation[1], -1.0), middle), 6370.0);
  EXPECT_GT(dot(parting, Vector3{-1.0, 0.0, 0.0}), 45.0);  // eastwards
  EXPECT_LT(length(parting), 60.1);
  EXPECT_EQ(model.budget.rifts, 1);
}

TEST(SphereTectonics, ALineCutsThreeAndFourFragments) {
  const SampledSphere world(20000);
  const std::vector<Vector3> line{place(-30.0, 90.0), place(30.0, 90.0)};
  for (const int fragments : {3, 4}) {
    SphereTectonics model(world.mesh, quiet(), hemispheres(world, 0.0), 1);
    rift_plate_along(model, 1, GreatCircleLine(line), fragments, 30.0);
    const auto plate_of = [&](double latitude, double longitude) {
      return model.state.crust.plate[world.samples.nearest(place(latitude, longitude))];
    };
    EXPECT_EQ(plate_of(-20.0, 60.0), 1);
    EXPECT_EQ(plate_of(-20.0, 120.0), 2);
    EXPECT_EQ(plate_of(20.0, 120.0), 3);
    EXPECT_EQ(plate_of(20.0, 60.0), fragments == 4 ? 4 : 1);
    EXPECT_NEAR(model.partition.cap(3).samples, 5000 / 2, 100);
  }
}

}  // namespace
}  // namespace geo
