#include "memory_cap.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>

#include "block_regions.hpp"
#include "geo/core/error.hpp"
#include "memory.hpp"
#include "memory_pager.hpp"

namespace terrane {
namespace {

namespace fs = std::filesystem;

constexpr double kProgram_bytes = 150e6;  // with its libraries and small blocks

/// Blocks that have memory of their own take so much of a cap: two fifths of what the program and
/// its small blocks leave.
double own_memory_bytes(double cap_bytes) {
  constexpr double kShare = 0.4;
  return kShare * std::max(0.0, cap_bytes - kProgram_bytes);
}

std::atomic<MemoryPager*> pager{nullptr};
/// From the first address of both regions to the last; outside nothing is locked.
std::atomic<const std::byte*> first_address{nullptr}, last_address{nullptr};
std::array<char, 1024> full_message{}, broken_message{};

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

fs::path existing_folder(const fs::path& folder) {
  std::error_code error;
  fs::path there = fs::absolute(folder, error);
  while (!fs::exists(there, error) && there.has_relative_path()) there = there.parent_path();
  return there;
}

/// A file without a name; where the system has none, one whose name is gone at once.
int open_scratch(const fs::path& folder) {
  int file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0 || (errno != EOPNOTSUPP && errno != EISDIR && errno != ENOENT)) return file;
  std::string name = (folder / ".terrane-scratch-XXXXXX").string();
  file = ::mkostemp(name.data(), O_CLOEXEC);
  if (file >= 0) ::unlink(name.c_str());
  return file;
}

/// A page of the scratch file that the system can neither read nor write.
void end_for_lost_page(int, siginfo_t* about, void*) {
  if (!regions().scratch.has(about->si_addr)) {
    std::signal(SIGBUS, SIG_DFL);
    std::raise(SIGBUS);
    return;
  }
  end_at_once(broken_message.data(), static_cast<int>(geo::ErrorKind::io));
}

}  // namespace

MemoryCap::MemoryCap(double cap_bytes, const fs::path& folder) {
  const fs::path there = existing_folder(folder);
  Regions& all = regions();
  all.file = open_scratch(there);
  if (all.file < 0) {
    throw geo::IoError(
        fmt::format("{}: no scratch file for --memory: {}; --scratch DIR names another folder",
                    there.string(), std::strerror(errno)));
  }
  std::snprintf(
      full_message.data(), full_message.size(),
      "%.700s: the disk is too full for the scratch file of --memory; --scratch DIR names "
      "a folder on another",
      there.c_str());
  std::snprintf(
      broken_message.data(), broken_message.size(),
      "%.700s: the scratch file of --memory could not be read or written: the disk is full "
      "or fails; --scratch DIR names a folder on another",
      there.c_str());
  all.memory_limit_pages = static_cast<std::size_t>(own_memory_bytes(cap_bytes)) / kPage;
  // Memory twice, as freed parts do not always fit the next blocks.
  std::size_t size =
      (std::size_t(2) * all.memory_limit_pages * kPage / kLargePage + 1) * kLargePage;
  std::size_t scratch = std::size_t(8) << 40;
  all.memory.base = reserve(size);
  all.memory.size = size;
  all.scratch.base = reserve(scratch);
  all.scratch.size = scratch;
  if (all.memory.base == nullptr || all.scratch.base == nullptr) throw std::bad_alloc();
  ::mprotect(all.memory.base, size, PROT_READ | PROT_WRITE);
  ::madvise(all.memory.base, size, MADV_HUGEPAGE);
  if (::mmap(all.scratch.base, scratch, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_FIXED, all.file,
             0) == MAP_FAILED) {
    throw geo::IoError(
        fmt::format("{}: the scratch file of --memory cannot be mapped: {}; --scratch "
                    "DIR names another folder",
                    there.string(), std::strerror(errno)));
  }
  all.memory.ranges = PageRanges(size / kPage);
  all.scratch.ranges = PageRanges(scratch / kPage);
  struct sigaction action {};
  action.sa_sigaction = end_for_lost_page;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGBUS, &action, nullptr);
  first_address = std::min(all.memory.base, all.scratch.base);
  last_address = std::max(all.memory.base + size, all.scratch.base + scratch);
  mallopt(M_TRIM_THRESHOLD, 16 << 20);
  pager_ = std::make_unique<MemoryPager>(static_cast<std::size_t>(cap_bytes));
  pager = pager_.get();
}

MemoryCap::~MemoryCap() {
  pager = nullptr;  // no thread of the run is left
}

double MemoryCap::scratch_bytes() const {
  const std::lock_guard lock(regions().mutex);
  return static_cast<double>(regions().scratch.most_pages * kPage);
}

void* capped_block(std::size_t size) noexcept {
  if (size < kLargeBlock) return nullptr;
  MemoryPager* const watch = pager.load(std::memory_order_acquire);
  Regions& all = regions();
  if (watch == nullptr || size > all.scratch.size) return nullptr;
  void* block = block_in_memory(size);
  if (block == nullptr) block = block_in_scratch(size);
  watch->look();
  return block;
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
  region->ranges.give(static_cast<std::size_t>(place - region->base) / kPage);
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

MemoryUnderCap memory_under_cap(double cap_bytes, double uncapped_bytes) {
  const double large = std::max(0.0, uncapped_bytes - kProgram_bytes);
  const double waiting = std::max(0.0, large - own_memory_bytes(cap_bytes));
  // A late look finds more than the mark: half of what is kept clear is taken at some time.
  return {std::min(uncapped_bytes, cap_bytes - 0.5 * least_clear_bytes(cap_bytes)), waiting};
}

}  // namespace terrane
