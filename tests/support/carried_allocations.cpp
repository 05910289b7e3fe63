// In every test program: memory that is asked for within a parallel region is asked for where its
// want can be told. An exception that leaves such a region ends the program, so that each
// allocation there stands in a guard of ParallelErrors.
#include <dlfcn.h>
#include <execinfo.h>
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <new>
#include <sstream>
#include <string_view>

#include "geo/core/parallel_errors.hpp"

#ifndef TERRANE_SANITIZED  // sanitizers bring a heap of their own

namespace {

/// Where memory was asked for, innermost call first.
struct Site {
  std::array<void*, 12> calls{};
  int depth = 0;
  bool operator==(const Site&) const = default;
};
/// Each site once, as far as there is room; written under the lock, which is never held for long.
std::array<Site, 64> sites;
int n_sites = 0;
std::atomic<long> asked{0};
std::atomic_flag is_locked = ATOMIC_FLAG_INIT;
thread_local bool is_noting = false;

void note() {
  if (omp_get_level() == 0 || geo::ParallelErrors::is_carried() || is_noting) return;
  is_noting = true;
  ++asked;
  Site site;
  site.depth = ::backtrace(site.calls.data(), static_cast<int>(site.calls.size()));
  while (is_locked.test_and_set(std::memory_order_acquire)) {
  }
  const auto end = sites.begin() + n_sites;
  if (end != sites.end() && std::find(sites.begin(), end, site) == end) sites[n_sites++] = site;
  is_locked.clear(std::memory_order_release);
  is_noting = false;
}

/// Where a program's own code lies, for addr2line.
void print_call(std::ostream& text, void* call) {
  Dl_info found{};
  if (::dladdr(call, &found) == 0) return;
  const std::string_view name = found.dli_fname;
  text << "  " << name.substr(name.rfind('/') + 1) << " 0x" << std::hex
       << static_cast<char*>(call) - static_cast<char*>(found.dli_fbase) - 1 << std::dec;
  if (found.dli_sname != nullptr) text << ' ' << found.dli_sname;
  text << '\n';
}

class CarriedAllocations : public testing::Environment {
 public:
  void TearDown() override {
    if (asked == 0) return;
    std::ostringstream text;
    for (int k = 0; k < n_sites; ++k) {
      text << "site " << k + 1 << '\n';
      for (int call = 2; call < sites[k].depth; ++call) print_call(text, sites[k].calls[call]);
    }
    ADD_FAILURE() << asked << " allocations in parallel regions stand in no guard of "
                  << "ParallelErrors; addr2line -Cfe PROGRAM ADDRESS tells where:\n"
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
void* operator new(std::size_t size, std::align_val_t alignment) {
  note();
  const auto step = static_cast<std::size_t>(alignment);
  if (void* block = std::aligned_alloc(step, (size + step - 1) / step * step)) return block;
  throw std::bad_alloc();
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
void operator delete(void* block, std::align_val_t) noexcept { std::free(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { std::free(block); }

#endif
