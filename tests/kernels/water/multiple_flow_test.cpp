#include "geo/kernels/water/multiple_flow.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "geo/kernels/water/flow_graph.hpp"
#include "support/terrain.hpp"

namespace geo {
namespace {

std::vector<FlowPartition> all_partitions() {
  return {{FlowMethod::steepest},      {FlowMethod::d_infinity},
          {FlowMethod::multiple, 1.0}, {FlowMethod::multiple, 1.0, true},
          {FlowMethod::multiple, 1.1}, {FlowMethod::multiple, 4.0}};
}

std::vector<double> cell_areas(const Grid& grid) {
  std::vector<double> area(grid.size());
  for (Index c = 0; c < grid.size(); ++c) area[c] = grid.area_m2(grid.row(c));
  return area;
}

TEST(MultipleFlow, EveryDropOfAHundredTerrainsReachesAnOutlet) {
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);  // the grids are too small for more
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const auto grids = test::small_grids();
    const Grid& grid = grids[seed % grids.size()];
    const auto z = test::random_terrain(grid, seed);
    const auto outlets = find_outlets(grid, z);
    const Routing routing = route_water(grid, z, outlets, true);
    for (const FlowPartition& partition : all_partitions()) {
      auto area = cell_areas(grid);
      accumulate_flow(grid, routing.filled_m, routing.graph.receiver, partition, area);
      double arrived = 0.0;
      for (Index c = 0; c < grid.size(); ++c) {
        ASSERT_GE(area[c], grid.area_m2(grid.row(c)) * (1.0 - 1e-12)) << "seed " << seed;
        if (outlets[c] != 0) arrived += area[c];
      }
      ASSERT_NEAR(arrived / grid.total_area_m2(), 1.0, 1e-11) << "seed " << seed;
    }
  }
  omp_set_num_threads(threads);
}

TEST(MultipleFlow, SteepestIsTheSingleFlowAccumulation) {
  for (const Grid& grid : test::small_grids()) {
    const auto z = test::random_terrain(grid, 7);
    const Routing routing = route_water(grid, z, find_outlets(grid, z), true);
    auto single = cell_areas(grid), here = single;
    routing.graph.accumulate(single);
    accumulate_flow(grid, routing.filled_m, routing.graph.receiver, {FlowMethod::steepest}, here);
    for (Index c = 0; c < grid.size(); ++c) ASSERT_NEAR(here[c] / single[c], 1.0, 1e-12);
  }
}

TEST(MultipleFlow, LargeExponentsApproachTheSteepestNeighbour) {
  const Grid grid = Grid::plane(30, 30, 10.0, 10.0);
  const auto z = test::random_terrain(grid, 3);
  std::vector<Index> receiver(grid.size());
  // Without flats or lakes: single flow on the raw surface, pits keep what they get.
  steepest_receivers(grid, z, find_outlets(grid, z), receiver);
  auto steepest = cell_areas(grid), sharp = steepest;
  accumulate_flow(grid, z, receiver, {FlowMethod::steepest}, steepest);
  accumulate_flow(grid, z, receiver, {FlowMethod::multiple, 2000.0}, sharp);
  int close = 0;
  for (Index c = 0; c < grid.size(); ++c) close += std::abs(sharp[c] / steepest[c] - 1.0) < 1e-2;
  EXPECT_GT(close, 0.97 * grid.size());
}

TEST(MultipleFlow, SharesGoAsPowersOfSlope) {
  // One cell with three lower neighbours; slopes 3 to the east, 2 to the north, 1 diagonally.
  const Grid grid = Grid::plane(5, 5, 1.0, 1.0, Edges::closed);
  std::vector<float> z(25, 10.0F);
  const Index centre = grid.cell(2, 2), east = grid.cell(3, 2), north = grid.cell(2, 3),
              south_west = grid.cell(1, 1);
  z[east] = 7.0F;
  z[north] = 8.0F;
  z[south_west] = static_cast<float>(10.0 - std::sqrt(2.0));
  std::vector<Index> receiver(25);
  for (Index c = 0; c < 25; ++c) receiver[c] = c;
  receiver[centre] = east;
  for (const double p : {1.0, 1.1, 2.0, 4.0}) {
    std::vector<double> water(25, 0.0);
    water[centre] = 1.0;
    accumulate_flow(grid, z, receiver, {FlowMethod::multiple, p}, water);
    const double sum = std::pow(3.0, p) + std::pow(2.0, p) + 1.0;
    EXPECT_NEAR(water[east], std::pow(3.0, p) / sum, 1e-6) << "exponent " << p;
    EXPECT_NEAR(water[north], std::pow(2.0, p) / sum, 1e-6) << "exponent " << p;
    EXPECT_NEAR(water[south_west], 1.0 / sum, 1e-6) << "exponent " << p;
  }
}

TEST(MultipleFlow, DInfinitySplitsByAngle) {
  const Grid grid = Grid::plane(9, 9, 1.0, 1.0);
  for (const double angle_deg : {0.0, 10.0, 45.0, 60.0, 90.0, 190.0, 280.0}) {
    const double angle = angle_deg * M_PI / 180.0;  // clockwise from north
    std::vector<float> z(81);
    std::vector<Index> receiver(81);
    for (Index c = 0; c < 81; ++c) {
      z[c] = static_cast<float>(-100.0 * (grid.x_m(grid.column(c)) * std::sin(angle) +
                                          grid.y_m(grid.row(c)) * std::cos(angle)));
    }
    steepest_receivers(grid, z, std::vector<std::uint8_t>(81, 0), receiver);
    std::vector<double> water(81, 0.0);
    const Index centre = grid.cell(4, 4);
    water[centre] = 1.0;
    // Neighbours are made roots to see what they get.
    for (int k = 0; k < kDirections; ++k) {
      const Index to = grid.neighbour(centre, k);
      receiver[to] = to;
    }
    accumulate_flow(grid, z, receiver, {FlowMethod::d_infinity}, water);
    for (int k = 0; k < kDirections; ++k) {
      double away = std::abs(angle_deg - 45.0 * k);
      away = std::min(away, 360.0 - away);
      EXPECT_NEAR(water[grid.neighbour(centre, k)], std::max(0.0, 1.0 - away / 45.0), 1e-5)
          << "angle " << angle_deg << " direction " << k;
    }
  }
}

// A planet that dips towards the middle of a column on the equator.
std::vector<float> dipping_planet(const Grid& grid, int column) {
  const double longitude = grid.longitude_deg(column) * M_PI / 180.0;
  std::vector<float> z(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    const auto p = grid.unit_vector(grid.column(c), grid.row(c));
    z[c] = static_cast<float>(5000.0 -
                              4000.0 * (p[0] * std::cos(longitude) + p[1] * std::sin(longitude)));
  }
  return z;
}

TEST(MultipleFlow, TheSeamIsLikeAnyOtherMeridian) {
  const Grid grid = Grid::sphere(64, 32);
  const auto flow = [&](int column, const FlowPartition& partition) {
    const auto z = dipping_planet(grid, column);
    const Routing routing = route_water(grid, z, find_outlets(grid, z), true);
    auto area = cell_areas(grid);
    accumulate_flow(grid, routing.filled_m, routing.graph.receiver, partition, area);
    return area;
  };
  const FlowPartition partition{FlowMethod::multiple, 1.1};
  const auto at_seam = flow(0, partition), inside = flow(20, partition);
  for (Index c = 0; c < grid.size(); ++c) {
    const Index turned = grid.cell((grid.column(c) + 20) % 64, grid.row(c));
    ASSERT_NEAR(at_seam[c] / inside[turned], 1.0, 0.02);
  }
}

TEST(MultipleFlow, FlowsOverThePole) {
  const Grid grid = Grid::sphere(64, 32);
  const auto z = dipping_planet(grid, 20);
  std::vector<Index> receiver(grid.size());
  steepest_receivers(grid, z, std::vector<std::uint8_t>(grid.size(), 0), receiver);
  for (const int row : {0, 31}) {
    // Behind the pole, on the meridian that leads straight over it to the low side.
    const Index source = grid.cell(20 + 32, row);
    const int towards = row == 0 ? kSouth : kNorth;
    auto ends = receiver;
    for (int k = 0; k < kDirections; ++k) {
      const Index to = grid.neighbour(source, k);
      ends[to] = to;
    }
    const auto over_the_pole = [&](const FlowPartition& partition, bool straight) {
      std::vector<double> water(grid.size(), 0.0);
      water[source] = 1.0;
      accumulate_flow(grid, z, ends, partition, water);
      if (straight) return water[grid.neighbour(source, towards)];
      return water[grid.cell(19, row)] + water[grid.cell(20, row)] + water[grid.cell(21, row)];
    };
    EXPECT_NEAR(over_the_pole({FlowMethod::d_infinity}, true), 1.0, 1e-6);
    EXPECT_NEAR(over_the_pole({FlowMethod::steepest}, false), 1.0, 1e-6);
    EXPECT_GT(over_the_pole({FlowMethod::multiple, 1.1}, false), 0.7);
  }
}

TEST(MultipleFlow, SameBitsForAnyNumberOfThreads) {
  const Grid grid = Grid::sphere(120, 60);
  const auto z = test::random_terrain(grid, 9);
  const Routing routing = route_water(grid, z, find_outlets(grid, z), true);
  const int threads = omp_get_max_threads();
  for (const FlowPartition& partition : all_partitions()) {
    auto one = cell_areas(grid), four = one;
    omp_set_num_threads(1);
    accumulate_flow(grid, routing.filled_m, routing.graph.receiver, partition, one);
    omp_set_num_threads(4);
    accumulate_flow(grid, routing.filled_m, routing.graph.receiver, partition, four);
    EXPECT_EQ(one, four);
  }
  omp_set_num_threads(threads);
}

TEST(MultipleFlow, RefusesWhatMakesNoSense) {
  const Grid grid = Grid::plane(5, 5, 1.0, 1.0);
  const std::vector<float> z(25, 1.0F);
  std::vector<Index> receiver(25);
  for (Index c = 0; c < 25; ++c) receiver[c] = c;
  std::vector<double> values(25, 1.0), few(24, 1.0);
  EXPECT_THROW(accumulate_flow(grid, z, receiver, {}, few), InputError);
  EXPECT_THROW(accumulate_flow(grid, z, receiver, {FlowMethod::multiple, 0.0}, values), InputError);
  receiver[6] = 7;
  receiver[7] = 6;
  EXPECT_THROW(accumulate_flow(grid, z, receiver, {}, values), Bug);
}

}  // namespace
}  // namespace geo
