#include "memory_pager.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <mutex>

#include "block_regions.hpp"

namespace terrane {
namespace {

using Trace = PageRanges::Trace;

constexpr std::size_t kPart_bytes = 4 * kMebibyte;

}  // namespace

MemoryPager::MemoryPager(std::size_t cap_bytes, std::size_t clear_bytes)
    : most_(cap_bytes - clear_bytes / 4),
      high_(cap_bytes - clear_bytes),
      low_(high_ - clear_bytes / 4) {
  most_on_disk_pages_ = regions().scratch.pages_of(cap_bytes / 4);
  statm_ = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  watching_.emplace(std::chrono::milliseconds(1), [this] { watch(); });
  sending_.emplace(std::chrono::milliseconds(1), [this] { make_room(); });
  cutting_.emplace(std::chrono::milliseconds(100), [this] { cut(); });
}

MemoryPager::~MemoryPager() {
  watching_.reset();
  sending_.reset();
  cutting_.reset();
  if (statm_ >= 0) ::close(statm_);
}

void MemoryPager::look() { regions().store->allow(most_ - std::min(most_, taken_bytes())); }

void MemoryPager::watch() {
  // Nothing would ever go on where a cap is too small for what is wanted at once: where all pages
  // have been asked to leave and there is still no room, one part comes all the same. Time alone
  // says nothing, as on a busy machine those that leave may be slow.
  const std::size_t least = std::max(kPart_bytes, regions().scratch.page);
  if (taken_bytes() + least > most_ && nothing_leaves_.exchange(false)) {
    regions().store->allow(least);
    return;
  }
  look();
}

void MemoryPager::fill(void* block, std::size_t size) {
  auto* const bytes = static_cast<std::byte*>(block);
  for (std::size_t at = 0; at < size; at += kPart_bytes) {
    const std::size_t part = std::min(kPart_bytes, size - at);
    regions().store->wait_for_room(part);
    take_memory(bytes + at, (part + kPage - 1) / kPage * kPage);
    regions().store->have_come(part);
  }
}

std::size_t MemoryPager::taken_bytes() const {
  static const auto kSystemPage = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  std::array<char, 128> text{};
  if (::pread(statm_, text.data(), text.size() - 1, 0) <= 0) return 0;
  char* at = nullptr;
  std::strtoull(text.data(), &at, 10);  // address space
  return std::strtoull(at, &at, 10) * kSystemPage;
}

void MemoryPager::make_room() {
  std::size_t taken = taken_bytes();
  if (taken <= high_) return;
  while (drop_one_free_of_scratch() || drop_one_free_of_memory()) {
    if (taken_bytes() <= low_) return;
  }
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
    const std::size_t left = taken_bytes();
    if (left <= low_) return;
    if (left < taken) look();  // whoever waits for room need not wait for all of it
    taken = left;
  }
  nothing_leaves_ = true;
  const auto now = std::chrono::steady_clock::now();
  if (now - trimmed_ > std::chrono::milliseconds(200)) {
    trimmed_ = now;
    malloc_trim(0);
  }
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
