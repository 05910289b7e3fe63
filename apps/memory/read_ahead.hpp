#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "page_ranges.hpp"

namespace terrane {

/// Tells which pages will be wanted after one: whoever reads along a field in either direction
/// wants the next, and twice as many each time, up to a limit. Several such ways are kept in mind
/// at once. Not for several threads.
class ReadAhead {
 public:
  explicit ReadAhead(std::size_t most = kMost) : most_(most) {}

  /// The pages to bring when one of `all` is wanted, itself among them.
  PageRanges::Range around(std::size_t page, std::size_t all) {
    for (Way& way : ways_) {
      if (page != way.up && page + 1 != way.down) continue;
      const bool upwards = page == way.up;
      way.pages = std::min(most_, 2 * way.pages);
      const std::size_t first = upwards ? page : page + 1 - std::min(way.pages, page + 1);
      const std::size_t end = upwards ? std::min(all, page + way.pages) : page + 1;
      (upwards ? way.up : way.down) = upwards ? end : first;
      return {first, end - first};
    }
    ways_[next_++ % ways_.size()] = {page + 1, page, 1};
    return {page, 1};
  }

 private:
  static constexpr std::size_t kMost = 16;
  /// What was brought lies before page `up` and from page `down` on.
  struct Way {
    std::size_t up = 0, down = 0, pages = 0;
  };
  std::array<Way, 32> ways_{};
  std::size_t most_, next_ = 0;
};

}  // namespace terrane
