// Rivers of a planet that enter a fine plane, and the beds that they get there.
#include "geo/kernels/landscape/river_courses.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "geo/core/field.hpp"
#include "geo/kernels/remapping/catmull_rom.hpp"
#include "geo/kernels/remapping/planet_cells.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "geo/kernels/water/inflow.hpp"

namespace geo {
namespace {

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

/// The river runs through a lake that the plane's edge cuts, into which another falls within the
/// plane, and perhaps a third at the very cell that the lake spills into.
struct LakeAcrossTheEdge : DiagonalRiver {
  static constexpr int kFirst = 5, kLast = 9;  // cells of the river, 8 and more inside
  static constexpr float kWithin_m3_s = 30.0F, kLoss_m3_s = 4.0F;
  std::vector<std::int32_t> lake_id = std::vector<std::int32_t>(planet.size());

  explicit LakeAcrossTheEdge(float at_sill_m3_s) {
    const float outflow_m3_s =
        discharge_m3_s[of_river(kFirst - 1)] + kWithin_m3_s + at_sill_m3_s - kLoss_m3_s;
    for (int k = kFirst; k <= kLast; ++k) {
      lake_id[of_river(k)] = 1;
      discharge_m3_s[of_river(k)] = outflow_m3_s;
    }
    fall_into(of_river(kLast), kWithin_m3_s);
    fall_into(of_river(kLast + 1), at_sill_m3_s);
  }
  [[nodiscard]] Index of_river(int k) const { return planet.cell(170 + k, 99 - k); }
  void fall_into(Index cell, float river_m3_s) {
    const Index from = planet.cell(planet.column(cell), planet.row(cell) + 1);
    receiver[from] = cell;
    discharge_m3_s[from] = river_m3_s;
  }
  /// What comes in over the edge.
  [[nodiscard]] double entered_m3_s() {
    std::vector<double> area(fine.size());
    std::vector<float> inflow(fine.size());
    find_inflow(cells, {elevation_m, receiver, area_m2, discharge_m3_s, lake_id}, z, area, inflow);
    return std::accumulate(inflow.begin(), inflow.end(), 0.0);
  }
};

TEST(Inflow, LakesThatTheEdgeCutsPassOnTheRiversAboveItAlone) {
  using Lake = LakeAcrossTheEdge;
  Lake quiet(0.0F), fed_at_its_sill(25.0F);
  const double above_m3_s = quiet.discharge_m3_s[quiet.of_river(Lake::kFirst - 1)];
  const double passes_m3_s =
      above_m3_s * (1.0 - Lake::kLoss_m3_s / (above_m3_s + Lake::kWithin_m3_s));
  EXPECT_NEAR(quiet.entered_m3_s(), passes_m3_s, 0.02 * passes_m3_s);
  EXPECT_NEAR(fed_at_its_sill.entered_m3_s(), passes_m3_s, 0.02 * passes_m3_s);
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

// A hairpin whose arms a low saddle joins, over which water would take the short way.
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
