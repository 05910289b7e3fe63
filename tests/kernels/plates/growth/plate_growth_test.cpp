// Plates that grow from seeds, hang together and move.
#include "geo/kernels/plates/growth/plate_growth.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "geo/core/place.hpp"
#include "geo/kernels/plates/growth/plate_evolution.hpp"
#include "geo/kernels/plates/growth/plate_pieces.hpp"
#include "geo/kernels/remapping/cubed_sphere.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kRadius_km = 6371.0;

Vector3 at(double latitude_deg, double longitude_deg) {
  return unit_vector_of({latitude_deg, longitude_deg});
}

TEST(PlateGrowth, EveryCellBelongsToAPlateAndNoPlateIsLost) {
  const CubedSphere mesh(48);
  for (const int count : {2, 15, 100}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      SCOPED_TRACE(testing::Message() << count << " plates, seed " << seed);
      PlateGrowth model;
      model.count = count;
      const auto plates = draw_plates(model, seed);
      auto plate = grow_plates(model, mesh, plates, seed);
      move_plates(mesh, plates, 2.0, plate);
      merge_small_pieces(mesh, model.smallest_part_km2 / (kRadius_km * kRadius_km), plate);
      std::set<std::int16_t> present(plate.begin(), plate.end());
      EXPECT_GE(*present.begin(), 0);
      EXPECT_LT(*present.rbegin(), count);
      EXPECT_GE(static_cast<int>(present.size()), count - count / 20);
    }
  }
}

TEST(PlateGrowth, SmallPiecesJoinTheNeighbourTheyBorderMost) {
  const CubedSphere mesh(32);
  std::vector<std::int16_t> plate(mesh.size());
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    plate[cell] = mesh.position(cell)[2] > 0.0 ? 0 : 1;
  }
  const std::int32_t island = mesh.locate(at(50, 20));
  plate[island] = 1;
  merge_small_pieces(mesh, 0.05, plate);
  EXPECT_EQ(plate[island], 0);
  EXPECT_EQ(plate[mesh.locate(at(-50, 20))], 1);
}

TEST(PlatePieces, OfAnySizeJoinANeighbourUntilEachPlateIsOne) {
  const CubedSphere mesh(32);
  std::vector<std::int16_t> plate(mesh.size(), 0);
  const auto paint = [&](const Vector3& middle, double radius_rad, std::int16_t own) {
    for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
      if (angle_between(mesh.position(cell), middle) < radius_rad) plate[cell] = own;
    }
  };
  // Three discs of plate 1; in the second one plate 2, and in that a piece of plate 0.
  paint(at(0, 0), 0.6, 1);
  paint(at(0, 90), 0.5, 1);
  paint(at(0, 90), 0.3, 2);
  paint(at(0, 90), 0.1, 0);
  paint(at(0, 180), 0.4, 1);
  connect_plates(mesh, plate);
  EXPECT_EQ(plate[mesh.locate(at(0, 0))], 1);
  EXPECT_EQ(plate[mesh.locate(at(0, 180))], 0);
  EXPECT_EQ(plate[mesh.locate(at(0, 90 + 0.4 / kRadians))], 0);  // borders plate 0 most
  EXPECT_EQ(plate[mesh.locate(at(0, 90 + 0.2 / kRadians))], 2);
  EXPECT_EQ(plate[mesh.locate(at(0, 90))], 2);
  const auto connected = plate;
  merge_small_pieces(mesh, 4.0 * kPi, plate);
  EXPECT_EQ(plate, connected);
}

TEST(PlatePieces, OnAGridHangTogetherByCornersOverTheDateLineAndPoles) {
  const Grid grid = Grid::sphere(16, 8);
  std::vector<std::int16_t> plate(grid.size(), 0);
  const auto set = [&](int i, int j, std::int16_t own) { plate[grid.cell(i, j)] = own; };
  // By a corner across the date line; half-way round over the pole; by a corner over it.
  for (const auto [i, j] : {std::pair{15, 3}, {0, 4}, {14, 2}}) set(i, j, 1);
  for (const auto [i, j] : {std::pair{3, 7}, {11, 7}, {3, 6}}) set(i, j, 2);
  for (const auto [i, j] : {std::pair{5, 0}, {14, 0}}) set(i, j, 3);
  const auto before = plate;
  EXPECT_TRUE(connect_plates(grid, plate).empty());
  EXPECT_EQ(plate, before);
  // Two cells of plate 1 away from the rest, and one of plate 2.
  set(8, 4, 1), set(9, 4, 1), set(8, 2, 2);
  const std::vector<Index> cut_off{grid.cell(8, 2), grid.cell(8, 4), grid.cell(9, 4)};
  EXPECT_EQ(connect_plates(grid, plate), cut_off);
  EXPECT_EQ(plate, before);
}

TEST(PlateEvolution, APlateMovesRigidly) {
  const CubedSphere mesh(64);
  std::vector<Plate> plates(2);
  plates[0].rotation_rad_myr = {0, 0, 0.05};
  plates[0].buoyancy = 1.0;
  plates[1].buoyancy = -1.0;
  std::vector<std::int16_t> plate(mesh.size(), 1);
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    if (angle_between(mesh.position(cell), at(20, 0)) < 0.5) plate[cell] = 0;
  }
  for (int step = 0; step < 4; ++step) move_plates(mesh, plates, 2.0, plate);
  // 0.4 rad to the east; the wake stays with the plate that leaves it.
  EXPECT_EQ(plate[mesh.locate(at(20, 0.4 / kRadians))], 0);
  EXPECT_EQ(plate[mesh.locate(at(20, (0.4 + 0.45) / kRadians))], 0);
  EXPECT_EQ(plate[mesh.locate(at(20, (0.4 + 0.62) / kRadians))], 1);
}

}  // namespace
}  // namespace geo
