#pragma once

#include <cstddef>
#include <mutex>

#include "page_ranges.hpp"

namespace terrane {

inline constexpr std::size_t kMebibyte = std::size_t(1) << 20;
/// Blocks from here up; smaller ones are the heap's.
inline constexpr std::size_t kLargeBlock = kMebibyte / 4;
/// Large blocks begin and end at these, so that neighbours share no page of any machine.
inline constexpr std::size_t kPage = std::size_t(64) << 10;
inline constexpr std::size_t kLargePage = 2 * kMebibyte;

/// Pages that so many bytes take.
[[nodiscard]] inline std::size_t pages_of(std::size_t bytes) { return (bytes + kPage - 1) / kPage; }

/// One region of addresses with the parts of it that are in use.
struct Region {
  std::byte* base = nullptr;
  std::size_t size = 0;
  PageRanges ranges{0};
  std::size_t most_pages = 0;

  [[nodiscard]] bool has(const void* block) const { return block >= base && block < base + size; }
  [[nodiscard]] std::byte* at(std::size_t page) const { return base + page * kPage; }
};

/// Where large blocks lie while memory is capped: in memory of their own, and in a scratch file.
struct Regions {
  std::mutex mutex;
  Region memory, scratch;
  std::size_t memory_limit_pages = 0;
  int file = -1;  ///< the scratch file
};

/// Those of the program. Never destroyed: blocks are given back until its very end.
[[nodiscard]] Regions& regions();

/// A block in a region; null where there is no room.
[[nodiscard]] void* block_in_memory(std::size_t size);
[[nodiscard]] void* block_in_scratch(std::size_t size);
/// Whether the scratch file ever had no room for a block.
[[nodiscard]] bool scratch_was_full() noexcept;

/// The pages of one free part leave memory; those of the scratch file stay on the disk for the next
/// block. Returns whether there was one.
bool drop_one_free(Region& region, PageRanges::Trace left);
/// One free part of the scratch file leaves the disk. Returns whether there was one.
bool cut_one_free(PageRanges::Trace trace);

}  // namespace terrane
