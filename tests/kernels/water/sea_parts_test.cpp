#include "geo/kernels/water/sea_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/random.hpp"

namespace geo {
namespace {

TEST(PartsOfSea, AreJoinedOverTheSeamThePolesAndCorners) {
  const Grid grid = Grid::sphere(16, 8);
  std::vector<float> z(grid.size(), 100.0F);
  z[grid.cell(0, 3)] = -10.0F;  // one over the seam
  z[grid.cell(15, 3)] = -20.0F;
  z[grid.cell(2, 7)] = -30.0F;  // one over the pole
  z[grid.cell(10, 7)] = -5000.0F;
  z[grid.cell(6, 4)] = -1.0F;  // one corner to corner
  z[grid.cell(7, 5)] = -2.0F;
  z[grid.cell(8, 6)] = -3.0F;
  const auto parts = parts_of_sea(grid, z);
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts[0].deepest_m, -3.0);
  EXPECT_EQ(parts[1].deepest_m, -20.0);
  EXPECT_EQ(parts[2].deepest_m, -5000.0);
  EXPECT_NEAR(parts[1].area_m2, 2.0 * grid.area_m2(3), 1.0);
  EXPECT_EQ(count_landlocked(parts, 3000.0, 1e20), 1);
  EXPECT_EQ(count_landlocked(parts, 3000.0, 1.9 * grid.area_m2(3)), 2);
  EXPECT_EQ(count_landlocked({}, 3000.0, 1.0), 0);
}

/// By filling from cell to cell.
std::vector<std::int32_t> filled_parts(const Grid& grid, const std::vector<float>& z) {
  std::vector<std::int32_t> part(z.size(), -1);
  std::int32_t parts = 0;
  for (Index start = 0; start < grid.size(); ++start) {
    if (part[start] >= 0 || !(z[start] < 0.0F)) continue;
    std::vector<Index> front{start};
    part[start] = parts;
    while (!front.empty()) {
      const Index cell = front.back();
      front.pop_back();
      for (int k = 0; k < kDirections; ++k) {
        const Index beside = grid.neighbour(cell, k);
        if (beside == kNoCell || part[beside] >= 0 || !(z[beside] < 0.0F)) continue;
        part[beside] = parts;
        front.push_back(beside);
      }
    }
    ++parts;
  }
  return part;
}

TEST(PartsOfSea, AreThoseOfAFloodOnEveryTopology) {
  for (const Grid& grid : {Grid::sphere(34, 18), Grid::torus(21, 13, 1e4, 1e4),
                           Grid::plane(19, 23, 1e4, 1e4), Grid::sphere(4, 3)}) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      const RandomStream random(seed, "sea");
      std::vector<float> z(grid.size());
      for (Index c = 0; c < grid.size(); ++c) {
        z[c] = random.uniform(c) < 0.15 + 0.01 * static_cast<double>(seed) ? -1.0F : 1.0F;
      }
      const std::vector<std::int32_t> flood = filled_parts(grid, z);
      const NumberedSeas seas = number_seas(grid, z);
      const auto count =
          static_cast<std::size_t>(*std::max_element(flood.begin(), flood.end()) + 1);
      ASSERT_EQ(seas.parts.size(), count);
      double sea_m2 = 0.0;
      for (Index c = 0; c < grid.size(); ++c) {
        ASSERT_EQ(seas.part_of_cell[c] < 0, flood[c] < 0);
        if (flood[c] < 0) continue;
        sea_m2 += grid.area_m2(grid.row(c));
        ASSERT_EQ(flood[seas.parts[seas.part_of_cell[c]].first], flood[c]);
      }
      for (const SeaPart& part : seas.parts) sea_m2 -= part.area_m2;
      EXPECT_NEAR(sea_m2, 0.0, 1e-9 * grid.total_area_m2());
      EXPECT_TRUE(
          std::is_sorted(seas.parts.begin(), seas.parts.end(),
                         [](const SeaPart& a, const SeaPart& b) { return a.area_m2 > b.area_m2; }));
    }
  }
  EXPECT_THROW(parts_of_sea(Grid::sphere(8, 4), std::vector<float>(3)), InputError);
}

}  // namespace
}  // namespace geo
