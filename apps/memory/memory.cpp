#include "memory.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <malloc.h>
#include <omp.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <new>

#include "apps/log.hpp"
#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "memory_cap.hpp"

namespace terrane {
namespace {

std::atomic<std::size_t> wanted_bytes{0};

/// Pages of 2 MB within a block: a raster then takes few entries of the processor's table of
/// addresses, which walks along rivers would else exceed at every step. Where the system has none,
/// nothing changes.
void prefer_large_pages(void* block, std::size_t size) {
  constexpr std::size_t kWorthwhile = std::size_t(4) << 20;
  if (size < kWorthwhile) return;
  static const std::uintptr_t kPage = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto at = reinterpret_cast<std::uintptr_t>(block);
  const std::uintptr_t begin = (at + kPage - 1) / kPage * kPage, end = (at + size) / kPage * kPage;
  madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

/// The system clears a page when it is first touched. Most containers are filled with zeros where
/// they are made, by one thread: the pages of a large one are asked for by all before. Only by the
/// thread that computes, as a team of OpenMP's is its own; where the system does not know this,
/// nothing changes.
void touch_side_by_side(void* block, std::size_t size) {
#ifdef MADV_POPULATE_WRITE
  constexpr std::uintptr_t kPart = std::uintptr_t(2) << 20;
  if (size < 4 * kPart || omp_in_parallel() != 0 || omp_get_max_threads() == 1 ||
      ::gettid() != ::getpid()) {
    return;
  }
  const auto at = reinterpret_cast<std::uintptr_t>(block);
  const std::uintptr_t first = at / kPart + 1, last = (at + size) / kPart;
#pragma omp parallel for schedule(static)
  for (std::uintptr_t part = first; part < last; ++part) {
    madvise(reinterpret_cast<void*>(part * kPart), kPart, MADV_POPULATE_WRITE);
  }
#endif
}

/// Address space that the program takes, bytes; 0 if the system does not tell. Allocates nothing.
double bytes_in_use() {
  const int file = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0.0;
  std::array<char, 64> text{};
  const ssize_t read = ::read(file, text.data(), text.size() - 1);
  ::close(file);
  return read > 0 ? std::strtod(text.data(), nullptr) * static_cast<double>(sysconf(_SC_PAGESIZE))
                  : 0.0;
}

/// The sentence into a buffer of the caller's, as there may be no memory for another.
template <std::size_t kSize>
void say_want(std::array<char, kSize>& text, std::size_t wanted) {
  constexpr double kMegabyte = 1e6;
  const double use = bytes_in_use() / kMegabyte;
  const double more = std::max(0.001, static_cast<double>(wanted) / kMegabyte);
  std::snprintf(text.data(), text.size(),
                "not enough memory: %.*f MB more were wanted beyond the %.0f MB in use; a smaller "
                "--grid takes less, terrane run --dry-run tells how much",
                more < 10.0 ? 3 : 0, more, use);
}

}  // namespace

void end_at_once(const char* message, int code) {
  static std::atomic_flag said = ATOMIC_FLAG_INIT;
  if (said.test_and_set()) {
    while (true) ::pause();
  }
  std::array<char, 512> line{};
  const int length =
      logs_json()
          ? std::snprintf(line.data(), line.size(),
                          R"({"time":%lld.0,"level":"error","message":"terrane: error: %s"})"
                          "\n",
                          static_cast<long long>(std::time(nullptr)), message)
          : std::snprintf(line.data(), line.size(), "terrane: error: %s\n", message);
  if (length > 0) {
    const auto size = std::min(line.size() - 1, static_cast<std::size_t>(length));
    [[maybe_unused]] const ssize_t told = ::write(STDERR_FILENO, line.data(), size);
  }
  ::_exit(code);
}

namespace {

[[noreturn]] void end_for_want_of(std::size_t wanted) {
  if (scratch_is_full()) end_at_once(scratch_error(), static_cast<int>(geo::ErrorKind::io));
  std::array<char, 256> text{};
  say_want(text, wanted);
  end_at_once(text.data(), static_cast<int>(geo::ErrorKind::configuration));
}

/// Pages below the stack that main stands on are asked for while there are some: a stack that
/// cannot grow ends a program by a signal.
void reserve_stack() {
  constexpr std::size_t kReserved = std::size_t(1) << 20, kPage = 4096;
  std::array<volatile char, kReserved> stack;
  for (std::size_t at = 0; at < kReserved; at += kPage) stack[at] = 0;
}

}  // namespace

void prepare_memory() {
  mallopt(M_MMAP_MAX, 0);
  constexpr int kKeptAtTheEnd = 2047 << 20;
  mallopt(M_TRIM_THRESHOLD, kKeptAtTheEnd);
  reserve_stack();
}

void give_back_memory() { malloc_trim(0); }

double available_memory_bytes() {
  double least =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  std::ifstream machine("/proc/meminfo");
  for (std::string word; machine >> word;) {
    double kibibytes = 0.0;
    if (word == "MemAvailable:" && machine >> kibibytes) least = std::min(least, 1024 * kibibytes);
  }
  const auto limit_by = [&](const std::string& path) {
    double limit = 0.0;
    if (std::ifstream(path) >> limit && limit > 0.0) least = std::min(least, limit);
  };
  limit_by("/sys/fs/cgroup/memory/memory.limit_in_bytes");
  // "0::/a/b": the group, within those that it is in.
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    if (!line.starts_with("0::/")) continue;
    for (std::string group = line.substr(3);; group.erase(group.find_last_of('/'))) {
      limit_by("/sys/fs/cgroup" + group + "/memory.max");
      if (group.empty()) break;
    }
  }
  rlimit data{};
  if (::getrlimit(RLIMIT_DATA, &data) == 0 && data.rlim_cur != RLIM_INFINITY) {
    least = std::min(least, static_cast<double>(data.rlim_cur));
  }
  return least;
}

std::string want_of_memory() {
  std::array<char, 256> text{};
  say_want(text, wanted_bytes.load());
  return text.data();
}

}  // namespace terrane

// A sanitizer has a heap of its own, which ends the program by itself.
#ifndef TERRANE_SANITIZED

extern "C" {
// The C library's own, under the names that it keeps for those who put theirs in front.
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {

void* allocate(std::size_t size) { return __libc_malloc(size); }

/// What the machine could never hold is the fault of who asks, a damaged file perhaps, and for that
/// one to tell.
bool is_sensible(std::size_t size) {
  static const double kMachine_bytes =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  return static_cast<double>(size) < kMachine_bytes;
}

void* checked(void* block, std::size_t size) {
  if (block == nullptr && size > 0 && is_sensible(size)) terrane::end_for_want_of(size);
  return block;
}

}  // namespace

/// What libraries written in C allocate with: few of them survive a refusal, and none tells it.
extern "C" void* malloc(std::size_t size) noexcept { return checked(__libc_malloc(size), size); }
extern "C" void* calloc(std::size_t count, std::size_t size) noexcept {
  std::size_t bytes = 0;
  if (__builtin_mul_overflow(count, size, &bytes)) return nullptr;
  return checked(__libc_calloc(count, size), bytes);
}
extern "C" void* realloc(void* block, std::size_t size) noexcept {
  return checked(__libc_realloc(block, size), size);
}
/// OpenMP's teams, for one.
extern "C" void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return checked(__libc_memalign(alignment, size), size);
}
extern "C" void* memalign(std::size_t alignment, std::size_t size) noexcept {
  return checked(__libc_memalign(alignment, size), size);
}
extern "C" int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  const bool is_power_of_two = alignment != 0 && (alignment & (alignment - 1)) == 0;
  if (!is_power_of_two || alignment % sizeof(void*) != 0) return EINVAL;
  void* const made = checked(__libc_memalign(alignment, size), size);
  if (made == nullptr) return ENOMEM;
  *block = made;
  return 0;
}

/// OpenMP cannot say that a thread could not begin but by its own words and exit code 1.
extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                              void* (*start)(void*), void* argument) noexcept {
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto kCreate = reinterpret_cast<Create>(::dlsym(RTLD_NEXT, "pthread_create"));
  const int refused = kCreate(thread, attributes, start, argument);
  if (refused == 0) return 0;
  std::size_t stack = 0;
  if (attributes == nullptr || pthread_attr_getstacksize(attributes, &stack) != 0) {
    pthread_attr_t usual;
    if (pthread_getattr_default_np(&usual) == 0) pthread_attr_getstacksize(&usual, &stack);
  }
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(),
                "could not begin a thread (%s): its stack wants %.0f MB of memory; --threads 1 "
                "needs fewer",
                std::strerror(refused), static_cast<double>(stack) / 1e6);
  terrane::end_at_once(text.data(), static_cast<int>(geo::ErrorKind::configuration));
}

/// What every container of the program allocates with. The array forms come here too.
void* operator new(std::size_t size) {
  while (true) {
    if (void* block = terrane::capped_block(size)) return block;
    if (void* block = terrane::lacks_scratch(size) ? nullptr : allocate(size == 0 ? 1 : size)) {
      terrane::prefer_large_pages(block, size);
      terrane::touch_side_by_side(block, size);
      return block;
    }
    if (const std::new_handler handler = std::get_new_handler()) {
      handler();
      continue;
    }
    if (!geo::ParallelErrors::is_carried()) terrane::end_for_want_of(size);
    terrane::wanted_bytes = size;
    throw std::bad_alloc();
  }
}
void operator delete(void* block) noexcept {
  if (!terrane::free_capped_block(block)) std::free(block);
}
void operator delete(void* block, std::size_t) noexcept { ::operator delete(block); }

#endif
