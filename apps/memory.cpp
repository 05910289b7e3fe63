#include "memory.hpp"

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace terrane {

void keep_freed_memory() {
  mallopt(M_MMAP_MAX, 0);
  constexpr int kKeptAtTheEnd = 2047 << 20;
  mallopt(M_TRIM_THRESHOLD, kKeptAtTheEnd);
}

namespace {

/// Asks for pages of 2 MB within a block: a raster then takes few entries of the processor's table
/// of addresses, which walks along rivers would else exceed at every step. Where the system has
/// none, nothing changes.
void prefer_large_pages(void* block, std::size_t size) {
  constexpr std::size_t kWorthwhile = std::size_t(4) << 20;
  if (size < kWorthwhile) return;
  static const std::uintptr_t kPage = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto at = reinterpret_cast<std::uintptr_t>(block);
  const std::uintptr_t begin = (at + kPage - 1) / kPage * kPage, end = (at + size) / kPage * kPage;
  madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

}  // namespace
}  // namespace terrane

/// What every container of the program allocates with. The array forms come here too.
void* operator new(std::size_t size) {
  while (true) {
    if (void* block = std::malloc(size == 0 ? 1 : size)) {
      terrane::prefer_large_pages(block, size);
      return block;
    }
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
