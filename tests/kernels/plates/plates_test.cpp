// The pieces that plates are made of, against exact values.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "geo/core/random.hpp"
#include "geo/kernels/plates/growth/continents.hpp"
#include "geo/kernels/plates/growth/crust_age.hpp"
#include "geo/kernels/plates/growth/plate_evolution.hpp"
#include "geo/kernels/plates/growth/plate_growth.hpp"
#include "geo/kernels/plates/growth/plate_pieces.hpp"
#include "geo/kernels/plates/plate_boundaries.hpp"
#include "geo/kernels/plates/plate_motion.hpp"
#include "geo/kernels/remapping/cubed_sphere.hpp"
#include "geo/kernels/remapping/mesh_sampling.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi, kRadians = kPi / 180.0;
constexpr double kRadius_km = 6371.0;

Vector3 at(double latitude_deg, double longitude_deg) {
  const double lat = latitude_deg * kRadians, lon = longitude_deg * kRadians;
  return {std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat)};
}

TEST(CubedSphereMesh, CellsFillTheSphereAndAreFoundAtTheirCentres) {
  for (const int n : {1, 2, 7, 40}) {
    const CubedSphere mesh(n);
    double area = 0.0, least = 1e9, most = 0.0;
    for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
      ASSERT_EQ(mesh.locate(mesh.position(cell)), cell);
      ASSERT_NEAR(length(mesh.position(cell)), 1.0, 1e-14);
      area += mesh.area_sr(cell);
      least = std::min(least, mesh.area_sr(cell));
      most = std::max(most, mesh.area_sr(cell));
    }
    EXPECT_NEAR(area, 4.0 * kPi, 1e-12);
    EXPECT_LT(most / least, 1.45);
  }
}

TEST(CubedSphereMesh, NeighboursAreNearAndMutual) {
  const CubedSphere mesh(24);
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    for (const std::int32_t next : mesh.neighbours(cell)) {
      ASSERT_LT(angle_between(mesh.position(cell), mesh.position(next)), 1.9 * mesh.spacing());
      ASSERT_NE(next, cell);
    }
    // Sides, not corners, lead back.
    for (const int k : {0, 2, 4, 6}) {
      const auto& back = mesh.neighbours(mesh.neighbours(cell)[k]);
      ASSERT_NE(std::find(back.begin(), back.end(), cell), back.end());
    }
  }
}

TEST(CubedSphereMesh, SidesCloseRoundEachCellAndAreSharedWithTheNext) {
  for (const int n : {1, 2, 7, 40}) {
    const CubedSphere mesh(n);
    for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
      const auto sides = mesh.sides(cell);
      const auto& around = mesh.neighbours(cell);
      for (int k = 0; k < CubedSphere::kSides; ++k) {
        ASSERT_EQ(sides[k].to, sides[(k + 1) % CubedSphere::kSides].from);
        // The cell lies to the left.
        ASSERT_GT(dot(cross(sides[k].from, sides[k].to), mesh.position(cell)), 0.0);
        ASSERT_NE(std::find(around.begin(), around.end(), sides[k].beyond), around.end());
        double mismatch = 9.0;
        for (const auto& back : mesh.sides(sides[k].beyond)) {
          if (back.beyond != cell) continue;
          mismatch = std::min(mismatch, length(add(back.from, sides[k].to, -1.0)) +
                                            length(add(back.to, sides[k].from, -1.0)));
        }
        ASSERT_LT(mismatch, 1e-14);
      }
    }
  }
}

TEST(CubedSphereMesh, SamplingIsContinuousAndKeepsConstants) {
  const CubedSphere mesh(32);
  std::vector<float> height(mesh.size());
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    height[cell] = static_cast<float>(100.0 * mesh.position(cell)[2]);
  }
  const RandomStream random(3, "places");
  for (std::uint64_t k = 0; k < 20000; ++k) {
    const Vector3 here = random.direction(k);
    const Vector3 there = normalised(add(here, random.direction(k + 100000), 1e-4));
    const double a = read(stencil_at(mesh, here), height),
                 b = read(stencil_at(mesh, there), height);
    ASSERT_NEAR(a, 100.0 * here[2], 1.5);
    ASSERT_NEAR(a, b, 0.3);  // a tenth of the step from cell to cell
  }
}

// Velocities of NNR-MORVEL56 (Argus et al. 2011), worked out by hand on a sphere.
TEST(PlateMotion, VelocitiesOfKnownPlates) {
  struct Case {
    double pole_lat, pole_lon, rate, lat, lon, east, north;
  };
  for (const Case& c : {Case{-63.58, 114.70, 0.651, 19.5, -155.5, -61.147, 32.209},
                        Case{33.86, 37.94, 0.632, -25, 135, 32.455, 57.914},
                        Case{50.37, -3.29, 0.544, 20, 77, 41.553, 38.029}}) {
    const Vector3 rotation = euler_rotation(c.pole_lat, c.pole_lon, c.rate);
    const Vector3 place = at(c.lat, c.lon);
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

TEST(PlateBoundaries, ClassesFollowTheTable) {
  constexpr double kSpeed_cm_yr = 4.0;  // scale 5 cm/yr = 50 mm/yr: limits 7 and 9 mm/yr
  using enum BoundaryType;
  EXPECT_EQ(classify({7.1, 0, 9.0}, kSpeed_cm_yr), convergent);
  EXPECT_EQ(classify({6.9, 0, 0}, kSpeed_cm_yr), interior);
  EXPECT_EQ(classify({0, 7.1, 9.0}, kSpeed_cm_yr), divergent);
  EXPECT_EQ(classify({7.1, 0, 9.6}, kSpeed_cm_yr), transform);  // 0.75 x 9.6 = 7.2
  EXPECT_EQ(classify({0, 30.0, 41.0}, kSpeed_cm_yr), transform);
  EXPECT_EQ(classify({0, 0, 8.9}, kSpeed_cm_yr), interior);
  EXPECT_EQ(classify({0, 0, 9.1}, kSpeed_cm_yr), transform);
  EXPECT_EQ(classify({1.7, 0, 0}, 0.5), convergent);  // slow plates: scale 12 mm/yr
  EXPECT_EQ(classify({1.6, 0, 0}, 0.5), interior);
}

TEST(PlateBoundaries, MotionSplitsAcrossAndAlong) {
  const Vector3 here{1, 0, 0}, east{0, 1, 0};
  const auto closing = relative_motion({0, 20, 5}, {0, -10, 1}, east, here);
  EXPECT_DOUBLE_EQ(closing.closing, 30.0);
  EXPECT_DOUBLE_EQ(closing.opening, 0.0);
  EXPECT_DOUBLE_EQ(closing.shear, 4.0);
  EXPECT_DOUBLE_EQ(relative_motion({0, -20, 0}, {0, 10, 0}, east, here).opening, 30.0);
}

/// Two hemispheres that part or close at longitudes 0 and 180.
struct Hemispheres {
  CubedSphere mesh{64};
  std::vector<std::int16_t> plate;
  std::vector<Vector3> rotation{{0, 0, 0.004}, {0, 0, -0.004}};
  Hemispheres() : plate(mesh.size()) {
    for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
      plate[cell] = mesh.position(cell)[1] > 0.0 ? 0 : 1;
    }
  }
};

TEST(PlateBoundaries, TwoHemispheresPartOnOneSideAndCloseOnTheOther) {
  const Hemispheres two;
  const auto points = find_boundaries(two.mesh, two.plate, two.rotation, 2.0, 430.0, kRadius_km);
  ASSERT_GT(points.size(), 300U);
  for (const BoundaryPoint& point : points) {
    const Vector3& p = two.mesh.position(point.cell);
    const double latitude_deg = std::asin(p[2]) / kRadians;
    if (std::abs(latitude_deg) > 55.0) continue;  // slow near the poles of rotation
    EXPECT_EQ(point.type, p[0] > 0.0 ? BoundaryType::divergent : BoundaryType::convergent);
    const double rate = 0.008 * kRadius_km * std::cos(latitude_deg * kRadians);
    EXPECT_NEAR(point.motion.closing + point.motion.opening, rate, 0.05 * rate);
    EXPECT_GT(std::abs(point.towards[1]), 0.9);
    EXPECT_LE(point.strength, 1.0);
  }
}

TEST(CrustBudget, OfTwoHemispheresIsTheirGreatCirclesHoweverItLies) {
  // Half a great circle opens, half closes: the flux through each half is 2 R² of the rotation in
  // its plane. A rotation across the plane slides along it and makes nothing. The steps of the mesh
  // put the ends of the halves a cell off at most, on either side.
  for (std::uint64_t k = 0; k < 10; ++k) {
    const RandomStream random(7, "hemispheres");
    const Vector3 normal = random.direction(2 * k);
    const Vector3 turn = scaled(random.direction(2 * k + 1), 0.008);
    Hemispheres two;
    for (std::int32_t cell = 0; cell < two.mesh.size(); ++cell) {
      two.plate[cell] = dot(two.mesh.position(cell), normal) > 0.0 ? 0 : 1;
    }
    two.rotation = {turn, {0, 0, 0}};
    const auto points = find_boundaries(two.mesh, two.plate, two.rotation, 2.0, 430.0, kRadius_km);
    const auto crust = crust_budget(two.mesh, two.plate, points, two.rotation, kRadius_km);
    const double km2_yr = 1e-6 * kRadius_km * kRadius_km;
    const double expected = 2.0 * km2_yr * length(tangent(turn, normal));
    const double ends = 2.0 * km2_yr * length(turn) * two.mesh.spacing();
    EXPECT_NEAR(crust.created, crust.consumed, 1e-12) << "pair " << k;
    EXPECT_NEAR(crust.created, expected, ends) << "pair " << k;
  }
}

TEST(CrustBudget, OfGrownPlatesClosesToRoundOff) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const CubedSphere mesh(48);
    const PlateGrowth model;
    const auto plates = draw_plates(model, seed);
    const auto plate = grow_plates(model, mesh, plates, seed);
    std::vector<Vector3> rotation;
    for (const Plate& one : plates) rotation.push_back(one.rotation_rad_myr);
    const auto points = find_boundaries(mesh, plate, rotation, 5.0, 430.0, kRadius_km);
    const auto crust = crust_budget(mesh, plate, points, rotation, kRadius_km);
    EXPECT_GT(crust.created, 1.0) << "seed " << seed;
    EXPECT_NEAR(crust.created, crust.consumed, 1e-12 * crust.created) << "seed " << seed;
  }
}

TEST(CrustAge, GrowsWithTheDistanceFromTheRidge) {
  const Hemispheres two;
  const auto points = find_boundaries(two.mesh, two.plate, two.rotation, 2.0, 430.0, kRadius_km);
  const auto age = ocean_age_myr(two.mesh, two.plate, points, two.rotation, 1e6, kRadius_km);
  for (const double longitude_deg : {15.0, 40.0, -30.0, -70.0}) {
    // 0.004 rad of longitude a million years; chords are a little shorter than arcs.
    const double expected_myr = 2.0 * std::sin(0.5 * std::abs(longitude_deg) * kRadians) / 0.004;
    EXPECT_NEAR(age[two.mesh.locate(at(0, longitude_deg))], expected_myr,
                0.03 * expected_myr + 3.0);
  }
  const auto capped = ocean_age_myr(two.mesh, two.plate, points, two.rotation, 180.0, kRadius_km);
  for (const float myr : capped) EXPECT_TRUE(myr >= 0.0F && myr <= 180.0F);
}

TEST(PlateBoundaries, OfSmallPlanetsAreTakenOverNoMoreThanPartOfThem) {
  const Hemispheres two;
  const double widest_km = kWidestSmoothing_rad * kRadius_km;
  const auto widest =
      find_boundaries(two.mesh, two.plate, two.rotation, 2.0, widest_km, kRadius_km);
  const auto wider =
      find_boundaries(two.mesh, two.plate, two.rotation, 2.0, 1e4 * widest_km, kRadius_km);
  ASSERT_EQ(widest.size(), wider.size());
  for (std::size_t k = 0; k < widest.size(); ++k) {
    ASSERT_EQ(widest[k].towards, wider[k].towards);
    ASSERT_EQ(widest[k].type, wider[k].type);
  }
}

TEST(NearestCells, AreNearestByGreatCircle) {
  const CubedSphere mesh(40);
  std::vector<std::int32_t> sources;
  for (std::uint64_t k = 0; k < 25; ++k) {
    sources.push_back(mesh.locate(RandomStream(9, "sources").direction(k)));
  }
  const auto nearest = nearest_cells(mesh, sources);
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    double least = 10.0;
    for (const std::int32_t source : sources) {
      least = std::min(least, angle_between(mesh.position(cell), mesh.position(source)));
    }
    ASSERT_NEAR(nearest.angle[cell], least, 0.02 * mesh.spacing());
  }
  const auto near = nearest_cells(mesh, sources, 0.1);
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    ASSERT_EQ(near.source[cell] >= 0, near.angle[cell] <= 0.1F);
  }
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

TEST(Continents, PlatesThatWereConsumedCarryNoCratons) {
  const Hemispheres two;
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
