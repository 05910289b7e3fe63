#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/landscape/plastic_ice.hpp"

namespace geo {

/// What flows from a region into cells that are away, in the order in which it does: margins may be
/// shared with other regions.
using MarginInflow = std::vector<std::pair<Index, double>>;

/// Calls `visit(region)` for each of `regions` regions that begin at `begins`, the largest first,
/// on as many threads as there are. Threads write what belongs to their region alone.
template <class Visit>
void visit_regions(std::span<const std::size_t> begins, Visit&& visit) {
  if (begins.size() < 2) return;
  std::vector<std::size_t> region(begins.size() - 1);
  std::iota(region.begin(), region.end(), std::size_t{0});
  std::stable_sort(region.begin(), region.end(), [&](std::size_t a, std::size_t b) {
    return begins[a + 1] - begins[a] > begins[b + 1] - begins[b];
  });
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t k = 0; k < region.size(); ++k) errors.guard([&] { visit(region[k]); });
  errors.rethrow();
}

/// The cells of a region, lowest first.
[[nodiscard]] inline std::span<const Index> cells_of(const IceSurface& surface,
                                                     std::size_t region) {
  const std::size_t begin = surface.region_begins[region];
  return std::span(surface.order).subspan(begin, surface.region_begins[region + 1] - begin);
}

}  // namespace geo
