#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>

#include "geo/core/error.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "geo/kernels/water/flow_graph.hpp"
#include "support/terrain.hpp"

namespace geo {
namespace {

/// Reference filling: the plain priority-flood of Barnes et al. (2014).
std::vector<float> flood(const Grid& grid, const std::vector<float>& z,
                         const std::vector<std::uint8_t>& outlets) {
  using Entry = std::pair<float, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  std::vector<float> filled(z.size(), std::numeric_limits<float>::quiet_NaN());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    if (outlets[cell] == 0) continue;
    filled[cell] = z[cell];
    open.emplace(z[cell], cell);
  }
  while (!open.empty()) {
    const auto [level, cell] = open.top();
    open.pop();
    for (int k = 0; k < kDirections; ++k) {
      const Index to = grid.neighbour(cell, k);
      if (to == kNoCell || !std::isnan(filled[to])) continue;
      filled[to] = std::max(level, z[to]);
      open.emplace(filled[to], to);
    }
  }
  return filled;
}

/// Calls body(grid, terrain, outlets, description) on 25 seeds of each topology.
template <class Body>
void on_many_terrains(Body&& body) {
  for (const Grid& grid : test::small_grids()) {
    for (std::uint64_t seed = 1; seed <= 25; ++seed) {
      SCOPED_TRACE("topology " + std::to_string(static_cast<int>(grid.topology())) + ", seed " +
                   std::to_string(seed));
      auto z = test::random_terrain(grid, seed);
      if (seed % 3 == 0) {  // flats and lakes as in integer data
        for (float& height : z) height = std::round(height / 60.0F) * 60.0F;
      }
      if (seed % 5 == 0) {  // a world without a sea
        for (float& height : z) height += 5000.0F;
      }
      if (seed % 7 == 0) {  // drops that vanish when they are divided by a distance
        for (float& height : z) height *= height > 0.0F ? 1e-41F : 1.0F;
      }
      body(grid, z, find_outlets(grid, z));
    }
  }
}

TEST(Water, FilledSurfaceEqualsPriorityFlood) {
  on_many_terrains([](const Grid& grid, const auto& z, const auto& outlets) {
    std::vector<float> filled(z.size());
    fill_depressions(grid, z, outlets, filled);
    ASSERT_EQ(filled, flood(grid, z, outlets));
    ASSERT_EQ(route_water(grid, z, outlets, true).filled_m, filled);
  });
}

TEST(Water, OrderHoldsForAnyNumberOfDonors) {
  for (const int donors : {0, 1, 8, 254, 255, 256, 257, 640, 65'536, 100'000}) {
    // A star, and beyond its centre a chain: the centre stands after all its donors.
    std::vector<Index> receiver(donors + 2, 0);
    receiver[0] = donors + 1;
    receiver[donors + 1] = donors + 1;
    const std::vector<Index> order = downstream_order(receiver);
    ASSERT_EQ(order.size(), receiver.size());
    ASSERT_EQ(order[donors], 0) << donors << " donors";
    ASSERT_EQ(order[donors + 1], donors + 1) << donors << " donors";
    auto sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (Index cell = 0; cell < donors + 2; ++cell) ASSERT_EQ(sorted[cell], cell);
  }
}

TEST(Water, CyclesAreFound) {
  FlowGraph large;
  large.receiver.resize(600'000);
  for (Index cell = 0; cell < 600'000; ++cell) large.receiver[cell] = (cell + 1) % 600'000;
  EXPECT_THROW(large.put_in_order(), Bug);
  EXPECT_THROW(downstream_order(std::vector<Index>{1, 2, 0}), Bug);
  std::vector<Index> star(1000, 0);
  star[0] = 1;  // and 1 drains to 0
  EXPECT_THROW(downstream_order(star), Bug);
}

/// A million cells of hills and hollows.
struct ManyCells {
  Grid grid = Grid::sphere(1440, 720);
  FlowGraph graph;
  ManyCells() {
    const auto z = test::random_terrain(grid, 3);
    graph = route_water(grid, z, find_outlets(grid, z)).graph;
  }
};

TEST(Water, PartsOfTheOrderDrainIntoNoOther) {
  const ManyCells land;
  const FlowGraph& graph = land.graph;
  const auto parts = static_cast<int>(graph.part_begins.size()) - 1;
  ASSERT_GT(parts, 4);
  std::vector<int> part_of(graph.order.size(), parts);
  std::vector<std::size_t> position(graph.order.size(), graph.order.size());
  for (int part = 0; part < parts; ++part) {
    for (Index at = graph.part_begins[part]; at < graph.part_begins[part + 1]; ++at) {
      part_of[graph.order[at]] = part;
    }
  }
  for (std::size_t at = 0; at < graph.order.size(); ++at) position[graph.order[at]] = at;
  for (Index cell = 0; cell < land.grid.size(); ++cell) {
    const Index to = graph.receiver[cell];
    if (to == cell) continue;
    ASSERT_LT(position[cell], position[to]);
    ASSERT_TRUE(part_of[to] == part_of[cell] || part_of[to] == parts);
  }
  EXPECT_GT(graph.part_begins.back(), 0.8 * land.grid.size()) << "most of the work is in parts";
}

TEST(Water, OrderAndSumsDependOnNoNumberOfThreads) {
  const auto drained = [](int threads) {
    const int before = omp_get_max_threads();
    omp_set_num_threads(threads);
    const ManyCells land;
    std::vector<double> area_m2(land.grid.size());
    for (Index c = 0; c < land.grid.size(); ++c) area_m2[c] = land.grid.area_m2(land.grid.row(c));
    land.graph.accumulate(area_m2);
    omp_set_num_threads(before);
    return std::pair{land.graph.order, area_m2};
  };
  EXPECT_EQ(drained(1), drained(4));
}

TEST(Water, EveryCellReachesAnOutletWithoutClimbingTheFilledSurface) {
  on_many_terrains([](const Grid& grid, const auto& z, const auto& outlets) {
    const auto filled = flood(grid, z, outlets);
    const FlowGraph graph = route_water(grid, z, outlets).graph;
    std::vector<int> position(z.size());
    for (std::size_t at = 0; at < graph.order.size(); ++at) position[graph.order[at]] = at;
    for (Index cell = 0; cell < grid.size(); ++cell) {
      const Index to = graph.receiver[cell];
      if (to == cell) {
        ASSERT_NE(outlets[cell], 0) << "cell " << cell << " ends away from an outlet";
        continue;
      }
      ASSERT_LE(filled[to], filled[cell]);
      ASSERT_LT(position[cell], position[to]);
      bool neighbours = false;
      for (int k = 0; k < kDirections; ++k) neighbours |= grid.neighbour(cell, k) == to;
      ASSERT_TRUE(neighbours);
    }
  });
}

TEST(Water, SteepestReceiverIsTheSteepestByTrueDistance) {
  on_many_terrains([](const Grid& grid, const auto& z, const auto& outlets) {
    std::vector<Index> receiver(z.size());
    steepest_receivers(grid, z, outlets, receiver);
    for (Index cell = 0; cell < grid.size(); ++cell) {
      if (outlets[cell] != 0) {
        ASSERT_EQ(receiver[cell], cell);
        continue;
      }
      double steepest = 0.0, taken = 0.0;
      for (int k = 0; k < kDirections; ++k) {
        const Index to = grid.neighbour(cell, k);
        if (to == kNoCell) continue;
        const double slope =
            (static_cast<double>(z[cell]) - z[to]) / grid.distances_m(grid.row(cell))[k];
        steepest = std::max(steepest, slope);
        if (to == receiver[cell]) taken = std::max(taken, slope);
      }
      ASSERT_NEAR(taken, steepest, 1e-6 * steepest);
    }
  });
}

TEST(Water, AreaIsConserved) {
  on_many_terrains([](const Grid& grid, const auto& z, const auto& outlets) {
    const FlowGraph graph = route_water(grid, z, outlets).graph;
    std::vector<double> area(z.size());
    for (Index cell = 0; cell < grid.size(); ++cell) area[cell] = grid.area_m2(grid.row(cell));
    graph.accumulate(area);
    double total = 0.0;
    for (Index cell = 0; cell < grid.size(); ++cell) {
      if (graph.receiver[cell] == cell) total += area[cell];
    }
    ASSERT_NEAR(total / grid.total_area_m2(), 1.0, 1e-12);
  });
}

TEST(Water, DepressionsHoldWhatTheFilledSurfaceHolds) {
  on_many_terrains([](const Grid& grid, const auto& z, const auto& outlets) {
    std::vector<Index> receiver(z.size());
    steepest_receivers(grid, z, outlets, receiver);
    const auto hierarchy = build_depression_hierarchy(grid, z, outlets, receiver);
    const auto filled = flood(grid, z, outlets);
    double expected = 0.0, flooded = 0.0;
    for (Index cell = 0; cell < grid.size(); ++cell) {
      const double area = grid.area_m2(grid.row(cell));
      expected += area * (static_cast<double>(filled[cell]) - z[cell]);
      if (filled[cell] > z[cell]) flooded += area;
    }
    // Topmost depressions that spill seaward under a higher level downstream hold more than their
    // own sill: the rest of the water stands in what they spill into. Compare from below.
    double held = 0.0;
    for (const Depression& node : hierarchy.depressions) {
      if (node.parent == kSea) held += node.volume_m3;
      ASSERT_GE(node.volume_m3, -1e-6 * expected);
      if (node.parent != kSea) {
        ASSERT_GE(hierarchy.depressions[node.parent].volume_m3, node.volume_m3 * (1 - 1e-12));
        ASSERT_LE(node.sill_m, hierarchy.depressions[node.parent].sill_m);
      }
    }
    ASSERT_NEAR(held, expected, 1e-9 * expected + 1e-3);
    (void)flooded;
  });
}

/// Cells row by row from the north, as a person writes them; surrounded by nothing.
struct Drawn {
  Grid grid;
  std::vector<float> z;
  Drawn(int nx, int ny, const std::vector<float>& rows_from_north)
      : grid(Grid::plane(nx, ny, 1.0, 1.0)), z(rows_from_north.size()) {
    for (int row = 0; row < ny; ++row) {
      std::copy_n(rows_from_north.begin() + row * nx, nx, z.begin() + (ny - 1 - row) * nx);
    }
  }
  [[nodiscard]] Index at(int row_from_north, int column) const {
    return grid.cell(column, grid.ny() - 1 - row_from_north);
  }
};

TEST(Water, SevenBySevenBasinsFillAndSpillAsDrawn) {
  const Drawn drawn(7, 7,
                    {9, 9, 9, 9, 9, 9, 9, 9, 4, 4, 7, 5, 6, 9, 9, 4, 2, 6, 3, 5, 9, 9, 5, 4, 8,
                     5, 5, 5, 9, 6, 5, 8, 4, 1, 3, 9, 7, 6, 9, 6, 5, 0, 9, 9, 9, 9, 9, 9, 9});
  const auto outlets = find_outlets(drawn.grid, drawn.z, -1.0F);
  std::vector<Index> receiver(drawn.z.size());
  steepest_receivers(drawn.grid, drawn.z, outlets, receiver);
  const auto hierarchy = build_depression_hierarchy(drawn.grid, drawn.z, outlets, receiver);
  ASSERT_EQ(hierarchy.leaves, 2);
  for (const Depression& node : hierarchy.depressions) {
    if (node.pit == drawn.at(2, 2)) {
      EXPECT_EQ(node.sill_m, 6.0F);
      EXPECT_EQ(node.volume_m3, 14.0);
      EXPECT_NE(node.spills_into, kSea) << "the left basin overflows into the right one";
    } else {
      EXPECT_EQ(node.pit, drawn.at(2, 4));
      EXPECT_EQ(node.sill_m, 5.0F);
      EXPECT_EQ(node.volume_m3, 2.0);
      EXPECT_EQ(node.spills_into, kSea);
    }
    EXPECT_EQ(node.parent, kSea);
  }
}

TEST(Water, HierarchyOfTwoPondsInOneBasin) {
  // A channel between walls: sea 0, sill 5, ponds 1 and 2 parted by 3, far wall.
  const std::vector<float> wall(6, 99.0F);
  std::vector<float> rows(wall);
  for (const float height : {0.0F, 5.0F, 1.0F, 3.0F, 2.0F, 99.0F}) rows.push_back(height);
  rows.insert(rows.end(), wall.begin(), wall.end());
  Drawn drawn(6, 3, rows);
  std::vector<std::uint8_t> outlets(drawn.z.size(), 0);
  outlets[drawn.at(1, 0)] = 1;
  std::vector<Index> receiver(drawn.z.size());
  steepest_receivers(drawn.grid, drawn.z, outlets, receiver);
  const auto hierarchy = build_depression_hierarchy(drawn.grid, drawn.z, outlets, receiver);
  ASSERT_EQ(hierarchy.leaves, 2);
  ASSERT_EQ(hierarchy.depressions.size(), 3U);
  const auto& nodes = hierarchy.depressions;
  const int a = nodes[0].pit == drawn.at(1, 2) ? 0 : 1, b = 1 - a;
  EXPECT_EQ(nodes[a].sill_m, 3.0F);
  EXPECT_EQ(nodes[a].volume_m3, 2.0);
  EXPECT_EQ(nodes[b].sill_m, 3.0F);
  EXPECT_EQ(nodes[b].volume_m3, 1.0);
  EXPECT_EQ(nodes[2].sill_m, 5.0F);
  EXPECT_EQ(nodes[2].volume_m3, 9.0);
  EXPECT_EQ(nodes[a].parent, 2);
  EXPECT_EQ(nodes[2].parent, kSea);
  EXPECT_EQ(nodes[2].spills_into, kSea);
}

TEST(Water, FlatsDrainToTheirLowerEdge) {
  Drawn drawn(7, 5, {9, 9, 9, 9, 9, 9, 9, 9, 5, 5, 5, 5, 5, 9, 9, 5, 5, 5,
                     5, 5, 1, 9, 5, 5, 5, 5, 5, 9, 9, 9, 9, 9, 9, 9, 9});
  const auto outlets = find_outlets(drawn.grid, drawn.z, 0.0F);
  std::vector<Index> receiver(drawn.z.size());
  steepest_receivers(drawn.grid, drawn.z, outlets, receiver);
  EXPECT_EQ(build_depression_hierarchy(drawn.grid, drawn.z, outlets, receiver).leaves, 0);
  EXPECT_EQ(receiver[drawn.at(2, 5)], drawn.at(2, 6));
}

TEST(Water, BasinsAreNumberedByFallingArea) {
  const Grid grid = Grid::sphere(60, 30);
  const auto z = test::random_terrain(grid, 3);
  const auto sea = find_outlets(grid, z);
  const FlowGraph graph = route_water(grid, z, sea).graph;
  const auto basin = number_basins(grid, graph, sea);
  std::vector<double> area(*std::max_element(basin.begin(), basin.end()) + 1, 0.0);
  for (Index cell = 0; cell < grid.size(); ++cell) {
    area[basin[cell]] += grid.area_m2(grid.row(cell));
    EXPECT_EQ(basin[cell] == 0, sea[cell] != 0);
    const Index to = graph.receiver[cell];
    if (sea[to] == 0) {
      EXPECT_EQ(basin[cell], basin[to]);
    }
  }
  for (std::size_t b = 2; b < area.size(); ++b) EXPECT_GE(area[b - 1], area[b]);
}

TEST(Water, StrahlerOrderRisesWhereEqualsMeet) {
  // Two heads of order 1 meet (2), a third head joins (still 2), another 2 joins (3).
  FlowGraph graph;
  graph.receiver = {2, 2, 4, 4, 9, 7, 7, 8, 9, 9};
  graph.order = downstream_order(graph.receiver);
  const std::vector<std::uint8_t> channel(10, 1);
  std::vector<std::int8_t> order(10);
  strahler_order(graph, channel, order);
  EXPECT_EQ(order, (std::vector<std::int8_t>{1, 1, 2, 1, 2, 1, 1, 2, 2, 3}));
}

}  // namespace
}  // namespace geo
