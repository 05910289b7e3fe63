#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace terrane {

/// Which parts of a long range of pages are in use. Knows no addresses. Free parts are told apart
/// by what their pages may still take; those that take most are used again first. Not for several
/// threads at once.
class PageRanges {
 public:
  struct Range {
    std::size_t first = 0, pages = 0;
  };
  /// Of a free part: its pages may be in memory; on the disk alone; nowhere.
  enum class Trace { memory, disk, none };

  explicit PageRanges(std::size_t pages) : end_(pages) {}

  /// The smallest free part that is large enough; nothing when there is none.
  std::optional<Range> take(std::size_t pages);
  /// Gives back what began at `first`: a free part with pages in memory.
  void give(std::size_t first);
  /// Takes the largest free part of a kind, to be given back by `put`; nothing when there is none.
  std::optional<Range> pull(Trace trace);
  void put(Range range, Trace trace);

  [[nodiscard]] std::size_t pages_in_use() const { return in_use_; }
  [[nodiscard]] std::size_t free_pages(Trace trace) const { return free(trace).pages; }
  /// Behind the last page that was ever taken.
  [[nodiscard]] std::size_t reach() const { return reach_; }

 private:
  /// Free parts by place and by size; neighbours are joined.
  struct Free {
    std::map<std::size_t, std::size_t> by_place;
    std::set<std::pair<std::size_t, std::size_t>> by_size;
    std::size_t pages = 0;

    void add(Range range);
    void remove(Range range);
    std::optional<Range> take(std::size_t wanted);
  };
  [[nodiscard]] Free& free(Trace trace) { return free_[static_cast<std::size_t>(trace)]; }
  [[nodiscard]] const Free& free(Trace trace) const {
    return free_[static_cast<std::size_t>(trace)];
  }

  std::array<Free, 3> free_;
  std::map<std::size_t, std::size_t> used_;
  std::size_t end_, reach_ = 0, in_use_ = 0;
};

}  // namespace terrane
