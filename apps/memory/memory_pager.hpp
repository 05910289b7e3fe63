#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <optional>

#include "repeating.hpp"

namespace terrane {

/// Keeps the cap. One thread looks how much is in memory and lets no more come than there is room
/// for; one sends pages away, which may have to wait for the disk or other ranks; one sees to the
/// room of free parts on the disk.
class MemoryPager {
 public:
  /// `clear_bytes`: kept clear below the cap for small blocks, which nobody asks room for.
  MemoryPager(std::size_t cap_bytes, std::size_t clear_bytes);
  ~MemoryPager();
  MemoryPager(const MemoryPager&) = delete;
  MemoryPager& operator=(const MemoryPager&) = delete;

  /// A block that has memory of its own takes it now, as there is room for it.
  void fill(void* block, std::size_t size);

 private:
  [[nodiscard]] std::size_t taken_bytes() const;
  void watch();
  /// Lets pages come as there is room for them.
  void look();
  /// Sends pages away in turn while too many are here.
  void make_room();
  /// Free parts that lie on the disk are used again, but not without end: the system would write
  /// what nobody reads.
  void cut() const;

  /// No page comes beyond `most_`; from `high_` on pages are sent away, until `low_`.
  const std::size_t most_, high_, low_;
  std::size_t hand_ = 0, most_on_disk_pages_ = 0;
  int statm_ = -1;
  std::atomic<bool> nothing_leaves_{false};  ///< a round over all pages has not made enough room
  std::chrono::steady_clock::time_point trimmed_;
  std::optional<Repeating> watching_, sending_, cutting_;
};

}  // namespace terrane
