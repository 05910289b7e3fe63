#include "catchments.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <span>
#include <utility>

namespace geo::detail {
namespace {

/// Directions that visit every pair of neighbours once (twice where a step crosses the north pole).
constexpr std::array<int, 4> kForward{kNorth, kNorthEast, kEast, kNorthWest};
/// What they leave out: steps over the south pole.
constexpr std::array<int, 3> kOverSouthPole{kSouth, kSouthEast, kSouthWest};
constexpr std::int32_t kUnknown = std::numeric_limits<std::int32_t>::min();

std::int32_t load(const std::int32_t& value) {
  return std::atomic_ref<std::int32_t>(const_cast<std::int32_t&>(value))
      .load(std::memory_order_relaxed);
}
void store(std::int32_t& value, std::int32_t to) {
  std::atomic_ref<std::int32_t>(value).store(to, std::memory_order_relaxed);
}

/// Makes and reads keys. Of several passes over the same cell the steepest way down comes first.
class Keys {
 public:
  Keys(const Grid& grid, const float* z) : grid_(grid), z_(z) {}

  /// The pass between a cell of row j and its neighbour `to` in direction k.
  [[nodiscard]] PassKey make(Index cell, int j, Index to, int k) const {
    const bool descends = z_[cell] >= z_[to];
    const Index higher = descends ? cell : to;
    const int down = descends ? k : grid_.back_direction(j, k);
    return (PassKey{ordered_bits(z_[higher])} << 32) |
           (static_cast<std::uint32_t>(higher) * 8U + static_cast<std::uint32_t>(down));
  }
  [[nodiscard]] std::pair<Index, Index> cells(PassKey key) const {
    const auto edge = static_cast<std::uint32_t>(key);
    const auto higher = static_cast<Index>(edge / 8U);
    return {higher, grid_.neighbour(higher, static_cast<int>(edge % 8U))};
  }
  [[nodiscard]] static bool same_cell(PassKey a, PassKey b) { return (a >> 3) == (b >> 3); }
  /// Total order of passes.
  [[nodiscard]] bool before(PassKey a, PassKey b) const {
    if (!same_cell(a, b)) return a < b;
    const double slope_a = slope(a), slope_b = slope(b);
    return slope_a != slope_b ? slope_a > slope_b : a < b;
  }

 private:
  [[nodiscard]] double slope(PassKey key) const {
    const auto [higher, lower] = cells(key);
    return (static_cast<double>(z_[higher]) - z_[lower]) /
           grid_.distances_m(grid_.row(higher))[key % 8U];
  }
  const Grid& grid_;
  const float* z_;
};

/// A small direct-mapped table from pairs of catchments to their lowest pass so far. Pairs that
/// meet lie close together in raster order, so few are evicted twice; what is evicted goes to the
/// list, and a pair that stands there twice does no harm.
class PassCollector {
 public:
  explicit PassCollector(const Keys& keys) : keys_(keys), slots_(kSlots) {}

  void offer(std::int32_t a, std::int32_t b, PassKey key) {
    const auto low = static_cast<std::uint32_t>(std::min(a, b));
    const auto high = static_cast<std::uint32_t>(std::max(a, b));
    Slot& slot = slots_[((low * 0x9E37'79B1U) ^ (high * 0x85EB'CA77U)) >> (32 - kBits)];
    if (slot.low == low && slot.high == high) {
      if (Keys::same_cell(key, slot.key) ? keys_.before(key, slot.key) : key < slot.key) {
        slot.key = key;
      }
      return;
    }
    if (slot.key != kEmpty) passes_.push_back(slot.key);
    slot = {low, high, key};
  }
  std::vector<PassKey> finish() {
    for (const Slot& slot : slots_) {
      if (slot.key != kEmpty) passes_.push_back(slot.key);
    }
    return std::move(passes_);
  }

 private:
  static constexpr int kBits = 15;
  static constexpr std::size_t kSlots = std::size_t{1} << kBits;
  static constexpr PassKey kEmpty = ~PassKey{0};
  struct Slot {
    std::uint32_t low = 0, high = 0;
    PassKey key = kEmpty;
  };
  const Keys& keys_;
  std::vector<Slot> slots_;
  std::vector<PassKey> passes_;
};

/// Passes between the cells of one row and their forward neighbours.
void collect_row(const Grid& grid, const std::int32_t* leaf, int j, const Keys& keys,
                 PassCollector& collector) {
  const int nx = grid.nx();
  const auto at_edge = [&](int i, std::span<const int> directions) {
    const Index cell = grid.cell(i, j);
    for (const int k : directions) {
      const Index to = grid.neighbour(i, j, k);
      if (to == kNoCell || leaf[to] == leaf[cell]) continue;
      collector.offer(leaf[cell], leaf[to], keys.make(cell, j, to, k));
    }
  };
  if (j == 0 && grid.topology() == Topology::sphere) {
    for (int i = 0; i < nx; ++i) at_edge(i, kOverSouthPole);
  }
  if (j == grid.ny() - 1) {
    for (int i = 0; i < nx; ++i) at_edge(i, kForward);
    return;
  }
  at_edge(0, kForward);
  const auto offset = grid.offsets();
  const Index end = grid.cell(nx - 1, j);
  for (Index cell = grid.cell(1, j); cell < end; ++cell) {
    const std::int32_t here = leaf[cell];
    for (const int k : kForward) {
      const Index to = cell + offset[k];
      if (leaf[to] != here) collector.offer(here, leaf[to], keys.make(cell, j, to, k));
    }
  }
  at_edge(nx - 1, kForward);
}

/// Least-significant-digit radix sort: linear, and stable whatever the number of threads.
void sort_keys(std::vector<PassKey>& keys) {
  constexpr int kBits = 11, kBuckets = 1 << kBits;
  std::vector<PassKey> other(keys.size());
  for (int shift = 0; shift < 64; shift += kBits) {
    std::array<std::size_t, kBuckets + 1> start{};
    for (const PassKey key : keys) ++start[((key >> shift) & (kBuckets - 1)) + 1];
    if (std::find(start.begin(), start.end(), keys.size()) != start.end()) continue;
    for (int b = 0; b < kBuckets; ++b) start[b + 1] += start[b];
    for (const PassKey key : keys) other[start[(key >> shift) & (kBuckets - 1)]++] = key;
    keys.swap(other);
  }
}

/// Disjoint sets with path halving. The sea is element 0, leaf l is l + 1.
class Sets {
 public:
  explicit Sets(std::size_t leaves) : parent_(leaves + 1) {
    for (std::size_t s = 0; s < parent_.size(); ++s) parent_[s] = static_cast<std::int32_t>(s);
  }
  std::int32_t find(std::int32_t s) {
    while (parent_[s] != s) s = parent_[s] = parent_[parent_[s]];
    return s;
  }
  bool join(std::int32_t a, std::int32_t b) {
    a = find(a);
    b = find(b);
    if (a == b) return false;
    // The larger number hangs under the smaller: the sea, 0, stays a root.
    parent_[std::max(a, b)] = std::min(a, b);
    return true;
  }

 private:
  std::vector<std::int32_t> parent_;
};

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
                                  const Catchments& catchments) {
  if (catchments.pits.empty()) return {};
  const Keys order(grid, elevation_m.data());
  const std::int32_t* leaf = catchments.leaf_of_cell.data();
  std::vector<PassKey> keys;
#pragma omp parallel
  {
    PassCollector collector(order);
#pragma omp for schedule(static)
    for (int j = 0; j < grid.ny(); ++j) collect_row(grid, leaf, j, order, collector);
    const std::vector<PassKey> own = collector.finish();
#pragma omp critical
    keys.insert(keys.end(), own.begin(), own.end());
  }
  sort_keys(keys);

  std::vector<Pass> passes;
  passes.reserve(catchments.pits.size());
  Sets sets(catchments.pits.size());
  for (auto group = keys.begin(); group != keys.end();) {
    auto end = group + 1;
    while (end != keys.end() && Keys::same_cell(*end, *group)) ++end;
    if (end - group > 1) {
      std::sort(group, end, [&](PassKey a, PassKey b) { return order.before(a, b); });
    }
    for (; group != end; ++group) {
      const auto [a, b] = order.cells(*group);
      if (!sets.join(leaf[a] + 1, leaf[b] + 1)) continue;
      const auto height = static_cast<std::uint32_t>(*group >> 32);
      passes.push_back({a, b, leaf[a], leaf[b], from_ordered_bits(height)});
    }
    if (passes.size() == catchments.pits.size()) break;
  }
  return passes;
}

std::vector<Pass> passes_below_roots(std::int32_t leaves, std::span<const Pass> passes,
                                     std::span<const std::uint8_t> is_root) {
  Sets sets(leaves);
  std::vector<std::uint8_t> rooted(static_cast<std::size_t>(leaves) + 1, 0);
  rooted[0] = 1;
  for (std::int32_t leaf = 0; leaf < leaves; ++leaf) rooted[leaf + 1] = is_root[leaf];
  std::vector<Pass> kept;
  for (const Pass& pass : passes) {
    const std::int32_t a = sets.find(pass.leaf_a + 1), b = sets.find(pass.leaf_b + 1);
    if (a == b || (rooted[a] != 0 && rooted[b] != 0)) continue;
    const std::uint8_t either = rooted[a] | rooted[b];
    sets.join(a, b);
    rooted[sets.find(a)] = either;
    kept.push_back(pass);
  }
  return kept;
}

std::vector<Spill> spill_towards_roots(std::int32_t leaves, std::span<const Pass> passes,
                                       std::span<const std::uint8_t> is_root) {
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
  const auto is_kept = [&](std::int32_t leaf) { return !is_root.empty() && is_root[leaf] != 0; };
  for (std::int32_t leaf = 0; leaf < leaves; ++leaf) {
    if (is_kept(leaf)) queue.push_back(leaf);
  }
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const std::int32_t from = queue[head];
    const float level = from == kSea || is_kept(from) ? kLowest : spill[from].level_m;
    for (std::int32_t at = start[from + 1]; at < start[from + 2]; ++at) {
      const Pass& pass = passes[incident[at]];
      const bool a_is_here = pass.leaf_a == from;
      const std::int32_t to = a_is_here ? pass.leaf_b : pass.leaf_a;
      if (to == kSea || is_kept(to) || spill[to].inside != kNoCell) continue;
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
