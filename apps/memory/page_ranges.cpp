#include "page_ranges.hpp"

namespace terrane {

void PageRanges::Free::remove(Range range) {
  by_place.erase(range.first);
  by_size.erase({range.pages, range.first});
  pages -= range.pages;
}

void PageRanges::Free::add(Range range) {
  const auto next = by_place.lower_bound(range.first);
  if (next != by_place.end() && next->first == range.first + range.pages) {
    const Range joined{next->first, next->second};
    remove(joined);
    range.pages += joined.pages;
  }
  const auto behind = by_place.lower_bound(range.first);
  if (behind != by_place.begin()) {
    const auto before = std::prev(behind);
    const Range joined{before->first, before->second};
    if (joined.first + joined.pages == range.first) {
      remove(joined);
      range = {joined.first, joined.pages + range.pages};
    }
  }
  by_place.emplace(range.first, range.pages);
  by_size.emplace(range.pages, range.first);
  pages += range.pages;
}

std::optional<PageRanges::Range> PageRanges::Free::take(std::size_t wanted) {
  const auto at = by_size.lower_bound({wanted, 0});
  if (at == by_size.end()) return {};
  const Range whole{at->second, at->first};
  remove(whole);
  if (whole.pages > wanted) add({whole.first + wanted, whole.pages - wanted});
  return Range{whole.first, wanted};
}

std::optional<PageRanges::Range> PageRanges::take(std::size_t pages) {
  std::optional<Range> range;
  for (Free& parts : free_) {
    if (!range) range = parts.take(pages);
  }
  if (!range) {
    if (pages > end_ - reach_) return {};
    range = Range{reach_, pages};
    reach_ += pages;
  }
  used_.emplace(range->first, range->pages);
  in_use_ += pages;
  return range;
}

void PageRanges::give(std::size_t first) {
  const auto at = used_.find(first);
  const Range range{at->first, at->second};
  used_.erase(at);
  in_use_ -= range.pages;
  put(range, Trace::memory);
}

std::optional<PageRanges::Range> PageRanges::pull(Trace trace) {
  Free& parts = free(trace);
  if (parts.by_size.empty()) return {};
  const auto& [pages, first] = *parts.by_size.rbegin();
  const Range range{first, pages};
  parts.remove(range);
  return range;
}

void PageRanges::put(Range range, Trace trace) { free(trace).add(range); }

}  // namespace terrane
