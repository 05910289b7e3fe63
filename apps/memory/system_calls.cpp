// Files are read into pages that may be away, and written from them: the system does not fetch
// them, it refuses (EFAULT). They are brought here before it is asked, and once more where they
// left meanwhile.
#ifndef TERRANE_SANITIZED

#include <dlfcn.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>

#include "guarded_pages.hpp"

namespace {

using terrane::Access;

/// As much at once as surely stays together; callers go on where less was done than they wanted.
constexpr std::size_t kMost = std::size_t(1) << 20;
/// Less than a stream's buffer.
constexpr std::size_t kPiece = 2048;

template <class Call>
ssize_t with_pages(const void* bytes, std::size_t size, Access access, Call&& call) {
  if (!terrane::bring_pages(bytes, std::min(size, kMost), access)) return call(size);
  for (;;) {
    const ssize_t done = call(std::min(size, kMost));
    if (done >= 0 || errno != EFAULT) return done;
    terrane::bring_pages(bytes, std::min(size, kMost), access);
  }
}

template <class Call>
Call* next(const char* name) {
  return reinterpret_cast<Call*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

ssize_t read(int file, void* bytes, std::size_t size) {
  static auto* const kNext = next<ssize_t(int, void*, std::size_t)>("read");
  return with_pages(bytes, size, Access::write,
                    [&](std::size_t part) { return kNext(file, bytes, part); });
}

ssize_t write(int file, const void* bytes, std::size_t size) {
  static auto* const kNext = next<ssize_t(int, const void*, std::size_t)>("write");
  return with_pages(bytes, size, Access::read,
                    [&](std::size_t part) { return kNext(file, bytes, part); });
}

ssize_t pread64(int file, void* bytes, std::size_t size, off64_t place) {
  static auto* const kNext = next<ssize_t(int, void*, std::size_t, off64_t)>("pread64");
  return with_pages(bytes, size, Access::write,
                    [&](std::size_t part) { return kNext(file, bytes, part, place); });
}

ssize_t pwrite64(int file, const void* bytes, std::size_t size, off64_t place) {
  static auto* const kNext = next<ssize_t(int, const void*, std::size_t, off64_t)>("pwrite64");
  return with_pages(bytes, size, Access::read,
                    [&](std::size_t part) { return kNext(file, bytes, part, place); });
}

ssize_t pread(int file, void* bytes, std::size_t size, off_t place) {
  return pread64(file, bytes, size, place);
}

ssize_t pwrite(int file, const void* bytes, std::size_t size, off_t place) {
  return pwrite64(file, bytes, size, place);
}

/// Part by part, the first alone where it is the region's: callers go on behind what was written.
ssize_t writev(int file, const struct iovec* parts, int count) {
  static auto* const kNext = next<ssize_t(int, const struct iovec*, int)>("writev");
  for (int k = 0; k < count; ++k) {
    if (!terrane::bring_pages(parts[k].iov_base, std::min(parts[k].iov_len, kMost), Access::read))
      continue;
    if (k > 0) return kNext(file, parts, k);
    return write(file, parts[0].iov_base, parts[0].iov_len);
  }
  return kNext(file, parts, count);
}

/// The C library's streams ask the system by themselves: they are given copies.
std::size_t fwrite(const void* items, std::size_t size, std::size_t count, FILE* stream) {
  static auto* const kNext =
      next<std::size_t(const void*, std::size_t, std::size_t, FILE*)>("fwrite");
  if (!terrane::bring_pages(items, 1, Access::read)) return kNext(items, size, count, stream);
  const auto* const bytes = static_cast<const std::byte*>(items);
  const std::size_t all = size * count;
  std::array<std::byte, kPiece> piece;
  std::size_t done = 0;
  while (done < all) {
    const std::size_t wanted = std::min(piece.size(), all - done);
    std::memcpy(piece.data(), bytes + done, wanted);
    const std::size_t written = kNext(piece.data(), 1, wanted, stream);
    done += written;
    if (written < wanted) break;
  }
  return size == 0 ? 0 : done / size;
}

std::size_t fread(void* items, std::size_t size, std::size_t count, FILE* stream) {
  static auto* const kNext = next<std::size_t(void*, std::size_t, std::size_t, FILE*)>("fread");
  if (!terrane::bring_pages(items, 1, Access::write)) return kNext(items, size, count, stream);
  auto* const bytes = static_cast<std::byte*>(items);
  const std::size_t all = size * count;
  std::array<std::byte, kPiece> piece;
  std::size_t done = 0;
  while (done < all) {
    const std::size_t wanted = std::min(piece.size(), all - done);
    const std::size_t got = kNext(piece.data(), 1, wanted, stream);
    std::memcpy(bytes + done, piece.data(), got);
    done += got;
    if (got < wanted) break;
  }
  return size == 0 ? 0 : done / size;
}
}

#endif
