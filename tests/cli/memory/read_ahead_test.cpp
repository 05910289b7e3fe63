// Which pages are fetched before they are touched.
#include "memory/read_ahead.hpp"

#include <gtest/gtest.h>

namespace terrane {
namespace {

constexpr std::size_t kAll = 1000;

std::size_t end_of(const PageRanges::Range& range) { return range.first + range.pages; }

TEST(ReadAhead, BringsMoreAndMoreOfAWayUpwards) {
  ReadAhead ahead;
  std::size_t wanted = 100;
  for (const std::size_t pages : {1U, 2U, 4U, 8U, 16U, 16U}) {
    const auto range = ahead.around(wanted, kAll);
    EXPECT_EQ(range.first, wanted);
    EXPECT_EQ(range.pages, pages);
    wanted = end_of(range);
  }
}

TEST(ReadAhead, AndDownwards) {
  ReadAhead ahead;
  std::size_t wanted = 500;
  for (const std::size_t pages : {1U, 2U, 4U, 8U, 16U, 16U}) {
    const auto range = ahead.around(wanted, kAll);
    EXPECT_EQ(end_of(range), wanted + 1);
    EXPECT_EQ(range.pages, pages);
    wanted = range.first - 1;
  }
}

TEST(ReadAhead, KeepsSeveralWaysApart) {
  ReadAhead ahead;
  std::size_t low = 10, high = 700;
  for (const std::size_t pages : {1U, 2U, 4U}) {
    const auto below = ahead.around(low, kAll), above = ahead.around(high, kAll);
    EXPECT_EQ(below.pages, pages);
    EXPECT_EQ(above.pages, pages);
    low = end_of(below);
    high = end_of(above);
  }
}

TEST(ReadAhead, BringsNoMoreThanThereIs) {
  ReadAhead ahead;
  ahead.around(kAll - 2, kAll);
  EXPECT_EQ(end_of(ahead.around(kAll - 1, kAll)), kAll);
  ahead.around(1, kAll);
  const auto range = ahead.around(0, kAll);
  EXPECT_EQ(range.first, 0U);
  EXPECT_EQ(range.pages, 1U);
}

TEST(ReadAhead, BringsOnePageWhereNoneFollowsAnother) {
  ReadAhead ahead;
  for (const std::size_t page : {5U, 900U, 17U, 333U, 64U}) {
    const auto range = ahead.around(page, kAll);
    EXPECT_EQ(range.first, page);
    EXPECT_EQ(range.pages, 1U);
  }
}

}  // namespace
}  // namespace terrane
