#include "kernels/numerics/monotone_queue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "geo/core/random.hpp"

namespace geo {
namespace {

TEST(MonotoneQueue, GivesTheOrderOfAnyPriorityQueue) {
  using Entry = std::pair<float, Index>;
  const RandomStream random(1, "test.queue");
  MonotoneQueue queue;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> expected;
  const auto push = [&](float height, Index cell) {
    queue.push(height, cell);
    expected.emplace(height, cell);
  };
  push(-0.0F, 7);
  push(0.0F, 3);
  std::uint64_t draw = 0;
  for (int k = 0; k < 20000; ++k) {
    ASSERT_EQ(queue.empty(), expected.empty());
    if (expected.empty()) break;
    const Entry lowest = expected.top();
    expected.pop();
    ASSERT_EQ(queue.pop(), lowest);
    // Some at the same height, of smaller numbers too.
    for (int n = static_cast<int>(random.uniform(draw++, 0, 0.0, 2.6)); n > 0; --n) {
      const double rise_m = std::max(0.0, random.uniform(draw++, 0, -20.0, 50.0));
      push(lowest.first + static_cast<float>(rise_m),
           static_cast<Index>(random.uniform(draw++, 0, 0.0, 1e6)));
    }
    if (expected.size() < 10) push(lowest.first + 1.0F, k);
  }
}

TEST(MonotoneQueue, BeginsAnewOnceItIsEmpty) {
  MonotoneQueue queue;
  queue.push(1000.0F, 1);
  EXPECT_EQ(queue.pop(), std::pair(1000.0F, 1));
  queue.push(3.0F, 2);
  queue.push(2.0F, 3);
  EXPECT_EQ(queue.pop(), std::pair(2.0F, 3));
  EXPECT_EQ(queue.pop(), std::pair(3.0F, 2));
  EXPECT_TRUE(queue.empty());
}

}  // namespace
}  // namespace geo
