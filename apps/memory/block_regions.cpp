#include "block_regions.hpp"

#include <fcntl.h>
#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <optional>

namespace terrane {
namespace {

using Trace = PageRanges::Trace;

std::atomic<bool> is_full{false};

bool reserve_room(const Region& region, const PageRanges::Range& range, int file) {
  int refused = EINTR;
  while (refused == EINTR) {
    refused = ::posix_fallocate(file, region.at(range.first) - region.base,
                                static_cast<off_t>(range.pages * kPage));
  }
  return refused == 0;
}

}  // namespace

Regions& regions() {
  static Regions* const kRegions = new Regions;
  return *kRegions;
}

bool drop_one_free(Region& region, Trace left) {
  std::optional<PageRanges::Range> range;
  {
    const std::lock_guard lock(regions().mutex);
    range = region.ranges.pull(Trace::memory);
  }
  if (!range) return false;
  ::madvise(region.at(range->first), range->pages * kPage, MADV_DONTNEED);
  const std::lock_guard lock(regions().mutex);
  region.ranges.put(*range, left);
  return true;
}

bool cut_one_free(Trace trace) {
  Regions& all = regions();
  std::optional<PageRanges::Range> range;
  {
    const std::lock_guard lock(all.mutex);
    range = all.scratch.ranges.pull(trace);
  }
  if (!range) return false;
  // Where files cannot have holes, it stays.
  ::fallocate(all.file, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE,
              static_cast<off_t>(range->first * kPage), static_cast<off_t>(range->pages * kPage));
  const std::lock_guard lock(all.mutex);
  all.scratch.ranges.put(*range, Trace::none);
  return true;
}

bool scratch_was_full() noexcept { return is_full; }

void* block_in_memory(std::size_t size) {
  Regions& all = regions();
  const std::lock_guard lock(all.mutex);
  const std::size_t pages = pages_of(size);
  if (all.memory.ranges.pages_in_use() + pages > all.memory_limit_pages) return nullptr;
  const auto range = all.memory.ranges.take(pages);
  return range ? all.memory.at(range->first) : nullptr;
}

void* block_in_scratch(std::size_t size) {
  Regions& all = regions();
  std::optional<PageRanges::Range> range;
  {
    const std::lock_guard lock(all.mutex);
    range = all.scratch.ranges.take(pages_of(size));
    all.scratch.most_pages = std::max(all.scratch.most_pages, all.scratch.ranges.pages_in_use());
  }
  if (!range) return nullptr;
  while (!reserve_room(all.scratch, *range, all.file)) {
    if (cut_one_free(Trace::disk) || cut_one_free(Trace::memory)) continue;
    is_full = true;
    const std::lock_guard lock(all.mutex);
    all.scratch.ranges.give(range->first);
    return nullptr;
  }
  return all.scratch.at(range->first);
}

}  // namespace terrane
