#include "block_regions.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <optional>

namespace terrane {
namespace {

using Trace = PageRanges::Trace;

std::atomic<bool> is_full{false};

/// Takes one free part of a kind, works on it without keeping others waiting, and puts it back.
template <class Work>
bool with_one_free(Region& region, Trace trace, Work&& work) {
  std::optional<PageRanges::Range> range;
  {
    const std::lock_guard lock(regions().mutex);
    range = region.ranges.pull(trace);
  }
  if (!range) return false;
  const Trace left = work(*range);
  const std::lock_guard lock(regions().mutex);
  region.ranges.put(*range, left);
  return true;
}

}  // namespace

Regions& regions() {
  static Regions* const kRegions = new Regions;
  return *kRegions;
}

void take_memory(std::byte* bytes, std::size_t size) noexcept {
  if (size >= kLargePage) ::madvise(bytes, size, MADV_HUGEPAGE);
#ifdef MADV_POPULATE_WRITE
  if (::madvise(bytes, size, MADV_POPULATE_WRITE) == 0) return;
#endif
  constexpr std::size_t kLeastPage = 4096;
  for (std::size_t k = 0; k < size; k += kLeastPage) {
    static_cast<volatile std::byte*>(bytes)[k] = std::byte{0};
  }
}

bool drop_one_free_of_memory() {
  Region& memory = regions().memory;
  return with_one_free(memory, Trace::memory, [&](PageRanges::Range range) {
    ::madvise(memory.at(range.first), range.pages * memory.page, MADV_DONTNEED);
    return Trace::none;
  });
}

bool drop_one_free_of_scratch() {
  return with_one_free(regions().scratch, Trace::memory,
                       [](PageRanges::Range range) { return regions().store->drop(range); });
}

bool forget_one_free(Trace trace) {
  return with_one_free(regions().scratch, trace, [](PageRanges::Range range) {
    regions().store->forget(range);
    return Trace::none;
  });
}

bool scratch_was_full() noexcept { return is_full; }

void* block_in_memory(std::size_t size) {
  Regions& all = regions();
  const std::lock_guard lock(all.mutex);
  const std::size_t pages = all.memory.pages_of(size);
  if (all.memory.ranges.pages_in_use() + pages > all.memory_limit_pages) return nullptr;
  const auto range = all.memory.ranges.take(pages);
  return range ? all.memory.at(range->first) : nullptr;
}

void* block_in_scratch(std::size_t size) {
  Regions& all = regions();
  std::optional<PageRanges::Range> range;
  {
    const std::lock_guard lock(all.mutex);
    range = all.scratch.ranges.take(all.scratch.pages_of(size));
    all.scratch.most_pages = std::max(all.scratch.most_pages, all.scratch.ranges.pages_in_use());
  }
  if (!range) return nullptr;
  while (!all.store->reserve(*range)) {
    if (forget_one_free(Trace::disk) || forget_one_free(Trace::memory)) continue;
    is_full = true;
    const std::lock_guard lock(all.mutex);
    all.scratch.ranges.give(range->first);
    return nullptr;
  }
  return all.scratch.at(range->first);
}

}  // namespace terrane
