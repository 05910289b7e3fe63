#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Some of the cells 0 to n - 1, each with its place among them in ascending order. Takes a bit and
/// a half per cell of the n; a place is found in constant time.
class CellSet {
 public:
  CellSet() = default;
  /// Those of `cells` cells for which `holds` is true, which all threads ask.
  template <class Holds>
  CellSet(Index cells, Holds&& holds)
      : words_(static_cast<std::size_t>(cells) / kBits + 1), before_(words_.size()), cells_(cells) {
    constexpr std::size_t kMany = 1000;
#pragma omp parallel for schedule(static) if (words_.size() >= kMany)
    for (std::size_t w = 0; w < words_.size(); ++w) {
      const auto first = static_cast<Index>(w * kBits);
      const Index end = std::min(cells, static_cast<Index>(first + static_cast<Index>(kBits)));
      for (Index cell = first; cell < end; ++cell) {
        if (holds(cell)) words_[w] |= bit(cell);
      }
    }
    for (std::size_t w = 0; w < words_.size(); ++w) {
      before_[w] = static_cast<std::uint32_t>(size_);
      size_ += static_cast<std::size_t>(std::popcount(words_[w]));
    }
  }

  /// How many cells are in the set, and of how many.
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] Index cells() const noexcept { return cells_; }
  [[nodiscard]] bool holds(Index cell) const noexcept {
    return (words_[word(cell)] & bit(cell)) != 0;
  }
  /// How many cells of the set stand before a cell.
  [[nodiscard]] std::size_t place(Index cell) const noexcept {
    const std::uint64_t earlier = words_[word(cell)] & (bit(cell) - 1);
    return before_[word(cell)] + static_cast<std::size_t>(std::popcount(earlier));
  }
  /// Calls `visit` with each cell of the set, in ascending order.
  template <class Visit>
  void visit(Visit&& visit) const {
    for (std::size_t w = 0; w < words_.size(); ++w) {
      for (std::uint64_t rest = words_[w]; rest != 0; rest &= rest - 1) {
        visit(static_cast<Index>(w * kBits + static_cast<std::size_t>(std::countr_zero(rest))));
      }
    }
  }

 private:
  static constexpr std::size_t kBits = 64;
  static std::size_t word(Index cell) noexcept { return static_cast<std::size_t>(cell) / kBits; }
  static std::uint64_t bit(Index cell) noexcept {
    return std::uint64_t{1} << (static_cast<std::size_t>(cell) % kBits);
  }

  std::vector<std::uint64_t> words_;
  std::vector<std::uint32_t> before_;
  std::size_t size_ = 0;
  Index cells_ = 0;
};

/// A value for each cell of a set, and one that all others have.
template <class T>
class SparseValues {
 public:
  SparseValues() = default;
  /// All cells begin with `elsewhere`.
  explicit SparseValues(std::shared_ptr<const CellSet> set, T elsewhere = T{})
      : set_(std::move(set)), values_(set_->size(), elsewhere), elsewhere_(elsewhere) {}

  [[nodiscard]] const std::shared_ptr<const CellSet>& set() const noexcept { return set_; }
  /// Cells with and without a value of their own.
  [[nodiscard]] Index cells() const noexcept { return set_ ? set_->cells() : 0; }
  [[nodiscard]] T operator[](Index cell) const noexcept {
    return set_->holds(cell) ? values_[set_->place(cell)] : elsewhere_;
  }
  /// The value of a cell of the set.
  [[nodiscard]] T& of(Index cell) noexcept { return values_[set_->place(cell)]; }
  [[nodiscard]] const T& of(Index cell) const noexcept { return values_[set_->place(cell)]; }
  /// The same by the cell's place in the set.
  [[nodiscard]] T& at(std::size_t place) noexcept { return values_[place]; }
  [[nodiscard]] const T& at(std::size_t place) const noexcept { return values_[place]; }
  /// Those of all cells.
  [[nodiscard]] std::vector<T> on_cells() const {
    std::vector<T> all(static_cast<std::size_t>(cells()), elsewhere_);
    set_->visit([&](Index cell) { all[cell] = of(cell); });
    return all;
  }

 private:
  std::shared_ptr<const CellSet> set_;
  std::vector<T> values_;
  T elsewhere_{};
};

}  // namespace geo
