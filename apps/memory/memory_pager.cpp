#include "memory_pager.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "block_regions.hpp"

namespace terrane {

using Trace = PageRanges::Trace;

double least_clear_bytes(double cap_bytes) {
  return std::clamp(cap_bytes / 4.0, 48.0 * kMebibyte, 1024.0 * kMebibyte);
}

MemoryPager::MemoryPager(std::size_t cap_bytes) : cap_(cap_bytes) {
  keep_clear(least_clear());
  most_on_disk_pages_ = regions().scratch.pages_of(cap_bytes / 4);
  statm_ = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  own_at_first_ = resident().own;
  watching_.emplace(std::chrono::milliseconds(1), [this] { look(); });
  cutting_.emplace(std::chrono::milliseconds(100), [this] { cut(); });
}

MemoryPager::~MemoryPager() {
  watching_.reset();
  cutting_.reset();
  if (statm_ >= 0) ::close(statm_);
}

void MemoryPager::look() {
  const std::unique_lock lock(dropping_, std::try_to_lock);
  if (!lock) return;
  const std::size_t taken = taken_bytes();
  if (taken > high_) {
    drop_until_low(taken);
  } else {
    forget();
  }
  regions().store->allow(cap_ - std::min(cap_, taken_bytes()));
}

void MemoryPager::drop_until_low(std::size_t taken) {
  // On a busy machine this thread comes late: the later it came, the more is kept clear.
  const std::size_t late = std::min(2 * (taken - std::min(taken, high_.load())), cap_ / 5 * 2);
  if (late > cap_ - high_ && !regions().store->asks_for_room()) keep_clear(late);
  while (taken_bytes() > low_) {
    if (drop_one_free_of_scratch() || drop_one_free_of_memory()) continue;
    if (!drop_round()) break;
    // Whoever waits for room need not wait for all of it.
    regions().store->allow(cap_ - std::min(cap_, taken_bytes()));
  }
}

MemoryPager::Resident MemoryPager::resident() const {
  static const auto kSystemPage = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  std::array<char, 128> text{};
  if (::pread(statm_, text.data(), text.size() - 1, 0) <= 0) return {};
  char* at = nullptr;
  std::strtoull(text.data(), &at, 10);  // address space
  const std::size_t all = std::strtoull(at, &at, 10), of_files = std::strtoull(at, &at, 10);
  return {(all - std::min(all, of_files)) * kSystemPage, of_files * kSystemPage};
}

std::size_t MemoryPager::taken_bytes() const {
  const Resident now = resident();
  Regions& all = regions();
  const std::lock_guard lock(all.mutex);
  const std::size_t promised = all.memory.ranges.pages_in_use() * all.memory.page;
  return now.of_files + std::max(now.own, own_at_first_ + promised);
}

std::size_t MemoryPager::least_clear() const { return regions().store->least_clear_bytes(cap_); }

void MemoryPager::forget() {
  constexpr std::size_t kLooks = 1000;
  const std::size_t clear = cap_ - high_;
  if (clear > least_clear()) keep_clear(clear - (clear - least_clear() + kLooks - 1) / kLooks);
}

void MemoryPager::keep_clear(std::size_t margin) {
  high_ = cap_ - margin;
  low_ = cap_ - margin - margin / 4;
}

bool MemoryPager::drop_round() {
  Regions& all = regions();
  const std::size_t step = all.scratch.pages_of(4 * kMebibyte);
  std::size_t reach = 0;
  {
    const std::lock_guard lock(all.mutex);
    reach = all.scratch.ranges.reach();
  }
  for (std::size_t gone = 0; gone < reach; gone += step) {
    if (hand_ >= reach) hand_ = 0;
    const std::size_t pages = std::min(step, reach - hand_);
    all.store->send_away({hand_, pages});
    hand_ += pages;
    if (taken_bytes() <= low_) return true;
  }
  const auto now = std::chrono::steady_clock::now();
  if (now - trimmed_ > std::chrono::milliseconds(200)) {
    trimmed_ = now;
    malloc_trim(0);
  }
  return false;
}

void MemoryPager::cut() const {
  Regions& all = regions();
  const auto is_much = [&] {
    const std::lock_guard lock(all.mutex);
    return all.scratch.ranges.free_pages(Trace::disk) > most_on_disk_pages_;
  };
  while (is_much() && forget_one_free(Trace::disk)) {
  }
}

}  // namespace terrane
