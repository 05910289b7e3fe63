#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Cells by height, and those of one height by number, where none is put in that is lower than the
/// last one taken out, unless it is empty: a radix heap (Ahuja et al. 1990), whose entries move at
/// most 32 times, from list to list. Heights are not negative, so that their bits ascend as they
/// do. The order is that of any priority queue of pairs.
class MonotoneQueue {
 public:
  [[nodiscard]] bool empty() const { return size_ == 0; }
  void push(float height, Index cell) {
    if (size_ == 0) lowest_ = 0;
    put({std::bit_cast<std::uint32_t>(height + 0.0F), cell});  // -0 is 0
    ++size_;
  }
  /// The lowest. Not of an empty queue.
  std::pair<float, Index> pop() {
    if (level_.empty()) refill();
    std::pop_heap(level_.begin(), level_.end(), std::greater<>());
    const Index cell = level_.back();
    level_.pop_back();
    --size_;
    return {std::bit_cast<float>(lowest_), cell};
  }

 private:
  struct Entry {
    std::uint32_t key;
    Index cell;
  };

  void put(const Entry& entry) {
    const int differs = std::bit_width(entry.key ^ lowest_);
    if (differs > 0) {
      higher_[static_cast<std::size_t>(differs) - 1].push_back(entry);
      return;
    }
    level_.push_back(entry.cell);
    std::push_heap(level_.begin(), level_.end(), std::greater<>());
  }
  /// The lowest list has a new least key, from which its entries all differ in lower bits.
  void refill() {
    const auto list = std::find_if(higher_.begin(), higher_.end(),
                                   [](const auto& entries) { return !entries.empty(); });
    lowest_ = std::min_element(list->begin(), list->end(), [](const Entry& a, const Entry& b) {
                return a.key < b.key;
              })->key;
    moving_.swap(*list);
    for (const Entry& entry : moving_) put(entry);
    moving_.clear();
  }

  std::uint32_t lowest_ = 0;
  std::size_t size_ = 0;
  std::vector<Index> level_;                   ///< a heap of those at the lowest height
  std::array<std::vector<Entry>, 32> higher_;  ///< by the highest bit in which they differ from it
  std::vector<Entry> moving_;
};

}  // namespace geo
