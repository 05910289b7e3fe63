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
  /// Pages of blocks in use leave memory. They come back when they are touched.
  virtual void send_away(PageRanges::Range range) = 0;
  /// Pages of a free part leave memory. Returns what may be left of them elsewhere.
  virtual PageRanges::Trace drop(PageRanges::Range range) = 0;
  /// Nothing of a free part is left anywhere.
  virtual void forget(PageRanges::Range range) = 0;
  /// Whether pages come only as `allow` lets them: so many bytes until it is said anew.
  [[nodiscard]] virtual bool asks_for_room() const { return false; }
  virtual void allow(std::size_t bytes) { static_cast<void>(bytes); }
  /// Kept clear below a cap for what comes until the next look.
  [[nodiscard]] virtual std::size_t least_clear_bytes(std::size_t cap_bytes) const = 0;
};

}  // namespace terrane
