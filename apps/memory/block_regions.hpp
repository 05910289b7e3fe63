#pragma once

#include <cstddef>
#include <memory>
#include <mutex>

#include "page_ranges.hpp"
#include "page_store.hpp"

namespace terrane {

inline constexpr std::size_t kMebibyte = std::size_t(1) << 20;
/// Blocks from here up; smaller ones are the heap's.
inline constexpr std::size_t kLargeBlock = kMebibyte / 4;
/// Large blocks begin and end at these, so that neighbours share no page of any machine.
inline constexpr std::size_t kPage = std::size_t(64) << 10;
inline constexpr std::size_t kLargePage = 2 * kMebibyte;

/// One region of addresses with the parts of it that are in use.
struct Region {
  std::byte* base = nullptr;
  std::size_t size = 0, page = kPage;  ///< bytes of all, and of a page
  PageRanges ranges{0};
  std::size_t most_pages = 0;

  [[nodiscard]] bool has(const void* block) const { return block >= base && block < base + size; }
  [[nodiscard]] std::byte* at(std::size_t number) const { return base + number * page; }
  /// Pages that so many bytes take.
  [[nodiscard]] std::size_t pages_of(std::size_t bytes) const { return (bytes + page - 1) / page; }
};

/// Where large blocks lie while memory is capped: in memory of their own, and in the scratch
/// region, whose pages are elsewhere while they are not in memory.
struct Regions {
  std::mutex mutex;
  Region memory, scratch;
  std::size_t memory_limit_pages = 0;
  std::unique_ptr<PageStore> store;  ///< of the scratch region
};

/// Those of the program. Never destroyed: blocks are given back until its very end.
[[nodiscard]] Regions& regions();

/// [bytes, bytes + size) has memory from now on, of large pages where it spans such.
void take_memory(std::byte* bytes, std::size_t size) noexcept;

/// A block in a region; null where there is no room.
[[nodiscard]] void* block_in_memory(std::size_t size);
[[nodiscard]] void* block_in_scratch(std::size_t size);
/// Whether the scratch region ever had no room for a block.
[[nodiscard]] bool scratch_was_full() noexcept;

/// The pages of one free part leave memory. Returns whether there was one.
bool drop_one_free_of_memory();
bool drop_one_free_of_scratch();
/// Nothing is left elsewhere of one free part of the scratch region. Returns whether there was one.
bool forget_one_free(PageRanges::Trace trace);

}  // namespace terrane
