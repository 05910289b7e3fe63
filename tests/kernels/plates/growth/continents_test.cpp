// Which plates carry continents, and where these leave oceans.
#include "geo/kernels/plates/growth/continents.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "geo/core/vector3.hpp"
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
  const auto oceans = find_oceans(model, two.mesh, points, plates);
  const auto noise = craton_noise(two.mesh, 4);
  const auto expected = craton_potential(model, two.mesh, two.plate, plates, oceans, noise, 4);
  plates.emplace_back();  // of no cell
  EXPECT_EQ(craton_potential(model, two.mesh, two.plate, plates, oceans, noise, 4), expected);
}

/// A grown planet of a seed, and what its cratons make of it.
struct GrownContinents {
  CubedSphere mesh{32};
  std::vector<Plate> plates;
  std::vector<std::int16_t> plate;
  std::vector<BoundaryPoint> boundaries;
  Oceans oceans;
  std::vector<float> potential;

  GrownContinents(const Cratons& model, std::uint64_t seed) {
    const PlateGrowth growth;
    plates = draw_plates(growth, seed);
    plate = grow_plates(growth, mesh, plates, seed);
    std::vector<Vector3> rotations;
    for (const Plate& p : plates) rotations.push_back(p.rotation_rad_myr);
    boundaries = find_boundaries(mesh, plate, rotations, 2.0, 430.0, kRadius_km);
    oceans = find_oceans(model, mesh, boundaries, plates);
    potential =
        craton_potential(model, mesh, plate, plates, oceans, craton_noise(mesh, seed), seed);
  }
};

TEST(Continents, LeaveAnOceanBeforeTrenchesOnThePlateThatGoesDown) {
  Cratons model;
  model.trench_clearance_km = 0.0;
  const GrownContinents closed(model, 3);
  model.trench_clearance_km = 350.0;
  const GrownContinents open(model, 3);
  double lower_down = 0.0, lower_above = 0.0;
  for (const BoundaryPoint& point : open.boundaries) {
    if (point.type != BoundaryType::convergent) continue;
    const auto speed = [&](std::int16_t plate) {
      return length(cross(open.plates[plate].rotation_rad_myr, open.mesh.position(point.cell)));
    };
    const double lower = closed.potential[point.cell] - open.potential[point.cell];
    (speed(point.plate) >= speed(point.other) ? lower_down : lower_above) += lower;
  }
  EXPECT_GT(lower_down, 100.0);
  EXPECT_LT(lower_above, 0.1 * lower_down);  // where three plates meet
}

/// Of the places whose neighbours are all below a level, those that cannot be reached from the
/// deepest one by way of such places.
int places_cut_off(const CubedSphere& mesh, std::span<const float> potential, float level) {
  std::vector<std::uint8_t> at_sea(mesh.size(), 0);
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    const auto& around = mesh.neighbours(cell);
    at_sea[cell] = potential[cell] < level &&
                   std::all_of(around.begin(), around.end(), [&](std::int32_t next) {
                     return next < 0 || potential[next] < level;
                   });
  }
  const auto deepest = std::min_element(potential.begin(), potential.end()) - potential.begin();
  std::vector<std::int32_t> open{static_cast<std::int32_t>(deepest)};
  at_sea[deepest] = 0;
  while (!open.empty()) {
    const std::int32_t cell = open.back();
    open.pop_back();
    for (const std::int32_t next : mesh.neighbours(cell)) {
      if (next < 0 || at_sea[next] == 0) continue;
      at_sea[next] = 0;
      open.push_back(next);
    }
  }
  return static_cast<int>(std::count(at_sea.begin(), at_sea.end(), 1));
}

TEST(Continents, EncloseNoSea) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const GrownContinents grown(Cratons{}, seed);
    for (const float level : {-3.0F, -2.0F, -1.0F, -0.5F, 0.0F, 0.5F}) {
      EXPECT_EQ(places_cut_off(grown.mesh, grown.potential, level), 0)
          << "seed " << seed << ", level " << level;
    }
  }
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
