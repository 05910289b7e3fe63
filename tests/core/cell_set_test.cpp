#include "geo/core/cell_set.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "geo/core/random.hpp"

namespace geo {
namespace {

/// About a third of the cells, with stretches of all and of none among them.
CellSet some_of(Index cells, std::uint64_t seed, std::vector<Index>& held) {
  const RandomStream random(seed, "cells");
  held.clear();
  const auto holds = [&](Index c) {
    if (c / 200 % 3 == 1) return false;
    return c / 200 % 3 == 2 || random.uniform(c) < 0.3;
  };
  for (Index c = 0; c < cells; ++c) {
    if (holds(c)) held.push_back(c);
  }
  return CellSet(cells, holds);
}

TEST(CellSet, PlacesAreThoseInAscendingOrder) {
  for (const Index cells : {1, 63, 64, 65, 1000, 4096, 200000}) {
    std::vector<Index> held;
    const CellSet set = some_of(cells, 7, held);
    ASSERT_EQ(set.size(), held.size()) << cells;
    for (std::size_t n = 0; n < held.size(); ++n) {
      ASSERT_TRUE(set.holds(held[n]));
      ASSERT_EQ(set.place(held[n]), n);
    }
    std::vector<Index> visited;
    set.visit([&](Index c) { visited.push_back(c); });
    EXPECT_EQ(visited, held);
  }
}

TEST(SparseValues, AreTheOneElsewhereBeyondTheirSet) {
  std::vector<Index> held;
  const auto set = std::make_shared<const CellSet>(some_of(1000, 3, held));
  SparseValues<float> values(set, -1.0F);
  for (const Index c : held) values.of(c) = static_cast<float>(c);
  const std::vector<float> all = values.on_cells();
  ASSERT_EQ(all.size(), 1000U);
  for (Index c = 0; c < 1000; ++c) {
    EXPECT_EQ(values[c], set->holds(c) ? static_cast<float>(c) : -1.0F);
    EXPECT_EQ(all[c], values[c]);
  }
}

}  // namespace
}  // namespace geo
