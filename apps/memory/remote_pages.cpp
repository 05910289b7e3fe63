#include "remote_pages.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <span>

#include "geo/core/error.hpp"
#include "memory.hpp"

namespace terrane {
namespace {

[[noreturn]] void end_for_lost_page() {
  end_at_once("memory shared with other ranks could not be mapped: the system has no more room",
              static_cast<int>(geo::ErrorKind::io));
}

}  // namespace

RemotePages::RemotePages(std::byte* base, std::size_t bytes, PagesAtRanks& ranks)
    : GuardedPages(base, bytes, ranks.page_bytes()),
      ranks_(ranks),
      file_(::memfd_create("terrane", MFD_CLOEXEC)) {
  std::array<int, 2> pipe{};
  if (file_ < 0 || ::ftruncate(file_, place(pages())) != 0 ||
      ::mmap(base, bytes, PROT_NONE, MAP_SHARED | MAP_FIXED | MAP_NORESERVE, file_, 0) ==
          MAP_FAILED ||
      ::pipe2(pipe.data(), O_CLOEXEC) != 0) {
    throw geo::IoError(
        fmt::format("memory to share with other ranks cannot be had: {}", std::strerror(errno)));
  }
  wanted_from_ = pipe[0];
  wanted_to_ = pipe[1];
  fetching_ = std::thread([this] { fetch(); });
}

RemotePages::~RemotePages() {
  ::close(wanted_to_);  // which ends the thread
  fetching_.join();
}

void RemotePages::open_fresh(std::size_t page) noexcept {
  if (!protect({page, 1}, PROT_READ | PROT_WRITE)) end_for_lost_page();
}

void RemotePages::close(PageRanges::Range range) {
  if (!protect(range, PROT_NONE)) end_for_lost_page();
}

/// Memory of pages that nobody can touch goes back to the system.
void RemotePages::clear(PageRanges::Range range) {
  ::fallocate(file_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, place(range.first),
              place(range.pages));
}

void RemotePages::bring_away(std::size_t page, Access) noexcept {
  if (!turns(page, away, wanted)) return;
  while (::write(wanted_to_, &page, sizeof page) < 0 && errno == EINTR) {
  }
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
    const auto [first, count] = with_those_ahead(wanted_page);
    wait_for_room(count * page_bytes());
    ranks_.take(first, count, [&](std::size_t page, std::span<const std::byte> bytes) {
      if (::pwrite(file_, bytes.data(), bytes.size(), place(page)) !=
          static_cast<ssize_t>(bytes.size())) {
        end_for_lost_page();
      }
      open_fresh(page);
      ends(page, here);
    });
    have_come(count * page_bytes());
    moved_ += count;
  }
}

void RemotePages::send_away(PageRanges::Range range) {
  moved_ += with_all(range, here, away, [&](PageRanges::Range part) {
    close(part);
    for (std::size_t page = part.first; page < part.first + part.pages; ++page) {
      ranks_.put(page, [&](std::span<std::byte> bytes) {
        if (::pread(file_, bytes.data(), bytes.size(), place(page)) !=
            static_cast<ssize_t>(bytes.size())) {
          end_for_lost_page();
        }
      });
    }
    clear(part);
  });
}

/// Nobody touches a part that is free; but it may be on its way.
PageRanges::Trace RemotePages::drop(PageRanges::Range range) {
  with_all(range, here, fresh, [&](PageRanges::Range part) {
    close(part);
    clear(part);
  });
  reserve(range);
  return PageRanges::Trace::none;
}

void RemotePages::forget(PageRanges::Range range) { drop(range); }

/// What a freed block left elsewhere need not be fetched for the next.
bool RemotePages::reserve(PageRanges::Range range) {
  const auto elsewhere = with_all(range, away, fresh, [](PageRanges::Range) {});
  if (elsewhere > 0) ranks_.forget(range.first, range.pages);
  return true;
}

}  // namespace terrane
