#include "catchments.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>

#include "disjoint_sets.hpp"
#include "geo/core/parallel_errors.hpp"
#include "kernels/numerics/radix_sort.hpp"
#include "kernels/numerics/wide.hpp"

namespace geo::detail {
namespace {

constexpr std::int32_t kUnknown = std::numeric_limits<std::int32_t>::min();

std::int32_t load(const std::int32_t& value) {
  return std::atomic_ref<std::int32_t>(const_cast<std::int32_t&>(value))
      .load(std::memory_order_relaxed);
}
void store(std::int32_t& value, std::int32_t to) {
  std::atomic_ref<std::int32_t>(value).store(to, std::memory_order_relaxed);
}

PassKey make_key(float height, Index higher, int down) {
  return (PassKey{ordered_bits(height)} << 32) |
         (static_cast<std::uint32_t>(higher) * 8U + static_cast<std::uint32_t>(down));
}
float height_of(PassKey key) { return from_ordered_bits(static_cast<std::uint32_t>(key >> 32)); }
Index higher_cell(PassKey key) { return static_cast<Index>(static_cast<std::uint32_t>(key) / 8U); }
int direction_down(PassKey key) { return static_cast<int>(key % 8U); }

/// Cells can only be the higher one of a lowest pass if they are saddles: if their lower neighbours
/// fall into two or more groups around them. (Within one group the water has a way round, lower
/// than the cell.) One bit per direction in, whether there are two groups out; orthogonal
/// neighbours 90 degrees apart touch.
constexpr std::array<bool, 256> make_saddle_table() {
  std::array<bool, 256> saddle{};
  for (int lower = 0; lower < 256; ++lower) {
    int group[kDirections]{};
    int groups = 0;
    for (int k = 0; k < kDirections; ++k) {
      group[k] = (lower >> k & 1) != 0 ? k + 1 : 0;
      groups += lower >> k & 1;
    }
    const auto join = [&](int k, int l) {
      if (group[k] == 0 || group[l] == 0 || group[k] == group[l]) return;
      const int from = group[l], to = group[k];
      for (int& g : group) g = g == from ? to : g;
      --groups;
    };
    for (int k = 0; k < kDirections; ++k) {
      join(k, (k + 1) % kDirections);
      if (k % 2 == 0) join(k, (k + 2) % kDirections);
    }
    saddle[lower] = groups > 1;
  }
  return saddle;
}
constexpr std::array<bool, 256> kSaddle = make_saddle_table();

/// What the search for passes needs to know of a cell: which neighbours are lower (8 bits), whether
/// one is equal, whether one that is not above it lies in another catchment.
constexpr std::int32_t kHasEqual = 1 << 8, kDivides = 1 << 9;

/// Codes of the interior cells of a row. Branch-free, so that the compiler vectorises it.
TERRANE_WIDE void survey_row(const float* __restrict z, const std::int32_t* __restrict leaf,
                             Index begin, Index end, const std::array<Index, kDirections>& offset,
                             std::int32_t* __restrict code) {
  for (Index cell = begin; cell < end; ++cell) {
    std::int32_t bits = 0;
#pragma GCC unroll 8
    for (int k = 0; k < kDirections; ++k) {
      const Index to = cell + offset[k];
      bits |= z[to] < z[cell] ? 1 << k : 0;
      bits |= z[to] == z[cell] ? kHasEqual : 0;
      const std::int32_t differs = leaf[to] != leaf[cell] ? kDivides : 0;
      bits |= z[to] <= z[cell] ? differs : 0;
    }
    code[cell - begin] = bits;
  }
}

/// Passes of which one cell is the higher one: to each catchment around it the steepest way down.
/// `neighbour(k)` gives the cells around it.
template <class Neighbour>
void passes_over(const float* z, const std::int32_t* leaf, Index cell,
                 const std::array<float, kDirections>& inverse_distance, Neighbour&& neighbour,
                 std::vector<PassKey>& keys) {
  std::array<std::int32_t, kDirections> others;
  std::array<float, kDirections> slopes;
  std::array<int, kDirections> directions;
  int count = 0;
  for (int k = 0; k < kDirections; ++k) {
    const Index to = neighbour(k);
    if (to == kNoCell || leaf[to] == leaf[cell] || z[to] > z[cell]) continue;
    const float slope = (z[cell] - z[to]) * inverse_distance[k];
    int at = 0;
    while (at < count && others[at] != leaf[to]) ++at;
    if (at < count && slopes[at] >= slope) continue;
    others[at] = leaf[to];
    slopes[at] = slope;
    directions[at] = k;
    count = std::max(count, at + 1);
  }
  for (int at = 0; at < count; ++at) keys.push_back(make_key(z[cell], cell, directions[at]));
}

void passes_of_row(const Grid& grid, const float* z, const std::uint8_t* outlets,
                   const std::int32_t* leaf, int j, std::vector<std::int32_t>& code,
                   std::vector<PassKey>& keys) {
  const int nx = grid.nx();
  const Index row = grid.cell(0, j);
  const auto offset = grid.offsets();
  std::array<float, kDirections> inverse{};
  for (int k = 0; k < kDirections; ++k) {
    inverse[k] = static_cast<float>(1.0 / grid.distances_m(j)[k]);
  }
  const auto at_edge = [&](int i) {
    passes_over(
        z, leaf, row + i, inverse, [&](int k) { return grid.neighbour(i, j, k); }, keys);
  };
  if (j == 0 || j == grid.ny() - 1) {
    for (int i = 0; i < nx; ++i) at_edge(i);
    return;
  }
  at_edge(0);
  survey_row(z, leaf, row + 1, row + nx - 1, offset, code.data());
  for (Index cell = row + 1; cell < row + nx - 1; ++cell) {
    const std::int32_t bits = code[cell - row - 1];
    if ((bits & kDivides) == 0) continue;
    if (kSaddle[bits & 255] || (bits & kHasEqual) != 0 || outlets[cell] != 0) {
      passes_over(
          z, leaf, cell, inverse, [&](int k) { return cell + offset[k]; }, keys);
    }
  }
  at_edge(nx - 1);
}

}  // namespace

Catchments find_catchments(const Grid& grid, std::span<const std::uint8_t> outlets,
                           std::span<const Index> receiver) {
  Catchments catchments;
  auto& leaf = catchments.leaf_of_cell;
  const int ny = grid.ny(), nx = grid.nx();
  leaf.resize(grid.size());
  std::vector<std::int32_t> first(ny + 1, 0);  // pits before each row
#pragma omp parallel for schedule(static)
  for (int j = 0; j < ny; ++j) {
    std::int32_t pits = 0;
    const Index row = grid.cell(0, j);
    for (Index cell = row; cell < row + nx; ++cell) {
      pits += receiver[cell] == cell && outlets[cell] == 0 ? 1 : 0;
    }
    first[j + 1] = pits;
  }
  for (int j = 0; j < ny; ++j) first[j + 1] += first[j];
  catchments.pits.resize(first[ny]);
#pragma omp parallel for schedule(static)
  for (int j = 0; j < ny; ++j) {
    std::int32_t next = first[j];
    const Index row = grid.cell(0, j);
    for (Index cell = row; cell < row + nx; ++cell) {
      leaf[cell] = kUnknown;
      if (receiver[cell] != cell) continue;
      leaf[cell] = kSea;
      if (outlets[cell] == 0) {
        catchments.pits[next] = cell;
        leaf[cell] = next++;
      }
    }
  }
  // Each cell walks down to the first one that knows, then tells the way it came. Threads may walk
  // the same way; both write the same numbers.
#pragma omp parallel for schedule(static)
  for (int j = 0; j < ny; ++j) {
    for (Index start = grid.cell(0, j); start < grid.cell(0, j) + nx; ++start) {
      if (load(leaf[start]) != kUnknown) continue;
      Index end = start;
      std::int32_t number = kUnknown;
      while ((number = load(leaf[end])) == kUnknown) end = receiver[end];
      for (Index cell = start; cell != end; cell = receiver[cell]) store(leaf[cell], number);
    }
  }
  return catchments;
}

std::vector<Pass> spanning_passes(const Grid& grid, std::span<const float> elevation_m,
                                  std::span<const std::uint8_t> outlets,
                                  const Catchments& catchments) {
  if (catchments.pits.empty()) return {};
  const std::int32_t* leaf = catchments.leaf_of_cell.data();
  std::vector<PassKey> keys;
  ParallelErrors errors;
#pragma omp parallel
  {
    std::vector<PassKey> own;
    auto code = errors.make<std::vector<std::int32_t>>(grid.nx());
#pragma omp for schedule(static)
    for (int j = 0; j < grid.ny(); ++j) {
      errors.guard(
          [&] { passes_of_row(grid, elevation_m.data(), outlets.data(), leaf, j, code, own); });
    }
#pragma omp critical
    errors.guard([&] { keys.insert(keys.end(), own.begin(), own.end()); });
  }
  errors.rethrow();
  sort_keys(keys);

  std::vector<Pass> passes;
  passes.reserve(catchments.pits.size());
  DisjointSets sets(catchments.pits.size() + 1);  // the sea is 0, leaf l is l + 1
  const auto slope = [&](PassKey key) {
    const Index cell = higher_cell(key);
    const int k = direction_down(key);
    return (static_cast<double>(elevation_m[cell]) - elevation_m[grid.neighbour(cell, k)]) /
           grid.distances_m(grid.row(cell))[k];
  };
  const auto same_cell = [](PassKey a, PassKey b) { return (a >> 3) == (b >> 3); };
  for (auto group = keys.begin(); group != keys.end();) {
    // Of several passes over one cell the steepest way down comes first.
    auto end = group + 1;
    while (end != keys.end() && same_cell(*end, *group)) ++end;
    if (end - group > 1) {
      std::stable_sort(group, end, [&](PassKey a, PassKey b) { return slope(a) > slope(b); });
    }
    for (; group != end; ++group) {
      constexpr std::ptrdiff_t kAhead = 32;  // sorted by height, the cells lie all over the grid
      if (keys.end() - group > kAhead) __builtin_prefetch(leaf + higher_cell(group[kAhead]));
      const Index a = higher_cell(*group), b = grid.neighbour(a, direction_down(*group));
      if (!sets.join(leaf[a] + 1, leaf[b] + 1)) continue;
      passes.push_back({a, b, leaf[a], leaf[b], height_of(*group)});
    }
    if (passes.size() == catchments.pits.size()) break;
  }
  return passes;
}

std::vector<Spill> spill_seaward(std::int32_t leaves, std::span<const Pass> passes) {
  const std::size_t nodes = static_cast<std::size_t>(leaves) + 1;  // 0 is the sea
  std::vector<std::int32_t> start(nodes + 2, 0), incident(2 * passes.size());
  for (const Pass& pass : passes) {
    ++start[pass.leaf_a + 2];
    ++start[pass.leaf_b + 2];
  }
  for (std::size_t node = 0; node <= nodes; ++node) start[node + 1] += start[node];
  std::vector<std::int32_t> fill(start.begin(), start.end() - 1);
  for (std::size_t p = 0; p < passes.size(); ++p) {
    incident[fill[passes[p].leaf_a + 1]++] = static_cast<std::int32_t>(p);
    incident[fill[passes[p].leaf_b + 1]++] = static_cast<std::int32_t>(p);
  }
  constexpr float kLowest = -std::numeric_limits<float>::infinity();
  std::vector<Spill> spill(leaves);
  std::vector<std::int32_t> queue{kSea};
  queue.reserve(nodes);
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const std::int32_t from = queue[head];
    const float level = from == kSea ? kLowest : spill[from].level_m;
    for (std::int32_t at = start[from + 1]; at < start[from + 2]; ++at) {
      const Pass& pass = passes[incident[at]];
      const bool a_is_here = pass.leaf_a == from;
      const std::int32_t to = a_is_here ? pass.leaf_b : pass.leaf_a;
      if (to == kSea || spill[to].inside != kNoCell) continue;
      spill[to] = {a_is_here ? pass.b : pass.a, a_is_here ? pass.a : pass.b,
                   std::max(level, pass.elevation_m)};
      queue.push_back(to);
    }
  }
  return spill;
}

void reverse_path(Index inside, Index outside, std::span<Index> receiver) {
  Index cell = inside, to = outside;
  while (true) {
    const Index below = receiver[cell];
    receiver[cell] = to;
    if (below == cell) return;
    to = cell;
    cell = below;
  }
}

}  // namespace geo::detail
