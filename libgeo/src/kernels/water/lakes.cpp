#include "geo/kernels/water/lakes.hpp"

#include <omp.h>

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "catchments.hpp"
#include "geo/core/array_sizes.hpp"
#include "geo/core/parallel_errors.hpp"

namespace geo {
namespace {

using Number = std::int32_t;

constexpr int kMostThreads = 255;  // their numbers are kept in bytes

/// Sums over ranges of a line of numbers that change one at a time (Fenwick 1994).
class RangeSums {
 public:
  explicit RangeSums(std::size_t size) : sum_(size + 1, 0.0) {}
  void add(std::size_t position, double value) {
    for (std::size_t at = position + 1; at < sum_.size(); at += at & -at) sum_[at] += value;
  }
  [[nodiscard]] double between(std::size_t begin, std::size_t end) const {
    return below(end) - below(begin);
  }

 private:
  [[nodiscard]] double below(std::size_t end) const {
    double total = 0.0;
    for (std::size_t at = end; at > 0; at -= at & -at) total += sum_[at];
    return total;
  }
  std::vector<double> sum_;
};

/// The hierarchy with its leaves laid out in a line, so that each depression is a range of it.
class Balance {
 public:
  Balance(const Grid& grid, std::span<const float> z, const DepressionHierarchy& hierarchy,
          std::span<const double> runoff, std::span<const float> loss)
      : grid_(grid),
        z_(z),
        hierarchy_(hierarchy),
        nodes_(hierarchy.depressions),
        loss_(loss),
        inflow_(nodes_.size(), 0.0),
        capacity_(nodes_.size(), 0.0),
        begin_(nodes_.size(), 0),
        end_(nodes_.size(), 0),
        spilled_(hierarchy.leaves) {
    lay_out();
    gather(runoff);
    result_.lake_of_leaf.assign(hierarchy.leaves, -1);
    result_.exit_of_leaf.resize(hierarchy.leaves);
  }

  Lakes solve() {
    for (const Number tree : trees_upstream_first()) {
      const double water = inflow(tree);
      if (water > capacity_[tree]) {
        overflow(tree, water);
      } else {
        settle(tree);
      }
    }
    flood_endorheic();
    return std::move(result_);
  }

 private:
  void lay_out() {
    const auto count = static_cast<Number>(nodes_.size());
    for (Number n = 0; n < count; ++n) {
      if (n < hierarchy_.leaves) end_[n] = 1;  // sizes first
      if (nodes_[n].parent != kSea) end_[nodes_[n].parent] += end_[n];
    }
    leaf_at_.resize(hierarchy_.leaves);
    Number next = 0;
    for (Number n = count; n-- > 0;) {
      if (nodes_[n].parent == kSea) {
        begin_[n] = next;
        next += end_[n];
      }
      if (n < hierarchy_.leaves) {
        leaf_at_[begin_[n]] = n;
      } else {
        begin_[nodes_[n].children[0]] = begin_[n];
        begin_[nodes_[n].children[1]] = begin_[n] + end_[nodes_[n].children[0]];
      }
      end_[n] += begin_[n];
    }
    tree_of_leaf_.resize(hierarchy_.leaves);
    for (Number n = 0; n < count; ++n) {
      if (nodes_[n].parent != kSea) continue;
      for (Number p = begin_[n]; p < end_[n]; ++p) tree_of_leaf_[leaf_at_[p]] = n;
    }
  }

  /// Lowest depression that floods the cell when full, kSea if none does.
  [[nodiscard]] Number flooding(Index cell, Number leaf) const {
    if (z_[cell] >= nodes_[tree_of_leaf_[leaf]].sill_m) return kSea;
    while (z_[cell] >= nodes_[leaf].sill_m) leaf = nodes_[leaf].parent;
    return leaf;
  }

  /// About as many leaves to each thread.
  [[nodiscard]] std::vector<std::uint8_t> share_out(int threads) const {
    std::vector<std::uint8_t> thread_of_leaf(hierarchy_.leaves);
    for (std::size_t leaf = 0; leaf < thread_of_leaf.size(); ++leaf) {
      const auto place = static_cast<std::size_t>(begin_[tree_of_leaf_[leaf]]);
      thread_of_leaf[leaf] = static_cast<std::uint8_t>(place * threads / thread_of_leaf.size());
    }
    return thread_of_leaf;
  }

  void gather(std::span<const double> runoff) {
    // Each tree of depressions is left to one thread, which adds up in the order of cells: the same
    // sums for any number of threads.
    const int threads = std::clamp(omp_get_max_threads(), 1, kMostThreads);
    const std::vector<std::uint8_t> thread_of_leaf = share_out(threads);
#pragma omp parallel for schedule(static, 1) num_threads(threads)
    for (int thread = 0; thread < threads; ++thread) {
      for (Index cell = 0; cell < grid_.size(); ++cell) {
        const Number leaf = hierarchy_.leaf_of_cell[cell];
        if (leaf == kSea || thread_of_leaf[leaf] != thread) continue;
        inflow_[leaf] += runoff[cell];
        const Number at = flooding(cell, leaf);
        if (at != kSea) capacity_[at] += loss_[cell];
      }
    }
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      if (nodes_[n].parent == kSea) continue;
      inflow_[nodes_[n].parent] += inflow_[n];
      capacity_[nodes_[n].parent] += capacity_[n];
    }
  }

  [[nodiscard]] std::vector<Number> trees_upstream_first() const {
    std::vector<Index> next(nodes_.size());
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      const bool to_tree = nodes_[n].parent == kSea && nodes_[n].spills_into != kSea;
      next[n] = to_tree ? tree_of_leaf_[nodes_[n].spills_into] : static_cast<Index>(n);
    }
    std::vector<Number> trees;
    for (const Index n : downstream_order(next)) {
      if (nodes_[n].parent == kSea) trees.push_back(n);
    }
    return trees;
  }

  [[nodiscard]] double inflow(Number n) const {
    return inflow_[n] + spilled_.between(begin_[n], end_[n]);
  }

  /// A full depression: one lake up to its sill, the rest goes beyond.
  void overflow(Number n, double water) {
    const Depression& node = nodes_[n];
    add_lake(n, {n, node.pit, node.sill_inside, node.sill_m, water, capacity_[n]});
    const Number last = hierarchy_.leaf_of_cell[node.sill_inside];
    result_.exit_of_leaf[last] = {node.sill_inside, node.sill_outside};
    lead(n, last);
    if (node.spills_into != kSea) {
      spilled_.add(begin_[node.spills_into], water - capacity_[n]);
    }
  }

  /// A depression that keeps its water: finds the lakes in which it stands.
  void settle(Number top) {
    std::vector<Number> open{top};
    while (!open.empty()) {
      const Number n = open.back();
      open.pop_back();
      if (n < hierarchy_.leaves) {
        keep(n, inflow(n));
        continue;
      }
      Number a = nodes_[n].children[0], b = nodes_[n].children[1];
      double water_a = inflow(a), water_b = inflow(b);
      if (water_b > capacity_[b]) {
        std::swap(a, b);
        std::swap(water_a, water_b);
      }
      if (water_a <= capacity_[a]) {  // neither is full
        open.push_back(b);
        open.push_back(a);
      } else if (water_b + (water_a - capacity_[a]) > capacity_[b]) {  // both are: they unite
        keep(n, water_a + water_b);
      } else {
        overflow(a, water_a);
        open.push_back(b);
      }
    }
  }

  /// The end of an endorheic basin, with a lake if any water comes.
  void keep(Number n, double water) {
    lead(n, hierarchy_.leaf_of_cell[nodes_[n].pit]);
    if (water > 0) add_lake(n, {n, nodes_[n].pit, kNoCell, nodes_[n].sill_m, water, water});
  }

  /// Leads the leaves of a depression to one of them, over the passes between its children.
  void lead(Number top, Number to_leaf) {
    std::vector<std::pair<Number, Number>> open{{top, to_leaf}};
    while (!open.empty()) {
      const auto [n, to] = open.back();
      open.pop_back();
      if (n < hierarchy_.leaves) continue;
      Number near = nodes_[n].children[0], far = nodes_[n].children[1];
      if (begin_[to] < begin_[near] || begin_[to] >= end_[near]) std::swap(near, far);
      const Depression& beyond = nodes_[far];
      const Number last = hierarchy_.leaf_of_cell[beyond.sill_inside];
      result_.exit_of_leaf[last] = {beyond.sill_inside, beyond.sill_outside};
      open.emplace_back(near, to);
      open.emplace_back(far, last);
    }
  }

  void add_lake(Number n, const Lake& lake) {
    const auto number = static_cast<Number>(result_.lakes.size());
    for (Number p = begin_[n]; p < end_[n]; ++p) result_.lake_of_leaf[leaf_at_[p]] = number;
    result_.lakes.push_back(lake);
    result_.lakes.back().area_m2 = lake.outlet == kNoCell ? 0.0 : nodes_[n].area_m2;
  }

  /// Cells that an endorheic lake would flood if it were full, in their order, each with its lake.
  [[nodiscard]] std::vector<std::pair<Number, Index>> cells_below_sills() const {
    std::vector<std::vector<std::pair<Number, Index>>> of_row(grid_.ny());
    ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 16)
    for (int j = 0; j < grid_.ny(); ++j) {
      errors.guard([&] {
        for (Index cell = grid_.cell(0, j); cell < grid_.cell(0, j) + grid_.nx(); ++cell) {
          const Number leaf = hierarchy_.leaf_of_cell[cell];
          const Number lake = leaf == kSea ? -1 : result_.lake_of_leaf[leaf];
          if (lake < 0 || result_.lakes[lake].outlet != kNoCell) continue;
          if (z_[cell] < nodes_[result_.lakes[lake].depression].sill_m) {
            of_row[j].emplace_back(lake, cell);
          }
        }
      });
    }
    errors.rethrow();
    std::vector<std::pair<Number, Index>> all;
    for (const auto& row : of_row) all.insert(all.end(), row.begin(), row.end());
    return all;
  }

  /// Levels of endorheic lakes: their cells from the lowest up, until the loss equals the inflow.
  void flood_endorheic() {
    std::vector<Index> begin(result_.lakes.size() + 1, 0);
    const std::vector<std::pair<Number, Index>> within = cells_below_sills();
    for (const auto& [lake, cell] : within) ++begin[lake + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<Index> cells(begin.back()), next(begin.begin(), begin.end() - 1);
    for (const auto& [lake, cell] : within) cells[next[lake]++] = cell;
#pragma omp parallel for schedule(dynamic, 16)
    for (std::size_t lake = 0; lake < result_.lakes.size(); ++lake) {
      if (result_.lakes[lake].outlet != kNoCell) continue;
      flood({cells.data() + begin[lake], cells.data() + begin[lake + 1]}, result_.lakes[lake]);
    }
  }

  void flood(std::span<Index> cells, Lake& lake) const {
    std::sort(cells.begin(), cells.end(),
              [&](Index a, Index b) { return z_[a] != z_[b] ? z_[a] < z_[b] : a < b; });
    double left = lake.inflow_m3_s;
    for (std::size_t n = 0; n < cells.size(); ++n) {
      const Index cell = cells[n];
      const double area = grid_.area_m2(grid_.row(cell));
      if (left <= loss_[cell]) {  // the last cell, and partly flooded
        const double share = loss_[cell] > 0 ? left / loss_[cell] : 0.0;
        const double above = n + 1 < cells.size() ? z_[cells[n + 1]] : lake.level_m;
        lake.level_m = static_cast<float>(z_[cell] + share * (above - z_[cell]));
        lake.area_m2 += share * area;
        return;
      }
      left -= loss_[cell];
      lake.area_m2 += area;
    }
  }

  const Grid& grid_;
  std::span<const float> z_;
  const DepressionHierarchy& hierarchy_;
  const std::vector<Depression>& nodes_;
  std::span<const float> loss_;
  std::vector<double> inflow_, capacity_;  // of own catchments; when flooded to the sill
  std::vector<Number> begin_, end_;        // range of each depression in leaf_at_
  std::vector<Number> leaf_at_, tree_of_leaf_;
  RangeSums spilled_;  // by other depressions, at the leaf where it arrives
  Lakes result_;
};

}  // namespace

Lakes balance_lakes(const Grid& grid, std::span<const float> elevation_m,
                    const DepressionHierarchy& hierarchy, std::span<const double> runoff_m3_s,
                    std::span<const float> flooding_loss_m3_s) {
  check_sizes("balance_lakes", grid.size(),
              {{"elevation_m", elevation_m.size()},
               {"runoff_m3_s", runoff_m3_s.size()},
               {"flooding_loss_m3_s", flooding_loss_m3_s.size()}});
  return Balance(grid, elevation_m, hierarchy, runoff_m3_s, flooding_loss_m3_s).solve();
}

void connect_lakes(const Lakes& lakes, std::span<Index> receiver) {
#pragma omp parallel for schedule(dynamic, 1024)
  for (std::size_t leaf = 0; leaf < lakes.exit_of_leaf.size(); ++leaf) {
    const auto [inside, outside] = lakes.exit_of_leaf[leaf];
    if (inside != kNoCell) detail::reverse_path(inside, outside, receiver);
  }
}

void map_lakes(const Grid& grid, std::span<const float> elevation_m,
               const DepressionHierarchy& hierarchy, const Lakes& lakes,
               std::span<const std::uint8_t> hidden, std::span<float> depth_m,
               std::span<std::int32_t> lake_id) {
  check_sizes("map_lakes", grid.size(),
              {{"elevation_m", elevation_m.size()},
               {"depth_m", depth_m.size()},
               {"lake_id", lake_id.size()}});
  check_sizes("map_lakes", lakes.lakes.size(),
              {{"hidden", hidden.size(), ArraySize::May::be_empty}});
  std::vector<Number> by_area(lakes.lakes.size());
  std::iota(by_area.begin(), by_area.end(), 0);
  std::erase_if(by_area, [&](Number lake) {
    return lakes.lakes[lake].area_m2 <= 0 || (!hidden.empty() && hidden[lake] != 0);
  });
  std::sort(by_area.begin(), by_area.end(), [&](Number a, Number b) {
    const Lake &la = lakes.lakes[a], &lb = lakes.lakes[b];
    return la.area_m2 != lb.area_m2 ? la.area_m2 > lb.area_m2 : la.bottom < lb.bottom;
  });
  std::vector<std::int32_t> number(lakes.lakes.size(), 0);
  for (std::size_t rank = 0; rank < by_area.size(); ++rank) {
    number[by_area[rank]] = static_cast<std::int32_t>(rank) + 1;
  }
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const Number leaf = hierarchy.leaf_of_cell[cell];
    const Number lake = leaf == kSea ? -1 : lakes.lake_of_leaf[leaf];
    const bool flooded =
        lake >= 0 && number[lake] > 0 && elevation_m[cell] < lakes.lakes[lake].level_m;
    depth_m[cell] = flooded ? lakes.lakes[lake].level_m - elevation_m[cell] : 0.0F;
    lake_id[cell] = flooded ? number[lake] : 0;
  }
}

}  // namespace geo
