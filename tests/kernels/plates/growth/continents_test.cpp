// Which plates carry continents.
#include "geo/kernels/plates/growth/continents.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <numbers>
#include <vector>

#include "geo/kernels/plates/growth/crust_age.hpp"
#include "geo/kernels/plates/growth/plate_growth.hpp"
#include "geo/kernels/plates/plate_boundaries.hpp"
#include "geo/kernels/remapping/cubed_sphere.hpp"
#include "kernels/plates/two_hemispheres.hpp"

namespace geo {
namespace {

using test::TwoHemispheres;

constexpr double kPi = std::numbers::pi;
constexpr double kRadius_km = 6371.0;

TEST(Continents, PlatesThatWereConsumedCarryNoCratons) {
  const TwoHemispheres two;
  const auto points = find_boundaries(two.mesh, two.plate, two.rotation, 2.0, 430.0, kRadius_km);
  Cratons model;
  model.plate_share = 1.0;
  std::vector<Plate> plates(2);
  const auto ridges = nearest_ridges(model, two.mesh, points);
  const auto noise = craton_noise(two.mesh, 4);
  const auto expected = craton_potential(model, two.mesh, two.plate, plates, ridges, noise, 4);
  plates.emplace_back();  // of no cell
  EXPECT_EQ(craton_potential(model, two.mesh, two.plate, plates, ridges, noise, 4), expected);
}

TEST(Continents, WholePlatesComeAsNearToTheShareAsTheyCan) {
  const CubedSphere mesh(32);
  PlateGrowth model;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto plates = draw_plates(model, seed);
    const auto plate = grow_plates(model, mesh, plates, seed);
    const auto continental = continental_plates(mesh, plate, plates, 0.49);
    double area = 0.0;
    for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
      if (continental[plate[cell]] != 0) area += mesh.area_sr(cell) / (4.0 * kPi);
    }
    EXPECT_NEAR(area, 0.49, 0.11) << "seed " << seed;
  }
}

}  // namespace
}  // namespace geo
