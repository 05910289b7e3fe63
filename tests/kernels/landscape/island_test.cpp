// The pieces that an island is made of.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geo/core/field.hpp"
#include "geo/core/projection.hpp"
#include "geo/kernels/landscape/region_score.hpp"
#include "geo/kernels/landscape/river_courses.hpp"
#include "geo/kernels/landscape/surface_detail.hpp"
#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/remapping/catmull_rom.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "geo/kernels/water/inflow.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(CatmullRom, GoesThroughTheCellsAndFollowsParabolas) {
  const Grid planet = Grid::sphere(36, 18);
  std::vector<float> values(planet.size());
  for (Index cell = 0; cell < planet.size(); ++cell) {
    const double x = planet.column(cell), y = planet.row(cell);
    values[cell] = static_cast<float>(3.0 + 0.5 * x - 0.02 * x * x + y - 0.1 * y * y);
  }
  const std::span<const float> field(values);
  for (const Index cell : {100, 333, 500}) {
    const CatmullRom at(
        planet, {planet.latitude_deg(planet.row(cell)), planet.longitude_deg(planet.column(cell))});
    EXPECT_NEAR(at.of(field), values[cell], 1e-5);
    EXPECT_EQ(at.nearest(), cell);
  }
  for (const auto& [x, y] : {std::pair{7.3, 6.8}, {20.5, 11.25}}) {
    const CatmullRom at(planet, {-90.0 + (y + 0.5) * 10.0, -180.0 + (x + 0.5) * 10.0});
    EXPECT_NEAR(at.of(field), 3.0 + 0.5 * x - 0.02 * x * x + y - 0.1 * y * y, 1e-4);
  }
}

TEST(CatmullRom, GoesOnOverTheDateLineAndThePole) {
  const Grid planet = Grid::sphere(360, 180);
  std::vector<float> values(planet.size());
  const auto height = [](double lat_deg, double lon_deg) {
    const double lat = lat_deg * kPi / 180.0, lon = lon_deg * kPi / 180.0;
    return std::cos(lat) * std::cos(lon) + 2.0 * std::sin(lat);
  };
  for (Index cell = 0; cell < planet.size(); ++cell) {
    values[cell] = static_cast<float>(
        height(planet.latitude_deg(planet.row(cell)), planet.longitude_deg(planet.column(cell))));
  }
  for (const auto& [lat, lon] :
       {std::pair{10.3, 179.9}, {10.3, -179.9}, {89.9, 33.0}, {-89.95, -120.0}, {45.0, 0.0}}) {
    EXPECT_NEAR(CatmullRom(planet, {lat, lon}).of(std::span<const float>(values)), height(lat, lon),
                1e-4)
        << lat << " " << lon;
  }
}

TEST(CatmullRom, RangeIsThatOfTheFourCellsRoundThePlaceOverTheDateLineAndThePole) {
  const Grid planet = Grid::sphere(36, 18);  // cells of 10 degrees, centres at odd multiples of 5
  std::vector<float> values(planet.size());
  for (Index cell = 0; cell < planet.size(); ++cell) values[cell] = static_cast<float>(cell);
  const auto range = [&](double lat, double lon) {
    return CatmullRom(planet, {lat, lon}).range(values);
  };
  const auto value = [&](int i, int j) { return values[planet.cell(i, j)]; };
  EXPECT_EQ(range(1.0, 1.0), (std::pair{value(17, 8), value(18, 9)}));
  EXPECT_EQ(range(-9.0, 8.0), (std::pair{value(18, 7), value(19, 8)}));
  EXPECT_EQ(range(1.0, 179.0), (std::pair{value(0, 8), value(35, 9)}));
  // Beyond the pole the columns are those half-way round.
  EXPECT_EQ(range(89.0, 1.0), (std::pair{value(0, 17), value(35, 17)}));
  EXPECT_EQ(range(-89.0, -99.0), (std::pair{value(7, 0), value(26, 0)}));
  values[planet.cell(17, 8)] = NAN;
  EXPECT_TRUE(std::isnan(range(1.0, 1.0).first));
  EXPECT_TRUE(std::isnan(range(1.0, 1.0).second));
  EXPECT_FALSE(std::isnan(range(11.0, 1.0).first));  // of the cubic's 16, but not of the four
}

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

// Rounding put the antipode of a cell's centre at the centre of the map, with the rivers there.
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

TEST(RegionScore, IsTheFormulaOverTrueAreas) {
  const Grid planet = Grid::sphere(72, 36);
  const Noise noise(4, "heights");
  std::vector<float> z(planet.size());
  std::vector<std::int8_t> boundary(planet.size());
  for (Index cell = 0; cell < planet.size(); ++cell) {
    z[cell] = 9000.0F * noise.fbm(planet.unit_vector(planet.column(cell), planet.row(cell)), 2, 4);
    boundary[cell] = static_cast<std::int8_t>(cell % 7 == 0);
  }
  const Index centre = planet.cell(1, 26);  // the window wraps round
  const double width_m = 4e6, height_m = 2.2e6;
  const auto figures = region_figures(planet, z, boundary, centre, width_m, height_m);
  // Every window of odd size about the centre: one of them is meant.
  bool found = false;
  for (int rows = 1; rows <= 9; ++rows) {
    for (int columns = 1; columns <= 21; ++columns) {
      double area = 0, land = 0, coast = 0, edge = 0, low = 1e9, high = -1e9;
      for (int dj = 0; dj < rows; ++dj) {
        for (int di = 0; di < columns; ++di) {
          const int j = 26 - rows / 2 + dj, i = (1 - columns / 2 + di + 72) % 72;
          const Index cell = planet.cell(i, j);
          const double a = planet.area_m2(j);
          bool shore = false;
          for (const int k : {0, 2, 4, 6}) shore |= z[planet.neighbour(i, j, k)] < 0.0F;
          area += a;
          land += z[cell] >= 0.0F ? a : 0.0;
          coast += z[cell] >= 0.0F && shore ? a : 0.0;
          edge += boundary[cell] != 0 ? a : 0.0;
          low = std::min<double>(low, z[cell]);
          high = std::max<double>(high, z[cell]);
        }
      }
      if (std::abs(figures.land_fraction - land / area) > 1e-9 ||
          std::abs(figures.coast_fraction - coast / area) > 1e-9 ||
          std::abs(figures.boundary_fraction - edge / area) > 1e-9 ||
          std::abs(figures.elevation_range_m - (high - low)) > 0.01) {
        continue;
      }
      found = true;
      const double expected = (1.0 - std::abs(land / area - 0.4) * 2.5) * (coast / area) *
                                  std::min((high - low) / 5000.0, 1.0) *
                                  (1.0 + 2.0 * std::min(edge / area, 0.5)) +
                              0.3 * 0.25;
      EXPECT_NEAR(figures.score(0.25), expected, 1e-9);
    }
  }
  EXPECT_TRUE(found);
}

TEST(RegionScore, FindsTheCoastAndKeepsAwayFromThePoles) {
  const Grid planet = Grid::sphere(144, 72);
  std::vector<float> z(planet.size(), -3000.0F);
  for (int j = 30; j < 44; ++j) {
    for (int i = 60; i < 80; ++i) z[planet.cell(i, j)] = (i + j) % 3 == 0 ? 4000.0F : 300.0F;
  }
  for (int i = 0; i < 144; ++i) z[planet.cell(i, 70)] = 5000.0F;
  int near = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Index best = best_region(planet, z, {}, 2e6, 1e6, seed);
    const int i = planet.column(best), j = planet.row(best);
    EXPECT_LT(std::abs(planet.latitude_deg(j)), 81.0);
    near += i >= 54 && i <= 86 && j >= 26 && j <= 48;
  }
  EXPECT_GE(near, 7);
}

/// A rectangle of land, cells from the middle of a planet of 360 x 180.
void raise_land(const Grid& planet, std::vector<float>& z, int west, int east, int south,
                int north) {
  for (int j = south; j <= north; ++j) {
    for (int i = west; i <= east; ++i) z[planet.cell(180 + i, 90 + j)] = 1000.0F;
  }
}

TEST(RegionLand, TellsIslandsFromCoastsAndStraits) {
  const Grid planet = Grid::sphere(360, 180);
  const double cell_m = planet.step_north_m();
  const Index centre = planet.cell(180, 90);
  const auto land = [&](auto... rectangles) {
    std::vector<float> z(planet.size(), -3000.0F);
    (raise_land(planet, z, rectangles[0], rectangles[1], rectangles[2], rectangles[3]), ...);
    return region_land(planet, z, centre, 21 * cell_m, 11 * cell_m);  // columns +-10, rows +-5
  };
  using Box = std::array<int, 4>;
  const RegionLand island = land(Box{-6, 4, -3, 3});
  EXPECT_DOUBLE_EQ(island.whole, 1.0);
  EXPECT_DOUBLE_EQ(island.weight(), 1.0);
  const RegionLand coast = land(Box{0, 40, -20, 20});
  EXPECT_DOUBLE_EQ(coast.main, 1.0);
  EXPECT_DOUBLE_EQ(coast.weight(), 0.85);
  const RegionLand strait = land(Box{3, 40, -20, 20}, Box{-40, -3, -20, 20});
  EXPECT_NEAR(strait.main, 0.5, 1e-9);
  EXPECT_NEAR(strait.others, 0.5, 1e-9);
  EXPECT_DOUBLE_EQ(strait.weight(), 0.0);
  // Lands that hang together beyond the window are two in it; those that touch at a corner one.
  const RegionLand bay = land(Box{3, 40, -20, 20}, Box{-40, -3, -20, 20}, Box{-40, 40, 15, 20});
  EXPECT_NEAR(bay.others, 0.5, 1e-9);
  EXPECT_DOUBLE_EQ(land(Box{1, 40, 1, 20}, Box{-40, 0, -20, 0}).main, 1.0);
  // An island off a coast.
  const RegionLand both = land(Box{5, 40, -20, 20}, Box{-6, -3, -2, 2});
  EXPECT_NEAR(both.whole, 20.0 / 86.0, 1e-3);
  EXPECT_DOUBLE_EQ(both.others, 0.0);
  EXPECT_DOUBLE_EQ(land().weight(), 1.0);
}

TEST(RegionScore, LooksForLandThatIsWhole) {
  const Grid planet = Grid::sphere(512, 256);
  const double width_m = 1.6e6, height_m = 0.8e6;
  double whole = 0.0, by_figures = 0.0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Noise noise(seed, "land");
    std::vector<float> z(planet.size());
    for (Index c = 0; c < planet.size(); ++c) {
      const auto place = planet.unit_vector(planet.column(c), planet.row(c));
      z[c] = 8000.0F * noise.fbm(place, 3.0, 6) - 700.0F;
    }
    const auto weight_by = [&](RegionRule rule) {
      const Index best = best_region(planet, z, {}, width_m, height_m, seed, rule);
      return region_land(planet, z, best, width_m, height_m).weight();
    };
    EXPECT_GT(weight_by(RegionRule::whole), 0.8) << "seed " << seed;
    whole += weight_by(RegionRule::whole) / 8.0;
    by_figures += weight_by(RegionRule::figures) / 8.0;
  }
  EXPECT_GT(whole, by_figures + 0.15);
}

TEST(RegionScore, WindowsOfOneCellStandOnLandAtTheShore) {
  const Grid planet = Grid::sphere(128, 64);
  std::vector<float> z(planet.size());
  const Noise noise(4, "land");
  for (Index c = 0; c < planet.size(); ++c) {
    const float wave = noise.fbm(planet.unit_vector(planet.column(c), planet.row(c)), 2.0, 4);
    z[c] = 8000.0F * wave - 1000.0F;
  }
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Index best = best_region(planet, z, {}, 100e3, 50e3, seed);
    int land = 0, sea = 0;
    for (int dj = -1; dj <= 1; ++dj) {
      for (int di = -1; di <= 1; ++di) {
        const int i = (planet.column(best) + di + planet.nx()) % planet.nx();
        (z[planet.cell(i, planet.row(best) + dj)] >= 0.0F ? land : sea) += 1;
      }
    }
    EXPECT_GT(land, 0) << "seed " << seed;
    EXPECT_GT(sea, 0) << "seed " << seed;
  }
}

TEST(FineRelief, DetailHasUnitVarianceAndNoEdge) {
  const Grid fine = Grid::equal_area(256, 128, 400.0, Centre{30, 40});
  std::vector<float> detail(fine.size());
  unit_detail(fine, {}, 3, "island.detail", detail);
  double sum = 0.0, squares = 0.0;
  for (const float value : detail) {
    sum += value;
    squares += value * value;
  }
  EXPECT_NEAR(sum / fine.size(), 0.0, 0.35);
  EXPECT_NEAR(squares / fine.size(), 1.0, 0.5);
}

/// A river that comes down a diagonal of the planet's cells, between ridges on either side.
struct DiagonalRiver {
  static constexpr float kSide_m = 800.0F;
  Grid planet = Grid::sphere(360, 180);
  Grid fine = Grid::equal_area(200, 120, 4000.0, Centre{0.0, 0.0});
  PlanetCells cells{planet, fine};
  std::vector<float> elevation_m = std::vector<float>(planet.size(), kSide_m);
  std::vector<Index> receiver = std::vector<Index>(planet.size());
  std::vector<double> area_m2 = std::vector<double>(planet.size());
  std::vector<float> discharge_m3_s = std::vector<float>(planet.size());
  std::vector<float> z = std::vector<float>(fine.size());

  DiagonalRiver() {
    for (Index c = 0; c < planet.size(); ++c) {
      receiver[c] = c;
      area_m2[c] = planet.area_m2(planet.row(c));
    }
    // North-west to south-east, 10 m down in each cell.
    Index last = kNoCell;
    for (int k = 0; k <= 20; ++k) {
      const Index c = planet.cell(170 + k, 99 - k);
      elevation_m[c] = static_cast<float>(400 - 10 * k);
      area_m2[c] = (50.0 + k) * planet.area_m2(planet.row(c));
      discharge_m3_s[c] = static_cast<float>(50 + k);
      if (last != kNoCell) receiver[last] = c;
      last = c;
    }
    for (Index c = 0; c < fine.size(); ++c) {
      const CatmullRom at(planet, fine.position(fine.column(c), fine.row(c)));
      z[c] = static_cast<float>(at.of(std::span<const float>(elevation_m)));
    }
  }
  [[nodiscard]] PlanetWater water() const {
    return {elevation_m, receiver, area_m2, discharge_m3_s, {}};
  }
};

/// A river that runs along the plane's southern edge, a third of a planet cell beyond it, and joins
/// another that comes from the north, near the edge over which both leave.
struct RiverAlongTheEdge : DiagonalRiver {
  Index mouth = planet.cell(183, 89);

  RiverAlongTheEdge() {
    std::fill(elevation_m.begin(), elevation_m.end(), kSide_m);
    std::fill(discharge_m3_s.begin(), discharge_m3_s.end(), 0.0F);
    for (Index c = 0; c < planet.size(); ++c) {
      receiver[c] = c;
      area_m2[c] = planet.area_m2(planet.row(c));
    }
    std::vector<Index> north, south;
    for (int j = 99; j >= 90; --j) north.push_back(planet.cell(182, j));
    for (int i = 170; i <= 181; ++i) south.push_back(planet.cell(i, 87));
    south.push_back(planet.cell(182, 88));
    for (int i = 183; i < 190; ++i) north.push_back(planet.cell(i, 89));
    south.push_back(mouth);
    lay(north, 60);
    lay(south, 40);
    for (Index c = 0; c < fine.size(); ++c) {
      const CatmullRom at(planet, fine.position(fine.column(c), fine.row(c)));
      z[c] = static_cast<float>(at.of(std::span<const float>(elevation_m)));
    }
  }
  void lay(const std::vector<Index>& way, double cells_upstream) {
    for (std::size_t k = 0; k < way.size(); ++k) {
      const bool met = discharge_m3_s[way[k]] > 0.0F;
      if (!met) elevation_m[way[k]] = static_cast<float>(400 - 10 * static_cast<int>(k));
      if (k + 1 < way.size()) receiver[way[k]] = way[k + 1];
      if (met) break;
      area_m2[way[k]] = (cells_upstream + static_cast<double>(k)) * planet.area_m2(89);
      discharge_m3_s[way[k]] = static_cast<float>(cells_upstream) + static_cast<float>(k);
    }
    if (way.back() != mouth) return;
    for (Index c = mouth; c != receiver[c]; c = receiver[c]) {
      area_m2[c] += area_m2[way[way.size() - 2]];
      discharge_m3_s[c] += discharge_m3_s[way[way.size() - 2]];
    }
  }
};

TEST(RiverCourses, ThatRunAlongTheEdgeAndMeetNearItLeaveTogether) {
  RiverAlongTheEdge river;
  std::vector<double> area(river.fine.size());
  std::vector<float> inflow(river.fine.size());
  const auto crossings = find_inflow(river.cells, river.water(), river.z, area, inflow);
  ASSERT_EQ(crossings.rivers.size(), 3U);  // two come in, one goes out
  std::vector<std::uint8_t> outlets = find_outlets(river.fine, river.z);
  for (Index c = 0; c < river.fine.size(); ++c) {
    if (area[c] > 0.0) outlets[c] = 0;
  }
  RiverCourses courses = trace_river_courses(river.cells, river.water(), crossings, 1, river.z);
  open_river_courses(river.fine, outlets, courses, river.z);
  std::vector<double> water(inflow.begin(), inflow.end());
  route_water(river.fine, river.z, outlets).graph.accumulate(water);
  double most_m3_s = 0.0;
  for (const RiverCrossing& crossing : crossings.rivers) {
    most_m3_s = std::max(most_m3_s, water[crossing.edge_cell]);
  }
  // Less what falls within the plane.
  EXPECT_GT(most_m3_s, 0.85 * river.discharge_m3_s[river.mouth]);
  EXPECT_LT(most_m3_s, 1.01 * river.discharge_m3_s[river.mouth]);
}

TEST(Inflow, RiverEntersWithWhatGatheredOutside) {
  DiagonalRiver river;
  std::vector<double> area(river.fine.size());
  std::vector<float> inflow(river.fine.size());
  const auto crossings = find_inflow(river.cells, river.water(), river.z, area, inflow);
  ASSERT_EQ(crossings.rivers.size(), 2U);  // in and out
  const Index first = crossings.rivers.front().planet_cell,
              second = crossings.rivers.back().planet_cell;
  const Index in = river.area_m2[first] < river.area_m2[second] ? first : second;
  double entered_m2 = 0.0, entered_m3_s = 0.0;
  for (Index c = 0; c < river.fine.size(); ++c) {
    if (area[c] == 0.0) continue;
    entered_m3_s += inflow[c];
    if (inflow[c] > 0.0F) entered_m2 += area[c];
    EXPECT_TRUE(river.fine.is_open_edge(river.fine.column(c), river.fine.row(c)));
  }
  // All that gathered outside, and what falls on the outer part of the first cell inside.
  const double own_m2 = river.planet.area_m2(river.planet.row(in));
  EXPECT_LE(entered_m2, river.area_m2[in] + own_m2);
  EXPECT_GE(entered_m2, river.area_m2[in] - 0.6 * own_m2);
  EXPECT_NEAR(entered_m3_s, entered_m2 / river.area_m2[in] * river.discharge_m3_s[in],
              0.02 * entered_m3_s);
}

TEST(RiverCourses, LeaveNoDamAndRaiseNothing) {
  DiagonalRiver river;
  std::vector<double> area(river.fine.size());
  std::vector<float> inflow(river.fine.size());
  const auto crossings = find_inflow(river.cells, river.water(), river.z, area, inflow);
  // Whether water gets from where it comes in to where it goes out without rising higher.
  const auto passes_below = [&](float limit_m) {
    std::vector<std::uint8_t> reached(river.fine.size());
    std::vector<Index> front{crossings.rivers.back().edge_cell};
    while (!front.empty()) {
      const Index c = front.back();
      front.pop_back();
      if (reached[c] != 0 || river.z[c] > limit_m) continue;
      reached[c] = 1;
      for (int k = 0; k < kDirections; ++k) {
        if (const Index next = river.fine.neighbour(c, k); next != kNoCell) front.push_back(next);
      }
    }
    return reached[crossings.rivers.front().edge_cell] != 0;
  };
  const float river_m = std::max(river.z[crossings.rivers.front().edge_cell],
                                 river.z[crossings.rivers.back().edge_cell]);
  EXPECT_FALSE(passes_below(river_m + 50.0F)) << "interpolation dams nothing: no case";
  const std::vector<float> before = river.z;
  RiverCourses courses = trace_river_courses(river.cells, river.water(), crossings, 1, river.z);
  open_river_courses(river.fine, find_outlets(river.fine, river.z), courses, river.z);
  EXPECT_TRUE(passes_below(river_m + 1.0F));
  for (Index c = 0; c < river.fine.size(); ++c) {
    ASSERT_LE(river.z[c], before[c]);
    if (!river.fine.is_open_edge(river.fine.column(c), river.fine.row(c))) continue;
    if (c == crossings.rivers.front().edge_cell || c == crossings.rivers.back().edge_cell) continue;
    ASSERT_EQ(river.z[c], before[c]);
  }
}

// A hairpin whose arms a low saddle joins: over it the water took the short way.
TEST(RiverCourses, KeepTheirWaterAllTheWayRoundABend) {
  const Grid grid = Grid::plane(40, 40, 1000.0, 1000.0);
  std::vector<float> z(grid.size(), 200.0F);
  for (int j = 16; j < 25; ++j) z[grid.cell(30, j)] = 110.0F;
  std::vector<Index> way;  // downstream
  for (int i = 36; i > 5; --i) way.push_back(grid.cell(i, 25));
  for (int j = 25; j > 15; --j) way.push_back(grid.cell(5, j));
  for (int i = 5; i < 40; ++i) way.push_back(grid.cell(i, 15));
  std::vector<std::uint8_t> outlets = find_outlets(grid, z);
  const auto water_at_the_bend = [&](int shortcut) {
    RiverCourses courses;
    courses.shortcut = shortcut;
    const auto n = static_cast<std::int32_t>(way.size());
    for (std::int32_t k = 0; k < n; ++k) {
      courses.cell.push_back(way[n - 1 - k]);
      courses.next.push_back(k == 0 ? kCourseEnds : k - 1);
      courses.level_m.push_back(80.0F + 100.0F * static_cast<float>(k) / static_cast<float>(n));
      courses.least_m.push_back(0.0F);
    }
    std::vector<float> opened = z;
    open_river_courses(grid, outlets, courses, opened);
    std::vector<double> water(grid.size(), 0.0);
    water[way.front()] = 1.0;
    route_water(grid, opened, outlets).graph.accumulate(water);
    return water[grid.cell(5, 20)];
  };
  EXPECT_EQ(water_at_the_bend(8), 1.0);
  EXPECT_EQ(water_at_the_bend(1000), 0.0) << "the saddle is no case";
}

// Even sides are planes, on which brooks run side by side.
TEST(RiverCourses, SidesOfCutsAreAsUnevenAsTheGroundAndNowhereSteeperThanWithoutIt) {
  DiagonalRiver river;
  std::vector<double> area(river.fine.size());
  std::vector<float> inflow(river.fine.size());
  const auto crossings = find_inflow(river.cells, river.water(), river.z, area, inflow);
  const RiverCourses courses =
      trace_river_courses(river.cells, river.water(), crossings, 1, river.z);
  ASSERT_EQ(courses.side_slope.size(), river.z.size());
  const auto [gentlest, steepest] =
      std::minmax_element(courses.side_slope.begin(), courses.side_slope.end());
  EXPECT_LE(*steepest, 0.15F);
  EXPECT_LT(*gentlest, 0.5F * *steepest);
  EXPECT_GT(*gentlest, 0.0F);

  const auto opened = [&](std::vector<float> side_slope) {
    RiverCourses with = courses;
    with.side_slope = std::move(side_slope);
    std::vector<float> z = river.z;
    open_river_courses(river.fine, find_outlets(river.fine, z), with, z);
    return z;
  };
  const auto even = opened({}), uneven = opened(courses.side_slope);
  EXPECT_EQ(opened(std::vector<float>(river.z.size(), 0.15F)), even);
  int sides = 0, gentler = 0;
  for (Index c = 0; c < river.fine.size(); ++c) {
    ASSERT_LE(uneven[c], even[c] + 1e-3F) << "cell " << c;
    if (std::find(courses.cell.begin(), courses.cell.end(), c) != courses.cell.end()) continue;
    sides += uneven[c] < river.z[c] ? 1 : 0;
    gentler += uneven[c] < even[c] - 1.0F ? 1 : 0;
  }
  EXPECT_GT(sides, 20);
  EXPECT_GT(gentler, sides / 2);
}

}  // namespace
}  // namespace geo
