#include "geo/core/parallel_errors.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <atomic>
#include <new>
#include <stdexcept>
#include <vector>

namespace geo {
namespace {

TEST(ParallelErrors, CarryAnExceptionOutOfARegionAndDoNothingMoreAfterIt) {
  ParallelErrors errors;
  std::atomic<int> done{0};
#pragma omp parallel for schedule(dynamic, 1) num_threads(4)
  for (int i = 0; i < 100000; ++i) {
    errors.guard([&] {
      if (i >= 100) throw std::runtime_error("from within");
      ++done;
    });
  }
  EXPECT_TRUE(errors.any());
  EXPECT_LE(done, 100);
  EXPECT_THROW(errors.rethrow(), std::runtime_error);
}

TEST(ParallelErrors, AreSilentWhereNothingWasThrown) {
  ParallelErrors errors;
  int done = 0;
#pragma omp parallel for reduction(+ : done) num_threads(4)
  for (int i = 0; i < 1000; ++i) errors.guard([&] { ++done; });
  EXPECT_EQ(done, 1000);
  EXPECT_FALSE(errors.any());
  EXPECT_NO_THROW(errors.rethrow());
}

/// Never has any memory left. With the address sanitizer the real one ends the program instead.
struct NoMemory : std::allocator<char> {
  template <class T>
  struct rebind {
    using other = NoMemory;
  };
  char* allocate(std::size_t) { throw std::bad_alloc(); }
};

TEST(ParallelErrors, GiveEachThreadScratchOrTellThatThereIsNone) {
  constexpr std::size_t kWanted = 64;
  ParallelErrors errors;
#pragma omp parallel num_threads(4)
  {
    const auto line = errors.make<std::vector<char, NoMemory>>(kWanted);
    errors.guard([&] { EXPECT_EQ(line.size(), kWanted); });
  }
  EXPECT_THROW(errors.rethrow(), std::bad_alloc);

  ParallelErrors none;
#pragma omp parallel num_threads(4)
  {
    const auto line = none.make<std::vector<int>>(7, 3);
    none.guard([&] {
      if (line != std::vector<int>(7, 3)) throw std::logic_error("another line");
    });
  }
  EXPECT_NO_THROW(none.rethrow());
}

TEST(ParallelErrors, KnowWhatIsCarriedInNestedRegions) {
  EXPECT_TRUE(ParallelErrors::is_carried());
  std::atomic<int> wrong{0};
  ParallelErrors errors;
#pragma omp parallel num_threads(2)
  {
    if (ParallelErrors::is_carried()) ++wrong;
    errors.guard([&] {
      if (!ParallelErrors::is_carried()) ++wrong;
#pragma omp parallel num_threads(1)
      if (ParallelErrors::is_carried()) ++wrong;
    });
    if (ParallelErrors::is_carried()) ++wrong;
  }
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace geo
