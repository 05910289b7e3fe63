// With TERRANE_CARRIED_ALLOCATIONS set, in every test program: memory that is asked for within a
// parallel region is asked for where its want can be told. An exception that leaves such a region
// ends the program, so that each allocation there should stand in a guard of ParallelErrors; the
// program itself ends in one line also where one does not.
#include <execinfo.h>
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <new>
#include <sstream>

#include "geo/core/parallel_errors.hpp"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {

/// Where memory was asked for, innermost call first.
struct Site {
  std::array<void*, 12> calls{};
  int depth = 0;
};
std::array<Site, 16> sites;
std::atomic<int> asked{0};
thread_local bool is_noting = false;

void note() {
  if (omp_get_level() == 0 || geo::ParallelErrors::is_carried() || is_noting) return;
  is_noting = true;
  const int number = asked++;
  if (number < static_cast<int>(sites.size())) {
    Site& site = sites[number];
    site.depth = ::backtrace(site.calls.data(), static_cast<int>(site.calls.size()));
  }
  is_noting = false;
}

class CarriedAllocations : public testing::Environment {
 public:
  void TearDown() override {
    const int count = asked;
    if (count == 0 || std::getenv("TERRANE_CARRIED_ALLOCATIONS") == nullptr) return;
    std::ostringstream text;
    for (int k = 0; k < std::min<int>(count, sites.size()); ++k) {
      for (int call = 2; call < sites[k].depth; ++call) text << ' ' << sites[k].calls[call];
      text << '\n';
    }
    ADD_FAILURE() << count << " allocations in parallel regions stand in no guard of "
                  << "ParallelErrors; addr2line -Cfe tells where:\n"
                  << text.str();
  }
};

[[maybe_unused]] const auto* const kCarried =
    testing::AddGlobalTestEnvironment(new CarriedAllocations);

}  // namespace

void* operator new(std::size_t size) {
  note();
  if (void* block = std::malloc(size == 0 ? 1 : size)) return block;
  throw std::bad_alloc();
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }

#endif
