#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

namespace terrane {

class MemoryPager;

/// Keeps the memory that the program has resident below a cap, from its construction to its end.
///
/// Large blocks then lie in a region of addresses of their own. Up to two fifths of the cap
/// they have memory as usual; the rest is mapped from a scratch file, whose room on the disk is
/// reserved block by block. A thread looks every millisecond how much is resident. Near the cap it
/// drops pages of freed blocks and then, going round, those of the scratch file: a dropped page
/// stays in the system's cache of files as long as the machine has memory to spare, on the disk
/// otherwise, and comes back when it is touched. Nothing of this changes what a kernel reads or
/// writes.
///
/// The scratch file has no name and ends with the program, however that ends. One at a time; blocks
/// may outlive it.
class MemoryCap {
 public:
  /// `folder`, or the nearest one above it that exists, takes the scratch file. Throws IoError
  /// where it cannot.
  MemoryCap(double cap_bytes, const std::filesystem::path& folder);
  ~MemoryCap();
  MemoryCap(const MemoryCap&) = delete;
  MemoryCap& operator=(const MemoryCap&) = delete;

  /// The most that was in the scratch file at a time.
  [[nodiscard]] double scratch_bytes() const;

 private:
  std::unique_ptr<MemoryPager> pager_;
};

/// The most that this process ever had resident; 0 if the system does not tell.
double peak_resident_bytes();

/// What a run that takes so much without a cap takes under one: of memory, and of the scratch file.
struct MemoryUnderCap {
  double resident_bytes = 0.0, scratch_bytes = 0.0;
};
MemoryUnderCap memory_under_cap(double cap_bytes, double uncapped_bytes);

/// A large block while memory is capped. Null for blocks that are none of its own, which come from
/// the heap, and where there is no room.
void* capped_block(std::size_t size) noexcept;
/// Gives such a block back; false for any other.
bool free_capped_block(void* block) noexcept;
/// Whether the scratch file had no room for a block, and what to say then.
bool scratch_is_full() noexcept;
/// The same of a block of this size, which is not to come from the heap then.
bool lacks_scratch(std::size_t size) noexcept;
const char* scratch_error() noexcept;

}  // namespace terrane
