#include "geo/kernels/climate/mountain_barrier.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace geo {
namespace {

constexpr float kWind_m_s = 10.0F;

struct Flow {
  Flow(const Grid& grid, std::span<const float> open, double turned_share)
      : east(open.size(), kWind_m_s), north(open.size(), 0.0F) {
    MountainBarrier(grid, open).turn_aside(turned_share, east, north);
  }
  std::vector<float> east, north;
};

/// A range along a meridian of a torus, `pass` rows of it open.
std::vector<float> range(const Grid& grid, int column, float open, int pass) {
  std::vector<float> result(static_cast<std::size_t>(grid.size()), 1.0F);
  for (int j = pass; j < grid.ny(); ++j) result[grid.cell(column, j)] = open;
  return result;
}

// Round a torus a current of air that cannot turn aside is as strong everywhere, and as if faces
// were resistances in series: u over the mean of 1 / a.
TEST(MountainBarrier, NoAirIsLostAtAWallWithoutEnds) {
  const Grid grid = Grid::torus(24, 8, 1e5, 1e5);
  constexpr float kOpen = 0.2F;
  const Flow flow(grid, range(grid, 10, kOpen, 0), 1.0);
  const double face = 2.0 * kOpen / (1.0 + kOpen), resistance = (22.0 + 2.0 / face) / 24.0;
  for (Index c = 0; c < grid.size(); ++c) {
    EXPECT_NEAR(flow.east[c], kWind_m_s / resistance, 1e-4) << grid.column(c);
    EXPECT_NEAR(flow.north[c], 0.0, 1e-4);
  }
}

TEST(MountainBarrier, AirThatDoesNotTurnAsideIsHeldBackInPlace) {
  const Grid grid = Grid::torus(24, 8, 1e5, 1e5);
  constexpr float kOpen = 0.2F;
  const Flow flow(grid, range(grid, 10, kOpen, 0), 0.0);
  const float face = 2.0F * kOpen / (1.0F + kOpen);
  for (Index c = 0; c < grid.size(); ++c) {
    const int away = std::abs(grid.column(c) - 10);
    const float passing = away == 0 ? face : away == 1 ? 0.5F * (1.0F + face) : 1.0F;
    EXPECT_NEAR(flow.east[c], passing * kWind_m_s, 1e-5) << grid.column(c);
  }
}

TEST(MountainBarrier, AirBlowsThroughGaps) {
  const Grid grid = Grid::torus(48, 32, 1e5, 1e5);
  const Flow flow(grid, range(grid, 20, 0.01F, 6), 1.0);
  EXPECT_GT(flow.east[grid.cell(20, 3)], 1.5F * kWind_m_s) << "in the gap";
  EXPECT_LT(flow.east[grid.cell(20, 19)], 0.5F * kWind_m_s) << "at the range";
  // Before the range the air goes to the gap, behind it away from there.
  EXPECT_LT(flow.north[grid.cell(17, 12)], -0.5F);
  EXPECT_GT(flow.north[grid.cell(23, 12)], 0.5F);
  // As much goes through every meridian.
  for (const int column : {5, 20, 40}) {
    double through = 0.0;
    for (int j = 0; j < grid.ny(); ++j) through += flow.east[grid.cell(column, j)] / grid.ny();
    double before = 0.0;
    for (int j = 0; j < grid.ny(); ++j) before += flow.east[grid.cell(0, j)] / grid.ny();
    EXPECT_NEAR(through, before, 0.01 * kWind_m_s) << column;
  }
}

TEST(MountainBarrier, OpenGroundLeavesTheWindAsItIs) {
  const Grid grid = Grid::sphere(36, 18);
  const auto size = static_cast<std::size_t>(grid.size());
  std::vector<float> east(size), north(size);
  for (std::size_t c = 0; c < size; ++c) {
    east[c] = static_cast<float>(std::sin(0.1 * static_cast<double>(c)));
    north[c] = static_cast<float>(std::cos(0.1 * static_cast<double>(c)));
  }
  const auto east_before = east, north_before = north;
  MountainBarrier(grid, std::vector<float>(size, 1.0F)).turn_aside(1.0, east, north);
  for (std::size_t c = 0; c < size; ++c) {
    EXPECT_NEAR(east[c], east_before[c], 1e-6);
    EXPECT_NEAR(north[c], north_before[c], 1e-6);
  }
}

}  // namespace
}  // namespace geo
