#include "memory_cap.hpp"

#include <malloc.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <fstream>
#include <new>
#include <string>
#include <utility>

#include "apps/ranks/page_server.hpp"
#include "block_regions.hpp"
#include "memory_pager.hpp"
#include "memory_size.hpp"
#include "remote_pages.hpp"
#include "scratch_file.hpp"

namespace terrane {
namespace {

namespace fs = std::filesystem;

constexpr double kProgram_bytes = 150e6;  // with its libraries and small blocks

/// Kept clear below a cap for small blocks, at least so much.
constexpr double kLeastClear_bytes = 48.0 * kMebibyte, kLeastClearOfRank_bytes = 16.0 * kMebibyte;
double clear_bytes(double cap_bytes, double least_bytes) {
  return std::clamp(cap_bytes / 16.0, least_bytes, 512.0 * kMebibyte);
}

/// Blocks that have memory of their own take so much of a cap: two fifths of what the program and
/// its small blocks leave. Where the cap holds most of what is wanted they take more: what can
/// leave is written to the disk and read back again and again.
constexpr double kShare = 0.4, kShareOfNearlyAll = 0.7;
double own_memory_bytes(double cap_bytes, double share) {
  return share * std::max(0.0, cap_bytes - kProgram_bytes);
}
double own_share(double cap_bytes, double uncapped_bytes) {
  constexpr double kNearlyAll = 0.75;
  return cap_bytes >= kNearlyAll * uncapped_bytes ? kShareOfNearlyAll : kShare;
}

std::atomic<MemoryPager*> pager{nullptr};
/// From the first address of both regions to the last; outside nothing is locked.
std::atomic<const std::byte*> first_address{nullptr}, last_address{nullptr};
std::array<char, 1024> full_message{};

/// Addresses, as many as the system gives: less where it limits them.
std::byte* reserve(std::size_t& size) {
#ifdef TERRANE_SANITIZED
  size = std::min(size, std::size_t(64) << 30);
#endif
  while (size >= kMebibyte) {
    void* const place =
        ::mmap(nullptr, size, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (place != MAP_FAILED) return static_cast<std::byte*>(place);
    size /= 2;
  }
  return nullptr;
}

/// Large pages are the system's cheapest, but hundreds are to come and go within the cap; and the
/// system keeps a list of parts that can be touched or not, and lets it have 65 530 entries.
std::size_t page_of_scratch_file(double cap_bytes) {
  constexpr double kFewPages = 192.0, kManyPages = 8192.0;
  std::size_t page = kPage;
  const auto many = [&] { return cap_bytes / static_cast<double>(page); };
  while ((page < kLargePage && many() > kFewPages) || many() > kManyPages) page *= 2;
  return page;
}

/// Addresses of both regions; pages of the scratch region are so large.
void lay_out(double cap_bytes, std::size_t page) {
  Regions& all = regions();
  all.memory_limit_pages = static_cast<std::size_t>(own_memory_bytes(cap_bytes, kShare)) / kPage;
  // Addresses twice, as freed parts do not always fit the next blocks.
  const auto most = static_cast<std::size_t>(2.0 * own_memory_bytes(cap_bytes, kShareOfNearlyAll));
  all.memory.size = (most / kLargePage + 1) * kLargePage;
  all.scratch.size = std::size_t(8) << 40;
  all.scratch.page = page;
  for (Region* region : {&all.memory, &all.scratch}) {
    region->base = reserve(region->size);
    if (region->base == nullptr) throw std::bad_alloc();
    region->ranges = PageRanges(region->size / region->page);
  }
  ::mprotect(all.memory.base, all.memory.size, PROT_READ | PROT_WRITE);
  ::madvise(all.memory.base, all.memory.size, MADV_HUGEPAGE);
}

}  // namespace

MemoryCap::MemoryCap(double cap_bytes, const fs::path& folder) {
  const std::size_t page = page_of_scratch_file(cap_bytes);
  lay_out(cap_bytes, page);
  const Region& scratch = regions().scratch;
  auto file = std::make_unique<ScratchFile>(folder, scratch.base, scratch.size, page);
  std::snprintf(full_message.data(), full_message.size(), "%s", file->full_message().c_str());
  regions().store = std::move(file);
  begin(cap_bytes, clear_bytes(cap_bytes, kLeastClear_bytes));
}

MemoryCap::MemoryCap(double cap_bytes, RankMessages& ranks, double uncapped_bytes) {
  // The system keeps a list of parts that can be touched or not, and lets it have 65 530 entries.
  constexpr double kMostPages = 20000.0;
  std::size_t page = kPage;
  while (static_cast<double>(page) * kMostPages < uncapped_bytes) page *= 2;
  static PagesAtRanks at_ranks(ranks, page);
  lay_out(cap_bytes, page);
  const Region& scratch = regions().scratch;
  auto pages = std::make_unique<RemotePages>(scratch.base, scratch.size, at_ranks);
  remote_ = pages.get();
  regions().store = std::move(pages);
  begin(cap_bytes, clear_bytes(cap_bytes, kLeastClearOfRank_bytes));
}

void MemoryCap::begin(double cap_bytes, double clear_bytes) {
  cap_bytes_ = cap_bytes;
  const Regions& all = regions();
  first_address = std::min(all.memory.base, all.scratch.base);
  last_address = std::max(all.memory.base + all.memory.size, all.scratch.base + all.scratch.size);
  mallopt(M_TRIM_THRESHOLD, 16 << 20);
  pager_ = std::make_unique<MemoryPager>(static_cast<std::size_t>(cap_bytes),
                                         static_cast<std::size_t>(clear_bytes));
  pager = pager_.get();
}

void MemoryCap::expect(double uncapped_bytes) {
  const double own = own_memory_bytes(cap_bytes_, own_share(cap_bytes_, uncapped_bytes));
  const std::lock_guard lock(regions().mutex);
  regions().memory_limit_pages = static_cast<std::size_t>(own) / kPage;
}

MemoryCap::~MemoryCap() {
  pager = nullptr;  // no thread of the run is left
}

double MemoryCap::scratch_bytes() const {
  const std::lock_guard lock(regions().mutex);
  return static_cast<double>(regions().scratch.most_pages * regions().scratch.page);
}

double MemoryCap::exchanged_bytes() const {
  return remote_ == nullptr ? 0.0 : static_cast<double>(remote_->exchanged_bytes());
}

void* capped_block(std::size_t size) noexcept {
  if (size < kLargeBlock) return nullptr;
  MemoryPager* const watch = pager.load(std::memory_order_acquire);
  Regions& all = regions();
  if (watch == nullptr || size > all.scratch.size) return nullptr;
  if (void* const block = block_in_memory(size)) {
    watch->fill(block, size);
    return block;
  }
  return block_in_scratch(size);
}

bool free_capped_block(void* block) noexcept {
  const auto* const place = static_cast<const std::byte*>(block);
  if (place < first_address.load(std::memory_order_relaxed) ||
      place >= last_address.load(std::memory_order_relaxed)) {
    return false;
  }
  Regions& all = regions();
  Region* const region = all.memory.has(block)    ? &all.memory
                         : all.scratch.has(block) ? &all.scratch
                                                  : nullptr;
  if (region == nullptr) return false;
  const std::lock_guard lock(all.mutex);
  region->ranges.give(static_cast<std::size_t>(place - region->base) / region->page);
  return true;
}

bool scratch_is_full() noexcept { return scratch_was_full(); }
bool lacks_scratch(std::size_t size) noexcept { return size >= kLargeBlock && scratch_was_full(); }
const char* scratch_error() noexcept { return full_message.data(); }

double peak_resident_bytes() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word) {
    double kilobytes = 0.0;
    if (word == "VmHWM:" && status >> kilobytes) return 1024.0 * kilobytes;
  }
  return 0.0;
}

MemoryUnderCap memory_under_cap(double cap_bytes, double uncapped_bytes, double available_bytes) {
  const double large = std::max(0.0, uncapped_bytes - kProgram_bytes);
  const double own = own_memory_bytes(cap_bytes, own_share(cap_bytes, uncapped_bytes));
  // Half of what is kept clear is taken at some time.
  const double resident = cap_bytes - 0.5 * clear_bytes(cap_bytes, kLeastClear_bytes);
  // Pages that come back cost a fault each: measured on 4096 x 2048 cells and caps of 0.2 to 0.8.
  constexpr double kSlower = 0.65;
  const double lacking = std::max(0.0, 1.0 - cap_bytes / uncapped_bytes);
  // Of the scratch file the system lets a fifth of its memory wait to be written. Beyond that pages
  // leave as fast as the disk takes them: measured on 21600 x 10800 cells and caps of 0.25 and 0.7.
  constexpr double kWaiting = 0.2, kSlowerDisk = 1.6;
  const double scratch = std::max(0.0, large - own);
  const double on_disk =
      scratch > 0.0 ? std::max(0.0, 1.0 - kWaiting * available_bytes / scratch) : 0.0;
  return {.resident_bytes = std::min(uncapped_bytes, resident),
          .scratch_bytes = scratch,
          .times_as_long = 1.0 + kSlower * lacking + kSlowerDisk * on_disk * lacking * lacking};
}

double cap_of_rank(double uncapped_bytes, int ranks) {
  // Its share and a quarter more for what comes back while something else is away, and the program.
  constexpr double kMore = 1.25, kWithMpi_bytes = 35e6;
  return std::max(kLeastMemory_bytes,
                  kMore * uncapped_bytes / ranks + kProgram_bytes + kWithMpi_bytes);
}

}  // namespace terrane
