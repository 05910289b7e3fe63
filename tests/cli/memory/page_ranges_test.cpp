// Which pages of a region are in use, and which of the free ones are taken first.
#include "memory/page_ranges.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace terrane {
namespace {

using Trace = PageRanges::Trace;

TEST(PageRanges, NeverOverlapAndAreAllFoundAgain) {
  constexpr std::size_t kPages = 1000;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    PageRanges ranges(kPages);
    std::map<std::size_t, std::size_t> used;
    std::size_t in_use = 0;
    for (int step = 0; step < 2000; ++step) {
      const auto draw = random();
      if (draw % 3 == 0 && !used.empty()) {
        auto at = used.begin();
        std::advance(at, random() % used.size());
        ranges.give(at->first);
        in_use -= at->second;
        used.erase(at);
      } else if (draw % 7 == 0) {
        if (const auto range = ranges.pull(Trace::memory)) ranges.put(*range, Trace::disk);
      } else if (draw % 11 == 0) {
        if (const auto range = ranges.pull(Trace::disk)) ranges.put(*range, Trace::none);
      } else if (const auto range = ranges.take(1 + random() % 40)) {
        ASSERT_LE(range->first + range->pages, kPages);
        const auto next = used.lower_bound(range->first);
        if (next != used.end()) {
          ASSERT_LE(range->first + range->pages, next->first);
        }
        if (next != used.begin()) {
          const auto before = std::prev(next);
          ASSERT_LE(before->first + before->second, range->first);
        }
        used.emplace(range->first, range->pages);
        in_use += range->pages;
      }
      ASSERT_EQ(ranges.pages_in_use(), in_use);
      ASSERT_EQ(ranges.free_pages(Trace::memory) + ranges.free_pages(Trace::disk) +
                    ranges.free_pages(Trace::none) + in_use,
                ranges.reach());
    }
    for (const auto& [first, pages] : used) ranges.give(first);
    while (const auto range = ranges.pull(Trace::memory)) ranges.put(*range, Trace::none);
    while (const auto range = ranges.pull(Trace::disk)) ranges.put(*range, Trace::none);
    EXPECT_TRUE(ranges.take(ranges.reach())) << "neighbours are joined";
  }
}

TEST(PageRanges, InMemoryAreTakenBeforeThoseOnTheDisk) {
  PageRanges ranges(100);
  const auto first = ranges.take(10), between = ranges.take(1), second = ranges.take(10);
  ranges.give(first->first);
  const auto cold = ranges.pull(Trace::memory);
  ranges.put(*cold, Trace::disk);
  ranges.give(second->first);
  EXPECT_EQ(ranges.take(10)->first, second->first);
  EXPECT_EQ(ranges.take(10)->first, first->first);
  EXPECT_EQ(ranges.take(10)->first, between->first + 11) << "else behind all";
}

TEST(PageRanges, BeyondTheEndAreNone) {
  PageRanges ranges(8);
  EXPECT_FALSE(ranges.take(9));
  EXPECT_TRUE(ranges.take(8));
  EXPECT_FALSE(ranges.take(1));
  EXPECT_FALSE(ranges.pull(Trace::memory));
}

}  // namespace
}  // namespace terrane
