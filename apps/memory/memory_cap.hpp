#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

namespace terrane {

class MemoryPager;
class RankMessages;
class RemotePages;

/// Keeps the memory that the program has resident below a cap, from its construction to its end.
///
/// Large blocks then lie in a region of addresses of their own. Up to two fifths of the cap, or
/// seven tenths of one that holds most of what is wanted, they have memory as usual; the rest lies
/// in pages that can be elsewhere: in a scratch file, whose room on the disk is reserved block by
/// block, or with the other ranks of the job. Near the cap one thread drops pages of freed blocks
/// and then, going round, sends away those that can be elsewhere: what did not change since it came
/// from the file need not be written. A page that is not here comes when it is touched, once there
/// is room for it below the cap: whoever touches it waits. One comes from the system's cache of
/// files as long as the machine has memory to spare, from the disk, from its rank. Nothing of this
/// changes what a kernel reads or writes.
///
/// The scratch file has no name and ends with the program, however that ends. One cap at a time;
/// blocks may outlive it.
class MemoryCap {
 public:
  /// `folder`, or the nearest one above it that exists, takes the scratch file. Throws IoError
  /// where it cannot.
  MemoryCap(double cap_bytes, const std::filesystem::path& folder);
  /// What does not fit is kept by the other ranks, which must be serving pages.
  /// `uncapped_bytes`: what the run takes without a cap; pages are as large as that many need.
  MemoryCap(double cap_bytes, RankMessages& ranks, double uncapped_bytes);
  ~MemoryCap();
  /// What the run takes without a cap, as soon as that is known: of a cap that holds most of it,
  /// more is memory as usual.
  void expect(double uncapped_bytes);
  MemoryCap(const MemoryCap&) = delete;
  MemoryCap& operator=(const MemoryCap&) = delete;

  /// The most that was in the scratch region at a time.
  [[nodiscard]] double scratch_bytes() const;
  /// What went to other ranks and came back.
  [[nodiscard]] double exchanged_bytes() const;

 private:
  void begin(double cap_bytes, double clear_bytes);

  double cap_bytes_ = 0.0;
  std::unique_ptr<MemoryPager> pager_;
  const RemotePages* remote_ = nullptr;
};

/// The most that this process ever had resident; 0 if the system does not tell.
double peak_resident_bytes();

/// What a run that takes so much without a cap takes under one: of memory, of the scratch region,
/// and of time, in times of that without, on a machine that has so much memory to spare.
struct MemoryUnderCap {
  double resident_bytes = 0.0, scratch_bytes = 0.0, times_as_long = 1.0;
};
MemoryUnderCap memory_under_cap(double cap_bytes, double uncapped_bytes, double available_bytes);

/// The cap of each of so many ranks for a run that takes so much without one.
double cap_of_rank(double uncapped_bytes, int ranks);

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
