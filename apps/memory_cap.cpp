#include "memory_cap.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "geo/core/error.hpp"
#include "memory.hpp"
#include "page_ranges.hpp"

namespace terrane {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMebibyte = std::size_t(1) << 20;
/// Blocks from here up; smaller ones are the heap's.
constexpr std::size_t kLargeBlock = kMebibyte / 4;
/// Large blocks begin and end at these, so that neighbours share no page of any machine.
constexpr std::size_t kPage = std::size_t(64) << 10;
constexpr std::size_t kLargePage = 2 * kMebibyte;

constexpr double kProgram_bytes = 150e6;  // with its libraries and small blocks

/// Blocks that have memory of their own take so much of a cap: two fifths of what the program and
/// its small blocks leave.
double own_memory_bytes(double cap_bytes) {
  constexpr double kShare = 0.4;
  return kShare * std::max(0.0, cap_bytes - kProgram_bytes);
}

/// Kept clear below the cap for what is touched until the next look.
double least_clear_bytes(double cap_bytes) {
  return std::clamp(cap_bytes / 4.0, 48.0 * kMebibyte, 1024.0 * kMebibyte);
}

std::size_t pages_of(std::size_t bytes) { return (bytes + kPage - 1) / kPage; }

/// One region of addresses with the parts of it that are in use.
struct Region {
  std::byte* base = nullptr;
  std::size_t size = 0;
  PageRanges ranges{0};
  std::size_t most_pages = 0;

  [[nodiscard]] bool has(const void* block) const { return block >= base && block < base + size; }
  [[nodiscard]] std::byte* at(std::size_t page) const { return base + page * kPage; }
};

/// Never destroyed: blocks are given back until the very end of the program.
struct Regions {
  std::mutex mutex;
  Region memory, scratch;
  std::size_t memory_limit_pages = 0;
  int file = -1;
};

Regions& regions() {
  static Regions* const kRegions = new Regions;
  return *kRegions;
}

std::atomic<MemoryPager*> pager{nullptr};
std::atomic<bool> is_full{false};
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

using Trace = PageRanges::Trace;

/// The pages of one free part leave memory; those of the scratch file stay on the disk for the next
/// block. Returns whether there was one.
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

/// One free part of the scratch file leaves the disk. Returns whether there was one.
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

bool reserve_room(const Region& region, const PageRanges::Range& range, int file) {
  int refused = EINTR;
  while (refused == EINTR) {
    refused = ::posix_fallocate(file, region.at(range.first) - region.base,
                                static_cast<off_t>(range.pages * kPage));
  }
  return refused == 0;
}

void* block_in_memory(Regions& all, std::size_t size) {
  const std::lock_guard lock(all.mutex);
  const std::size_t pages = pages_of(size);
  if (all.memory.ranges.pages_in_use() + pages > all.memory_limit_pages) return nullptr;
  const auto range = all.memory.ranges.take(pages);
  return range ? all.memory.at(range->first) : nullptr;
}

void* block_in_scratch(Regions& all, std::size_t size) {
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

/// What of this process is in memory.
struct Resident {
  std::size_t own = 0, of_files = 0;
};

/// A busy machine lets a thread that seldom works wait for those that always do; this one says that
/// it works for a tenth of a millisecond at a time, and is let in soon. Where the system knows no
/// such thing, or does not let it go ahead of others, nothing changes.
void ask_for_short_turns() {
  struct {
    std::uint32_t size = 48, policy = SCHED_OTHER;
    std::uint64_t flags = 0;
    std::int32_t nice = 0;
    std::uint32_t priority = 0;
    std::uint64_t runtime_ns = 100000, deadline_ns = 0, period_ns = 0;
  } attributes;
  ::syscall(SYS_sched_setattr, 0, &attributes, 0);
  constexpr int kAhead = -15;
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kAhead);
}

void block_signals() {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
}

/// Calls `work` every so often until it is destroyed.
class Repeating {
 public:
  Repeating(std::chrono::milliseconds pause, std::function<void()> work)
      : work_(std::move(work)), thread_([this, pause] {
          block_signals();  // they are the main thread's to handle
          ask_for_short_turns();
          std::unique_lock lock(mutex_);
          while (!changed_.wait_for(lock, pause, [this] { return stopping_; })) {
            lock.unlock();
            work_();
            lock.lock();
          }
        }) {}
  ~Repeating() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  Repeating(const Repeating&) = delete;
  Repeating& operator=(const Repeating&) = delete;

 private:
  std::function<void()> work_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace

/// Keeps the cap: one thread for pages in memory, one for the room of free parts on the disk, which
/// may have to wait for it.
class MemoryPager {
 public:
  explicit MemoryPager(std::size_t cap_bytes) : cap_(cap_bytes) {
    keep_clear(least_clear());
    most_on_disk_pages_ = pages_of(cap_bytes / 4);
    statm_ = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    own_at_first_ = resident().own;
    watching_.emplace(std::chrono::milliseconds(1), [this] { look(); });
    cutting_.emplace(std::chrono::milliseconds(100), [this] { cut(); });
  }
  ~MemoryPager() {
    watching_.reset();
    cutting_.reset();
    if (statm_ >= 0) ::close(statm_);
  }
  MemoryPager(const MemoryPager&) = delete;
  MemoryPager& operator=(const MemoryPager&) = delete;

  /// Drops pages if too many are in memory. Whoever comes while another drops need not wait.
  void look() {
    const std::size_t taken = taken_bytes();
    if (taken <= high_) return forget();
    const std::unique_lock lock(dropping_, std::try_to_lock);
    if (!lock) return;
    // On a busy machine this thread comes late: the later it came, the more is kept clear.
    const std::size_t late = std::min(2 * (taken - std::min(taken, high_.load())), cap_ / 5 * 2);
    if (late > cap_ - high_) keep_clear(late);
    while (taken_bytes() > low_) {
      if (drop_one_free(regions().scratch, Trace::disk)) continue;
      if (drop_one_free(regions().memory, Trace::none)) continue;
      if (!drop_round()) break;
    }
  }

 private:
  [[nodiscard]] Resident resident() const {
    static const auto kSystemPage = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    std::array<char, 128> text{};
    if (::pread(statm_, text.data(), text.size() - 1, 0) <= 0) return {};
    char* at = nullptr;
    std::strtoull(text.data(), &at, 10);  // address space
    const std::size_t all = std::strtoull(at, &at, 10), of_files = std::strtoull(at, &at, 10);
    return {(all - std::min(all, of_files)) * kSystemPage, of_files * kSystemPage};
  }

  /// What is in memory, and what will be once all blocks that have memory of their own are touched:
  /// that goes faster than anybody could look.
  [[nodiscard]] std::size_t taken_bytes() const {
    const Resident now = resident();
    Regions& all = regions();
    const std::lock_guard lock(all.mutex);
    const std::size_t promised = all.memory.ranges.pages_in_use() * kPage;
    return now.of_files + std::max(now.own, own_at_first_ + promised);
  }

  [[nodiscard]] std::size_t least_clear() const {
    return static_cast<std::size_t>(least_clear_bytes(static_cast<double>(cap_)));
  }
  /// That it came late once says less and less of now.
  void forget() {
    constexpr std::size_t kLooks = 1000;
    const std::size_t clear = cap_ - high_;
    if (clear > least_clear()) keep_clear(clear - (clear - least_clear() + kLooks - 1) / kLooks);
  }
  void keep_clear(std::size_t margin) {
    high_ = cap_ - margin;
    low_ = cap_ - margin - margin / 4;
  }

  /// Pages of the scratch file in turn. False when all were, and it was not enough.
  bool drop_round() {
    constexpr std::size_t kStep = 4 * kMebibyte / kPage;
    Regions& all = regions();
    std::size_t reach = 0;
    {
      const std::lock_guard lock(all.mutex);
      reach = all.scratch.ranges.reach();
    }
    for (std::size_t gone = 0; gone < reach; gone += kStep) {
      if (hand_ >= reach) hand_ = 0;
      const std::size_t pages = std::min(kStep, reach - hand_);
      ::madvise(all.scratch.at(hand_), pages * kPage, MADV_DONTNEED);
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

  /// Free parts that lie on the disk are used again, but not without end: the system would write
  /// what nobody reads.
  void cut() const {
    Regions& all = regions();
    const auto is_much = [&] {
      const std::lock_guard lock(all.mutex);
      return all.scratch.ranges.free_pages(Trace::disk) > most_on_disk_pages_;
    };
    while (is_much() && cut_one_free(Trace::disk)) {
    }
  }

  const std::size_t cap_;
  std::atomic<std::size_t> high_{0}, low_{0};
  std::size_t hand_ = 0, own_at_first_ = 0, most_on_disk_pages_ = 0;
  int statm_ = -1;
  std::chrono::steady_clock::time_point trimmed_;
  std::mutex dropping_;
  std::optional<Repeating> watching_, cutting_;
};

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
  void* block = block_in_memory(all, size);
  if (block == nullptr) block = block_in_scratch(all, size);
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

bool scratch_is_full() noexcept { return is_full; }
bool lacks_scratch(std::size_t size) noexcept { return size >= kLargeBlock && is_full; }
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

double parse_memory_size(const std::string& text) {
  struct Unit {
    const char* name;
    double bytes;
  };
  constexpr std::array<Unit, 9> kUnits{{{"B", 1.0},
                                        {"kB", 1e3},
                                        {"MB", 1e6},
                                        {"GB", 1e9},
                                        {"TB", 1e12},
                                        {"KiB", 0x1p10},
                                        {"MiB", 0x1p20},
                                        {"GiB", 0x1p30},
                                        {"TiB", 0x1p40}}};
  const std::size_t digits = std::min(text.size(), text.find_first_not_of("0123456789."));
  double number = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + digits, number);
  const std::string unit = text.substr(digits);
  const auto known = std::find_if(kUnits.begin(), kUnits.end(),
                                  [&](const Unit& each) { return unit == each.name; });
  if (digits == 0 || error != std::errc() || stop != text.data() + digits ||
      known == kUnits.end()) {
    throw geo::ConfigurationError(
        fmt::format("--memory {}: must be a size such as 16GiB or 500MB", text));
  }
  const double bytes = number * known->bytes;
  constexpr double kMost_bytes = 0x1p50;
  if (bytes < kLeastMemory_bytes || bytes > kMost_bytes) {
    throw geo::ConfigurationError(fmt::format(
        "--memory {}: must be from {:.0f}MB, which the program takes on any grid, to 1024TiB", text,
        kLeastMemory_bytes / 1e6));
  }
  return bytes;
}

}  // namespace terrane
