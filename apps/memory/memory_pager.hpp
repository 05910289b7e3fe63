#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <mutex>
#include <optional>

#include "repeating.hpp"

namespace terrane {

/// Kept clear below the cap for what is touched until the next look.
[[nodiscard]] double least_clear_bytes(double cap_bytes);

/// Keeps the cap: one thread for pages in memory, one for the room of free parts on the disk, which
/// may have to wait for it.
class MemoryPager {
 public:
  explicit MemoryPager(std::size_t cap_bytes);
  ~MemoryPager();
  MemoryPager(const MemoryPager&) = delete;
  MemoryPager& operator=(const MemoryPager&) = delete;

  /// Drops pages if too many are in memory. Whoever comes while another drops need not wait.
  void look();

 private:
  /// What of this process is in memory.
  struct Resident {
    std::size_t own = 0, of_files = 0;
  };
  [[nodiscard]] Resident resident() const;
  /// What is in memory, and what will be once all blocks that have memory of their own are touched:
  /// that goes faster than anybody could look.
  [[nodiscard]] std::size_t taken_bytes() const;
  [[nodiscard]] std::size_t least_clear() const;
  void drop_until_low(std::size_t taken);
  /// That it came late once says less and less of now.
  void forget();
  void keep_clear(std::size_t margin);
  /// Pages of the scratch file in turn. False when all were, and it was not enough.
  bool drop_round();
  /// Free parts that lie on the disk are used again, but not without end: the system would write
  /// what nobody reads.
  void cut() const;

  const std::size_t cap_;
  std::atomic<std::size_t> high_{0}, low_{0};
  std::size_t hand_ = 0, own_at_first_ = 0, most_on_disk_pages_ = 0;
  int statm_ = -1;
  std::chrono::steady_clock::time_point trimmed_;
  std::mutex dropping_;
  std::optional<Repeating> watching_, cutting_;
};

}  // namespace terrane
