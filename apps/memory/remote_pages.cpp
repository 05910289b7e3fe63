#include "remote_pages.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/futex.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "geo/core/error.hpp"
#include "memory.hpp"

namespace terrane {
namespace {

std::atomic<RemotePages*> remote{nullptr};

void wait_while(std::atomic<std::uint32_t>& word, std::uint32_t value) noexcept {
  ::syscall(SYS_futex, &word, FUTEX_WAIT_PRIVATE, value, nullptr, nullptr, 0);
}

void wake(std::atomic<std::uint32_t>& word) noexcept {
  constexpr int kAll = 1 << 30;
  ::syscall(SYS_futex, &word, FUTEX_WAKE_PRIVATE, kAll, nullptr, nullptr, 0);
}

[[noreturn]] void end_for_lost_page() {
  end_at_once("memory shared with other ranks could not be mapped: the system has no more room",
              static_cast<int>(geo::ErrorKind::io));
}

/// A page was touched that nobody may touch: the region's comes here, any other is a fault.
void touched(int signal_number, siginfo_t* about, void*) {
  const int kept = errno;
  RemotePages* const pages = remote;
  if (pages == nullptr || !pages->bring(about->si_addr)) {
    std::signal(signal_number, SIG_DFL);
    std::raise(signal_number);
  }
  errno = kept;
}

}  // namespace

RemotePages::RemotePages(std::byte* base, std::size_t bytes, PagesAtRanks& ranks)
    : base_(base),
      pages_(bytes / ranks.page_bytes()),
      page_bytes_(ranks.page_bytes()),
      ranks_(ranks),
      file_(::memfd_create("terrane", MFD_CLOEXEC)) {
  std::array<int, 2> pipe{};
  void* const states = ::mmap(nullptr, pages_ * sizeof(Word), PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (file_ < 0 || ::ftruncate(file_, place(pages_)) != 0 || states == MAP_FAILED ||
      ::mmap(base, bytes, PROT_NONE, MAP_SHARED | MAP_FIXED | MAP_NORESERVE, file_, 0) ==
          MAP_FAILED ||
      ::pipe2(pipe.data(), O_CLOEXEC) != 0) {
    throw geo::IoError(
        fmt::format("memory to share with other ranks cannot be had: {}", std::strerror(errno)));
  }
  static_assert(fresh == 0 && Word::is_always_lock_free, "as the system gives memory");
  state_ = {static_cast<Word*>(states), pages_};
  wanted_from_ = pipe[0];
  wanted_to_ = pipe[1];
  remote = this;
  struct sigaction action {};
  action.sa_sigaction = touched;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGSEGV, &action, nullptr);
  fetching_ = std::thread([this] { fetch(); });
}

RemotePages::~RemotePages() {
  ::close(wanted_to_);  // which ends the thread
  fetching_.join();
}

void RemotePages::ends(std::size_t page, State to) noexcept {
  state_[page] = to;
  wake(state_[page]);
}

void RemotePages::open(std::size_t page) noexcept {
  if (::mprotect(at(page), page_bytes_, PROT_READ | PROT_WRITE) != 0) end_for_lost_page();
}

void RemotePages::close(PageRanges::Range range) {
  if (::mprotect(at(range.first), range.pages * page_bytes_, PROT_NONE) != 0) end_for_lost_page();
}

/// Memory of pages that nobody can touch goes back to the system.
void RemotePages::clear(PageRanges::Range range) {
  ::fallocate(file_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, place(range.first),
              place(range.pages));
}

/// Pages come no faster than others leave: whoever touches one more waits for the next look.
void RemotePages::wait_for_room() noexcept {
  for (;;) {
    const std::uint32_t said = allowances_;
    if (allowed_.fetch_sub(1) > 0) return;
    wait_while(allowances_, said);
  }
}

void RemotePages::allow(std::size_t bytes) {
  constexpr std::size_t kAlways = 16;  // else nothing would ever go on where a cap is too small
  allowed_ = static_cast<std::int64_t>(std::max(kAlways, bytes / page_bytes_));
  ++allowances_;
  wake(allowances_);
}

std::size_t RemotePages::least_clear_bytes(std::size_t cap_bytes) const {
  constexpr std::size_t kLeast = std::size_t(16) << 20, kMost = std::size_t(512) << 20;
  return std::clamp(cap_bytes / 16, kLeast, kMost);
}

bool RemotePages::bring(const void* address) noexcept {
  const auto* const byte = static_cast<const std::byte*>(address);
  if (byte < base_ || byte >= base_ + pages_ * page_bytes_) return false;
  const std::size_t page = static_cast<std::size_t>(byte - base_) / page_bytes_;
  Word& word = state_[page];
  for (;;) {
    std::uint32_t state = word;
    switch (state) {
      case here:
        return true;
      case fresh:
        if (!starts(page, fresh)) break;
        wait_for_room();
        open(page);
        ends(page, here);
        return true;
      case away:
        if (!word.compare_exchange_strong(state, wanted)) break;
        while (::write(wanted_to_, &page, sizeof page) < 0 && errno == EINTR) {
        }
        break;
      default:
        wait_while(word, state);
    }
  }
}

/// A page that is wanted, and those behind it or before it that will be.
PageRanges::Range RemotePages::with_those_ahead(std::size_t page) {
  const auto [first, pages] = ahead_.around(page, pages_);
  std::size_t begin = page, end = page + 1;
  while (end < first + pages && starts(end, away)) ++end;
  while (begin > first && starts(begin - 1, away)) --begin;
  return {begin, end - begin};
}

void RemotePages::fetch() {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
  std::size_t wanted_page = 0;
  for (;;) {
    const ssize_t got = ::read(wanted_from_, &wanted_page, sizeof wanted_page);
    if (got < 0 && errno == EINTR) continue;
    if (got != static_cast<ssize_t>(sizeof wanted_page)) return;
    const auto [first, pages] = with_those_ahead(wanted_page);
    for (std::size_t k = 0; k < pages; ++k) wait_for_room();
    ranks_.take(first, pages, [&](std::size_t page, std::span<const std::byte> bytes) {
      if (::pwrite(file_, bytes.data(), bytes.size(), place(page)) !=
          static_cast<ssize_t>(bytes.size())) {
        end_for_lost_page();
      }
      open(page);
      ends(page, here);
    });
    moved_ += pages;
  }
}

void RemotePages::send_away(PageRanges::Range range) {
  const std::size_t end = range.first + range.pages;
  for (std::size_t first = range.first; first < end;) {
    std::size_t last = first;
    while (last < end && starts(last, here)) ++last;
    if (last == first) {
      ++first;
      continue;
    }
    close({first, last - first});
    for (std::size_t page = first; page < last; ++page) {
      ranks_.put(page, [&](std::span<std::byte> bytes) {
        if (::pread(file_, bytes.data(), bytes.size(), place(page)) !=
            static_cast<ssize_t>(bytes.size())) {
          end_for_lost_page();
        }
      });
    }
    clear({first, last - first});
    moved_ += last - first;
    for (; first < last; ++first) ends(first, away);
  }
}

/// Nobody touches a part that is free; but it may be on its way.
PageRanges::Trace RemotePages::drop(PageRanges::Range range) {
  const std::size_t end = range.first + range.pages;
  bool elsewhere = false;
  for (std::size_t first = range.first; first < end;) {
    std::size_t last = first;
    while (last < end && starts(last, here)) ++last;
    if (last > first) {
      close({first, last - first});
      clear({first, last - first});
      for (; first < last; ++first) ends(first, fresh);
      continue;
    }
    if (starts(first, away)) {
      elsewhere = true;
      ends(first, fresh);
    }
    ++first;
  }
  if (elsewhere) ranks_.forget(range.first, range.pages);
  return PageRanges::Trace::none;
}

void RemotePages::forget(PageRanges::Range range) { drop(range); }

/// What a freed block left elsewhere need not be fetched for the next.
bool RemotePages::reserve(PageRanges::Range range) {
  bool elsewhere = false;
  for (std::size_t page = range.first; page < range.first + range.pages; ++page) {
    if (!starts(page, away)) continue;
    elsewhere = true;
    ends(page, fresh);
  }
  if (elsewhere) ranks_.forget(range.first, range.pages);
  return true;
}

bool bring_pages(const void* bytes, std::size_t size) noexcept {
  RemotePages* const pages = remote;
  if (pages == nullptr || size == 0) return false;
  const auto* const first = static_cast<const std::byte*>(bytes);
  if (!pages->bring(first)) return false;
  constexpr std::size_t kLeast = std::size_t(64) << 10;  // no page is smaller
  for (std::size_t at = kLeast; at < size; at += kLeast) pages->bring(first + at);
  return pages->bring(first + size - 1);
}

}  // namespace terrane
