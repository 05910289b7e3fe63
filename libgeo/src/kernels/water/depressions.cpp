#include "geo/kernels/water/depressions.hpp"

#include <omp.h>

#include <algorithm>

#include "catchments.hpp"
#include "geo/core/array_sizes.hpp"
#include "geo/core/work_array.hpp"

namespace geo {
namespace {

using detail::Catchments;
using detail::Pass;
using detail::Spill;

/// Which depression a leaf belongs to while unions form.
class Tops {
 public:
  explicit Tops(std::int32_t leaves) : link_(2 * static_cast<std::size_t>(leaves) + 1) {
    for (std::size_t s = 0; s < link_.size(); ++s) link_[s] = static_cast<std::int32_t>(s);
  }
  /// kSea, or the topmost depression above `depression`.
  std::int32_t top(std::int32_t depression) {
    std::int32_t at = depression + 1;
    while (link_[at] != at) at = link_[at] = link_[link_[at]];
    return at - 1;
  }
  void put_under(std::int32_t depression, std::int32_t parent) {
    link_[depression + 1] = parent + 1;
  }

 private:
  std::vector<std::int32_t> link_;  // shifted by one: the sea is 0
};

void seal(Depression& depression, const Pass& pass, bool a_is_inside, std::int32_t parent) {
  depression.sill_inside = a_is_inside ? pass.a : pass.b;
  depression.sill_outside = a_is_inside ? pass.b : pass.a;
  depression.spills_into = a_is_inside ? pass.leaf_b : pass.leaf_a;
  depression.sill_m = pass.elevation_m;
  depression.parent = parent;
}

/// Leaves and unions in order of their sills.
void build_unions(const Catchments& catchments, std::span<const Pass> passes,
                  std::span<const float> z, DepressionHierarchy& hierarchy) {
  auto& nodes = hierarchy.depressions;
  nodes.resize(catchments.pits.size());
  for (std::size_t leaf = 0; leaf < nodes.size(); ++leaf) nodes[leaf].pit = catchments.pits[leaf];
  Tops tops(hierarchy.leaves);
  for (const Pass& pass : passes) {
    const std::int32_t a = pass.leaf_a == kSea ? kSea : tops.top(pass.leaf_a);
    const std::int32_t b = pass.leaf_b == kSea ? kSea : tops.top(pass.leaf_b);
    if (a == kSea || b == kSea) {
      const std::int32_t inner = a == kSea ? b : a;
      seal(nodes[inner], pass, a != kSea, kSea);
      tops.put_under(inner, kSea);
      continue;
    }
    const auto parent = static_cast<std::int32_t>(nodes.size());
    seal(nodes[a], pass, true, parent);
    seal(nodes[b], pass, false, parent);
    Depression united;
    united.children[0] = a;
    united.children[1] = b;
    united.pit = z[nodes[b].pit] < z[nodes[a].pit] ? nodes[b].pit : nodes[a].pit;
    nodes.push_back(united);
    tops.put_under(a, parent);
    tops.put_under(b, parent);
  }
}

/// Finds the lowest ancestor whose sill stands above a level in O(log n) steps, however lopsided
/// the hierarchy: skew-binary jump pointers (Myers 1983).
class Ancestors {
 public:
  explicit Ancestors(const std::vector<Depression>& nodes)
      : nodes_(nodes), jump_(nodes.size()), depth_(nodes.size()) {
    for (auto at = static_cast<std::int32_t>(nodes.size()) - 1; at >= 0; --at) {
      const std::int32_t parent = nodes[at].parent;
      if (parent == kSea) {
        jump_[at] = kSea;
        continue;
      }
      depth_[at] = depth_[parent] + 1;
      const std::int32_t first = jump_[parent], second = first == kSea ? kSea : jump_[first];
      const bool level = first != kSea && second != kSea &&
                         depth_[parent] - depth_[first] == depth_[first] - depth_[second];
      jump_[at] = level ? second : parent;
    }
  }
  [[nodiscard]] std::int32_t lowest_above(std::int32_t at, float level) const {
    while (at != kSea && level >= nodes_[at].sill_m) {
      const std::int32_t jump = jump_[at];
      at = jump != kSea && level >= nodes_[jump].sill_m ? jump : nodes_[at].parent;
    }
    return at;
  }

 private:
  const std::vector<Depression>& nodes_;
  std::vector<std::int32_t> jump_, depth_;
};

/// Areas and volumes: each flooded cell counts for the lowest depression whose sill stands above
/// it, then children add to their parents.
void measure(const Grid& grid, std::span<const float> z, DepressionHierarchy& hierarchy) {
  auto& nodes = hierarchy.depressions;
  const Ancestors ancestors(nodes);
  WorkArray<std::int32_t> holder(grid.size());
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) {
    holder[cell] = ancestors.lowest_above(hierarchy.leaf_of_cell[cell], z[cell]);
  }
  std::vector<double> height_area_m3(nodes.size(), 0.0);
  // Each depression is left to one thread, which adds up in the order of cells: the same sums for
  // any number of threads.
  const int threads = std::max(1, omp_get_max_threads());
#pragma omp parallel for schedule(static, 1) num_threads(threads)
  for (int thread = 0; thread < threads; ++thread) {
    const auto first = static_cast<std::int32_t>(nodes.size() * thread / threads);
    const auto end = static_cast<std::int32_t>(nodes.size() * (thread + 1) / threads);
    for (int j = 0; j < grid.ny(); ++j) {
      const double area = grid.area_m2(j);
      for (Index cell = grid.cell(0, j); cell < grid.cell(0, j) + grid.nx(); ++cell) {
        if (holder[cell] < first || holder[cell] >= end) continue;
        nodes[holder[cell]].area_m2 += area;
        height_area_m3[holder[cell]] += area * z[cell];
      }
    }
  }
  for (std::size_t at = 0; at < nodes.size(); ++at) {  // children stand before parents
    Depression& node = nodes[at];
    node.volume_m3 = node.area_m2 * node.sill_m - height_area_m3[at];
    if (node.parent == kSea) continue;
    nodes[node.parent].area_m2 += node.area_m2;
    height_area_m3[node.parent] += height_area_m3[at];
  }
}

/// Receivers, catchments and spills of a surface: what filling and routing share.
struct Spills {
  std::vector<Index> receiver;
  Catchments catchments;
  std::vector<Spill> spill;

  Spills(const Grid& grid, std::span<const float> z, std::span<const std::uint8_t> outlets)
      : receiver(grid.size()) {
    steepest_receivers(grid, z, outlets, receiver);
    catchments = detail::find_catchments(grid, outlets, receiver);
    spill = detail::spill_seaward(static_cast<std::int32_t>(catchments.pits.size()),
                                  detail::spanning_passes(grid, z, outlets, catchments));
  }
  void fill(std::span<const float> z, std::span<float> filled_m) const {
#pragma omp parallel for schedule(static)
    for (std::size_t cell = 0; cell < z.size(); ++cell) {
      const std::int32_t leaf = catchments.leaf_of_cell[cell];
      filled_m[cell] = leaf == kSea ? z[cell] : std::max(z[cell], spill[leaf].level_m);
    }
  }
};

}  // namespace

DepressionHierarchy build_depression_hierarchy(const Grid& grid, std::span<const float> elevation_m,
                                               std::span<const std::uint8_t> outlets,
                                               std::span<const Index> receiver) {
  check_sizes("build_depression_hierarchy", grid.size(),
              {{"elevation_m", elevation_m.size()},
               {"outlets", outlets.size()},
               {"receiver", receiver.size()}});
  Catchments catchments = detail::find_catchments(grid, outlets, receiver);
  const std::vector<Pass> passes = detail::spanning_passes(grid, elevation_m, outlets, catchments);
  DepressionHierarchy hierarchy;
  hierarchy.leaves = static_cast<std::int32_t>(catchments.pits.size());
  build_unions(catchments, passes, elevation_m, hierarchy);
  hierarchy.leaf_of_cell = std::move(catchments.leaf_of_cell);
  measure(grid, elevation_m, hierarchy);
  return hierarchy;
}

Routing route_unordered(const Grid& grid, std::span<const float> elevation_m,
                        std::span<const std::uint8_t> outlets, bool want_filled) {
  check_sizes("route_water", grid.size(),
              {{"elevation_m", elevation_m.size()}, {"outlets", outlets.size()}});
  Spills spills(grid, elevation_m, outlets);
  Routing routing;
  auto& receiver = routing.graph.receiver;
  receiver = std::move(spills.receiver);
#pragma omp parallel for schedule(dynamic, 1024)
  for (std::size_t leaf = 0; leaf < spills.spill.size(); ++leaf) {
    detail::reverse_path(spills.spill[leaf].inside, spills.spill[leaf].outside, receiver);
  }
  if (want_filled) {
    routing.filled_m.resize(grid.size());
    spills.fill(elevation_m, routing.filled_m);
  }
  return routing;
}

Routing route_water(const Grid& grid, std::span<const float> elevation_m,
                    std::span<const std::uint8_t> outlets, bool want_filled) {
  Routing routing = route_unordered(grid, elevation_m, outlets, want_filled);
  routing.graph.put_in_order();
  return routing;
}

void fill_depressions(const Grid& grid, std::span<const float> elevation_m,
                      std::span<const std::uint8_t> outlets, std::span<float> filled_m) {
  check_sizes("fill_depressions", grid.size(),
              {{"elevation_m", elevation_m.size()},
               {"outlets", outlets.size()},
               {"filled_m", filled_m.size()}});
  Spills(grid, elevation_m, outlets).fill(elevation_m, filled_m);
}

}  // namespace geo
