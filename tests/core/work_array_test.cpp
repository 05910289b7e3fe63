#include "geo/core/work_array.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <span>
#include <vector>

namespace geo {
namespace {

TEST(WorkArray, HoldsTheValueThatItIsMadeWithUntilItIsFilledWithAnother) {
  WorkArray<double> array(1000, 2.5);
  EXPECT_EQ(std::accumulate(array.begin(), array.end(), 0.0), 2500.0);
  array[999] = 7.0;
  array.fill(1.0);
  EXPECT_EQ(std::accumulate(array.begin(), array.end(), 0.0), 1000.0);
  EXPECT_EQ(std::span<const double>(array).size(), 1000U);
}

TEST(WorkArray, CopiesARangeAndRoundsItToItsOwnType) {
  std::vector<double> values(100000);
  std::iota(values.begin(), values.end(), 0.25);
  const auto copy = WorkArray<int>::copy_of(values);
  ASSERT_EQ(copy.size(), values.size());
  for (std::size_t n = 0; n < copy.size(); ++n) ASSERT_EQ(copy[n], static_cast<int>(n));
}

TEST(WorkArray, IsEmptyWhereNothingIsAskedForAndAfterItIsMovedFrom) {
  WorkArray<float> array(10);
  const WorkArray<float> other = std::move(array);
  EXPECT_EQ(other.size(), 10U);
  EXPECT_TRUE(array.empty());
  array = {};
  EXPECT_EQ(array.begin(), array.end());
}

}  // namespace
}  // namespace geo
