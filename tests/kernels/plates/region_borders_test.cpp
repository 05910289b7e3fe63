// Borders between regions of a sphere of cells.
#include "geo/kernels/plates/region_borders.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geo/core/place.hpp"
#include "geo/core/random.hpp"

namespace geo {
namespace {

constexpr double kSphere = 4.0 * std::numbers::pi;

/// Area of a region, as its rings have it.
double area_sr(const BorderedRegion& region) {
  double area = area_to_the_left_sr(region.outside);
  for (const auto& hole : region.holes) area -= kSphere - area_to_the_left_sr(hole);
  return area;
}

std::vector<std::int32_t> labels(const Grid& grid, auto of_place) {
  std::vector<std::int32_t> label(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    label[cell] = of_place(grid.position(grid.column(cell), grid.row(cell)));
  }
  return label;
}

TEST(RegionBorders, RegionsOfAnyLabelsTogetherCoverTheSphere) {
  const Grid grid = Grid::sphere(24, 12);
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    const RandomStream random(seed, "labels");
    std::vector<std::int32_t> label(grid.size());
    for (Index cell = 0; cell < grid.size(); ++cell) {
      label[cell] = static_cast<std::int32_t>(3.0 * random.uniform(cell));
    }
    const RegionBorders borders(grid, label);
    double area = 0.0;
    for (const BorderedRegion& region : borders.regions()) {
      EXPECT_EQ(region.outside.front(), region.outside.back());
      area += area_sr(region);
    }
    EXPECT_NEAR(area, kSphere, 1e-9);  // as they share all points: round-off alone
  }
}

TEST(RegionBorders, EachSideOfCellsIsInOneLineAndInTheRingsOfBothItsCells) {
  const Grid grid = Grid::sphere(24, 12);
  const RandomStream random(7, "labels");
  std::vector<std::int32_t> label(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) label[cell] = random.uniform(cell) < 0.4 ? 1 : 2;
  const RegionBorders borders(grid, label);
  std::size_t in_lines = 0, in_rings = 0, sides = 0;
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const Index east = grid.neighbour(cell, kEast);
    sides += label[cell] != label[east] ? 1 : 0;
    if (grid.row(cell) + 1 < grid.ny()) sides += label[cell] != label[cell + grid.nx()] ? 1 : 0;
  }
  for (const BorderLine& line : borders.lines()) {
    const bool closed = line.points.front().left != kNoCell;
    for (const BorderPoint& point : line.points) {
      if (point.left == kNoCell) continue;
      ++in_lines;
      EXPECT_EQ(label[point.left], line.left);
      EXPECT_EQ(label[point.right], line.right);
    }
    if (closed) --in_lines;
  }
  for (const BorderedRegion& region : borders.regions()) {
    in_rings += region.outside.size() - 1;
    for (const auto& hole : region.holes) in_rings += hole.size() - 1;
  }
  EXPECT_EQ(in_lines, sides);
  EXPECT_GE(in_rings, 2 * sides);  // and the corners where borders meet
}

TEST(RegionBorders, CapRoundAPoleIsOneRingWithThePoleToItsLeft) {
  const Grid grid = Grid::sphere(360, 180);
  for (const double sign : {1.0, -1.0}) {
    const auto label =
        labels(grid, [&](const Centre& at) { return sign * at.latitude_deg > 60.0; });
    const RegionBorders borders(grid, label);
    ASSERT_EQ(borders.lines().size(), 1U);
    ASSERT_EQ(borders.regions().size(), 2U);
    for (const BorderedRegion& region : borders.regions()) {
      EXPECT_TRUE(region.holes.empty());
      const double cap = 2.0 * std::numbers::pi * (1.0 - std::sin(std::numbers::pi / 3.0));
      // The border half-way between rows is the parallel itself but for chords of one degree.
      EXPECT_NEAR(area_sr(region), region.label == 1 ? cap : kSphere - cap, 1e-3);
    }
  }
}

TEST(RegionBorders, LakeInAnIslandIsItsHole) {
  const Grid grid = Grid::sphere(72, 36);
  const auto label = labels(grid, [](const Centre& at) {
    const double far =
        std::hypot(at.latitude_deg - 5.0, std::remainder(at.longitude_deg - 175.0, 360.0));
    return far < 12.0 ? kNoLabel : far < 30.0 ? 4 : kNoLabel;
  });
  const RegionBorders borders(grid, label);
  ASSERT_EQ(borders.regions().size(), 1U);
  EXPECT_EQ(borders.regions()[0].label, 4);
  ASSERT_EQ(borders.regions()[0].holes.size(), 1U);
  EXPECT_GT(area_to_the_left_sr(borders.regions()[0].holes[0]), 0.9 * kSphere);
}

TEST(RegionBorders, InterpolatedBorderIsTheContourOfAField) {
  const Grid grid = Grid::sphere(90, 45);
  // Straight in latitude: its zero is the parallel of 11 degrees, off the sides of cells.
  const auto height = [&](Index cell) { return grid.latitude_deg(grid.row(cell)) - 11.0; };
  std::vector<std::int32_t> label(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) label[cell] = height(cell) > 0.0 ? 1 : 0;
  const RegionBorders borders(
      grid, label, [&](Index a, Index b) { return height(a) / (height(a) - height(b)); });
  for (const BorderPoint& point : borders.lines()[0].points) {
    EXPECT_NEAR(place_of(point.place).latitude_deg, 11.0, 1e-3);  // of chords of 4 degrees
  }
}

TEST(RegionBorders, OneLabelHasNoBorder) {
  const Grid grid = Grid::sphere(8, 4);
  const RegionBorders borders(grid, std::vector<std::int32_t>(grid.size(), 3));
  EXPECT_TRUE(borders.lines().empty());
  EXPECT_TRUE(borders.regions().empty());
}

}  // namespace
}  // namespace geo
