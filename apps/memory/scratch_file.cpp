#include "scratch_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "block_regions.hpp"
#include "geo/core/error.hpp"
#include "memory.hpp"

namespace terrane {
namespace {

namespace fs = std::filesystem;

std::array<char, 1024> broken_message{};

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

[[noreturn]] void end_for_broken_file() {
  end_at_once(broken_message.data(), static_cast<int>(geo::ErrorKind::io));
}

[[noreturn]] void end_for_want_of_places() {
  end_at_once(
      "memory for pages of the scratch file could not be mapped: the system has no more room",
      static_cast<int>(geo::ErrorKind::io));
}

/// Of all bytes from `place` on; false where the disk does not. Not by the calls that bring pages
/// here first: these are moving.
template <class Call>
bool all_of(Call&& call, int file, std::byte* bytes, std::size_t size, off_t place) {
  while (size > 0) {
    const iovec part{bytes, size};
    const ssize_t done = call(file, &part, 1, place);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes += done;
    size -= static_cast<std::size_t>(done);
    place += done;
  }
  return true;
}

}  // namespace

ScratchFile::ScratchFile(const fs::path& folder, std::byte* base, std::size_t bytes,
                         std::size_t page_bytes)
    : GuardedPages(base, bytes, page_bytes),
      folder_(existing_folder(folder)),
      file_(open_scratch(folder_)) {
  if (file_ < 0) {
    throw geo::IoError(
        fmt::format("{}: no scratch file for --memory: {}; --scratch DIR names another folder",
                    folder_.string(), std::strerror(errno)));
  }
  std::snprintf(
      broken_message.data(), broken_message.size(),
      "%.700s: the scratch file of --memory could not be read or written: the disk is full "
      "or fails; --scratch DIR names a folder on another",
      folder_.c_str());
  // What was written and read back is not what the system's cache should keep longest.
  ::posix_fadvise(file_, 0, 0, POSIX_FADV_NOREUSE);
}

ScratchFile::~ScratchFile() { ::close(file_); }

std::string ScratchFile::full_message() const {
  constexpr std::size_t kMost = 700;
  return folder_.string().substr(0, kMost) +
         ": the disk is too full for the scratch file of --memory; --scratch DIR names a folder on "
         "another";
}

/// Memory of these pages goes back to the system, and nobody can touch them.
void ScratchFile::empty(PageRanges::Range range) noexcept {
  if (::mmap(at(range.first), range.pages * page_bytes(), PROT_NONE,
             MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED | MAP_NORESERVE, -1, 0) == MAP_FAILED) {
    end_for_want_of_places();
  }
}

void ScratchFile::open_unchanged(std::size_t page) noexcept {
  if (!protect({page, 1}, PROT_READ | PROT_WRITE)) end_for_want_of_places();
}

/// It takes its memory at once, as nobody else is asked for room for the rest of it.
void ScratchFile::open_fresh(std::size_t page) noexcept {
  open_unchanged(page);
  take_memory(at(page), page_bytes());
}

/// What is read is moved to its place when all of it is there.
void ScratchFile::bring_away(std::size_t page, Access access) noexcept {
  if (!starts(page, away)) return;
  const auto range = with_those_ahead(page);
  const std::size_t size = range.pages * page_bytes();
  if (range.pages > 1) {
    // Somebody reads along: the disk is asked for all of it at once, and for what comes next.
    const std::size_t back = range.first < page ? std::min(range.first, range.pages) : 0;
    ::posix_fadvise(file_, place(range.first - back), 2 * static_cast<off_t>(size),
                    POSIX_FADV_WILLNEED);
  }
  wait_for_room(size);
  void* const read = ::mmap(nullptr, size, PROT_READ | PROT_WRITE,
                            MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (read == MAP_FAILED) end_for_want_of_places();
  take_memory(static_cast<std::byte*>(read), size);
  if (!all_of(::preadv, file_, static_cast<std::byte*>(read), size, place(range.first))) {
    end_for_broken_file();
  }
  if (access == Access::read) ::mprotect(read, size, PROT_READ);
  if (::mremap(read, size, size, MREMAP_MAYMOVE | MREMAP_FIXED, at(range.first)) == MAP_FAILED) {
    end_for_want_of_places();
  }
  have_come(size);
  for (std::size_t k = 0; k < range.pages; ++k) {
    ends(range.first + k, access == Access::read ? unchanged : here);
  }
}

bool ScratchFile::reserve(PageRanges::Range range) {
  int refused = EINTR;
  while (refused == EINTR) {
    refused = ::posix_fallocate(file_, place(range.first), place(range.pages));
  }
  if (refused != 0) return false;
  // What a freed block left there need not be read for the next.
  with_all(range, away, fresh, [](PageRanges::Range) {});
  return true;
}

void ScratchFile::write(PageRanges::Range range) const {
  if (!all_of(::pwritev, file_, at(range.first), range.pages * page_bytes(), place(range.first))) {
    end_for_broken_file();
  }
}

void ScratchFile::send_away(PageRanges::Range range) {
  with_all(range, unchanged, away, [&](PageRanges::Range part) { empty(part); });
  with_all(range, here, away, [&](PageRanges::Range part) {
    if (!protect(part, PROT_READ)) end_for_want_of_places();
    write(part);
    empty(part);
  });
}

PageRanges::Trace ScratchFile::drop(PageRanges::Range range) {
  for (const State state : {here, unchanged}) {
    with_all(range, state, fresh, [&](PageRanges::Range part) { empty(part); });
  }
  with_all(range, away, fresh, [](PageRanges::Range) {});
  return PageRanges::Trace::disk;
}

void ScratchFile::forget(PageRanges::Range range) {
  drop(range);
  // Where files cannot have holes, it stays.
  ::fallocate(file_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, place(range.first),
              place(range.pages));
}

}  // namespace terrane
