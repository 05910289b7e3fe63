#pragma once

#include <cstddef>

#include "page_ranges.hpp"

namespace terrane {

/// Where pages of the scratch region are while they are not in memory: in a file, or with the
/// other ranks of the job. Ranges are numbers of pages in the region. For several threads at once.
class PageStore {
 public:
  PageStore() = default;
  virtual ~PageStore() = default;
  PageStore(const PageStore&) = delete;
  PageStore& operator=(const PageStore&) = delete;

  /// Room for a block that is handed out; false where there is none left.
  virtual bool reserve(PageRanges::Range range) = 0;
  /// Pages of blocks in use leave memory, after they were written elsewhere where they changed.
  /// They come back when they are touched.
  virtual void send_away(PageRanges::Range range) = 0;
  /// Pages of a free part leave memory. Returns what may be left of them elsewhere.
  virtual PageRanges::Trace drop(PageRanges::Range range) = 0;
  /// Nothing of a free part is left anywhere.
  virtual void forget(PageRanges::Range range) = 0;
  /// So many bytes of pages may come until it is said anew; whoever touches more waits. What is
  /// still on its way counts.
  virtual void allow(std::size_t bytes) = 0;
  /// The same wait for what comes to lie outside the region; and it is there.
  virtual void wait_for_room(std::size_t bytes) noexcept = 0;
  virtual void have_come(std::size_t bytes) noexcept = 0;
};

}  // namespace terrane
