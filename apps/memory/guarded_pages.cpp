#include "guarded_pages.hpp"

#include <fmt/format.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "geo/core/error.hpp"

namespace terrane {
namespace {

/// What comes at once waits for room at once.
constexpr std::size_t kMostAhead_bytes = std::size_t(4) << 20;

std::atomic<GuardedPages*> guarded{nullptr};

void wake(std::atomic<std::uint32_t>& word) noexcept {
  constexpr int kAll = 1 << 30;
  ::syscall(SYS_futex, &word, FUTEX_WAKE_PRIVATE, kAll, nullptr, nullptr, 0);
}

/// What the processor tells of a fault; where that is not known, a page that is written to as well
/// stops its thread twice.
Access access_of(const void* context) {
#ifdef __x86_64__
  constexpr greg_t kWrites = 2;
  const auto& registers = static_cast<const ucontext_t*>(context)->uc_mcontext.gregs;
  if ((registers[REG_ERR] & kWrites) == 0) return Access::read;
#else
  static_cast<void>(context);
#endif
  return Access::write;
}

/// A page was touched that nobody may touch: the region's comes here, any other is a fault.
void touched(int signal_number, siginfo_t* about, void* context) {
  const int kept = errno;
  GuardedPages* const pages = guarded;
  if (pages == nullptr || !pages->bring(about->si_addr, access_of(context))) {
    std::signal(signal_number, SIG_DFL);
    std::raise(signal_number);
  }
  errno = kept;
}

}  // namespace

GuardedPages::GuardedPages(std::byte* base, std::size_t bytes, std::size_t page_bytes)
    : base_(base),
      page_bytes_(page_bytes),
      ahead_(std::clamp(kMostAhead_bytes / page_bytes, std::size_t(1), std::size_t(16))) {
  const std::size_t count = bytes / page_bytes;
  void* const states = ::mmap(nullptr, count * sizeof(Word), PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (states == MAP_FAILED) {
    throw geo::IoError(
        fmt::format("memory whose pages come and go cannot be had: {}", std::strerror(errno)));
  }
  static_assert(fresh == 0 && Word::is_always_lock_free, "as the system gives memory");
  state_ = {static_cast<Word*>(states), count};
  guarded = this;
  struct sigaction action {};
  action.sa_sigaction = touched;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGSEGV, &action, nullptr);
}

bool GuardedPages::protect(PageRanges::Range range, int protection) const noexcept {
  return ::mprotect(at(range.first), range.pages * page_bytes_, protection) == 0;
}

void GuardedPages::wait_while(Word& word, std::uint32_t value) noexcept {
  ++waiting_;
  ::syscall(SYS_futex, &word, FUTEX_WAIT_PRIVATE, value, nullptr, nullptr, 0);
  --waiting_;
}

void GuardedPages::ends(std::size_t page, State to) noexcept {
  state_[page] = to;
  if (waiting_ > 0) wake(state_[page]);
}

/// Pages come no faster than others leave: whoever touches one more waits for the next look.
void GuardedPages::wait_for_room(std::size_t bytes) noexcept {
  for (;;) {
    const std::uint32_t said = allowances_;
    std::size_t allowed = allowed_;
    while (allowed >= bytes) {
      if (!allowed_.compare_exchange_weak(allowed, allowed - bytes)) continue;
      coming_ += bytes;
      return;
    }
    wait_while(allowances_, said);
  }
}

void GuardedPages::have_come(std::size_t bytes) noexcept { coming_ -= bytes; }

void GuardedPages::allow(std::size_t bytes) {
  allowed_ = bytes - std::min<std::size_t>(bytes, coming_);
  ++allowances_;
  if (waiting_ > 0) wake(allowances_);
}

bool GuardedPages::bring(const void* address, Access access) noexcept {
  const auto* const byte = static_cast<const std::byte*>(address);
  if (byte < base_ || byte >= base_ + pages() * page_bytes_) return false;
  const std::size_t page = static_cast<std::size_t>(byte - base_) / page_bytes_;
  Word& word = state_[page];
  for (;;) {
    const std::uint32_t state = word;
    switch (state) {
      case here:
        return true;
      case fresh:
        if (!starts(page, fresh)) break;
        wait_for_room(page_bytes_);
        open_fresh(page);
        have_come(page_bytes_);
        ends(page, here);
        return true;
      case unchanged:
        if (access == Access::read) return true;
        if (!starts(page, unchanged)) break;
        open_unchanged(page);
        ends(page, here);
        return true;
      case away:
        bring_away(page, access);
        break;
      default:
        wait_while(word, state);
    }
  }
}

PageRanges::Range GuardedPages::with_those_ahead(std::size_t page) noexcept {
  while (looks_ahead_.test_and_set()) {
  }
  const auto [first, count] = ahead_.around(page, pages());
  looks_ahead_.clear();
  std::size_t begin = page, end = page + 1;
  while (end < first + count && starts(end, away)) ++end;
  while (begin > first && starts(begin - 1, away)) --begin;
  return {begin, end - begin};
}

bool bring_pages(const void* bytes, std::size_t size, Access access) noexcept {
  GuardedPages* const pages = guarded;
  if (pages == nullptr || size == 0) return false;
  const auto* const first = static_cast<const std::byte*>(bytes);
  if (!pages->bring(first, access)) return false;
  constexpr std::size_t kLeast = std::size_t(64) << 10;  // no page is smaller
  for (std::size_t at = kLeast; at < size; at += kLeast) pages->bring(first + at, access);
  return pages->bring(first + size - 1, access);
}

}  // namespace terrane
