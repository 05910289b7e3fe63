#include "scratch_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "block_regions.hpp"
#include "geo/core/error.hpp"
#include "memory.hpp"
#include "memory_pager.hpp"

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

/// A page that the system can neither read nor write.
void end_for_lost_page(int, siginfo_t* about, void*) {
  if (!regions().scratch.has(about->si_addr)) {
    std::signal(SIGBUS, SIG_DFL);
    std::raise(SIGBUS);
    return;
  }
  end_at_once(broken_message.data(), static_cast<int>(geo::ErrorKind::io));
}

off_t place(std::size_t pages) { return static_cast<off_t>(pages * kPage); }

}  // namespace

ScratchFile::ScratchFile(const fs::path& folder)
    : folder_(existing_folder(folder)), file_(open_scratch(folder_)) {
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
}

ScratchFile::~ScratchFile() { ::close(file_); }

std::string ScratchFile::full_message() const {
  constexpr std::size_t kMost = 700;
  return folder_.string().substr(0, kMost) +
         ": the disk is too full for the scratch file of --memory; --scratch DIR names a folder on "
         "another";
}

void ScratchFile::map(std::byte* base, std::size_t bytes) {
  if (::mmap(base, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_FIXED, file_, 0) == MAP_FAILED) {
    throw geo::IoError(
        fmt::format("{}: the scratch file of --memory cannot be mapped: {}; --scratch "
                    "DIR names another folder",
                    folder_.string(), std::strerror(errno)));
  }
  base_ = base;
  struct sigaction action {};
  action.sa_sigaction = end_for_lost_page;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGBUS, &action, nullptr);
}

bool ScratchFile::reserve(PageRanges::Range range) {
  int refused = EINTR;
  while (refused == EINTR) {
    refused = ::posix_fallocate(file_, place(range.first), place(range.pages));
  }
  return refused == 0;
}

void ScratchFile::send_away(PageRanges::Range range) {
  ::madvise(base_ + range.first * kPage, range.pages * kPage, MADV_DONTNEED);
}

PageRanges::Trace ScratchFile::drop(PageRanges::Range range) {
  send_away(range);
  return PageRanges::Trace::disk;
}

/// The system lets pages come as they are touched, and a look may be late.
std::size_t ScratchFile::least_clear_bytes(std::size_t cap_bytes) const {
  return static_cast<std::size_t>(terrane::least_clear_bytes(static_cast<double>(cap_bytes)));
}

void ScratchFile::forget(PageRanges::Range range) {
  // Where files cannot have holes, it stays.
  ::fallocate(file_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, place(range.first),
              place(range.pages));
}

}  // namespace terrane
