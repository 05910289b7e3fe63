#include "geo/kernels/water/multiple_flow.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "flow_weights.hpp"
#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"

namespace geo {
namespace {

// Waking threads takes longer than a small grid.
constexpr Index kWorthThreads = 16384;

void check(const Grid& grid, std::size_t surface, std::size_t receiver, std::size_t values,
           const FlowPartition& partition) {
  const auto cells = static_cast<std::size_t>(grid.size());
  if (surface != cells || receiver != cells || values != cells) {
    throw InputError("multiple flow: surface, receivers and values must have " +
                     std::to_string(cells) + " cells");
  }
  if (!(partition.exponent > 0.0 && std::isfinite(partition.exponent))) {
    throw InputError("multiple flow: exponent must be positive and finite");
  }
}

/// How all cells share: to whom, and how much. Weights of all cells stand one after the other,
/// those of a cell in the order of the bits of its receivers; most cells have few.
class Shares {
 public:
  Shares(const Grid& grid, const FlowWeights& flow)
      : receivers_(grid.size() + kBlock), first_(grid.size() / kBlock + 1) {
    by_runs(grid, [&](int i, int j, Index cell) {
      return flow.receivers_of_run(i, j, receivers_.data() + cell);
    });
    std::size_t next = 0;
    for (std::size_t block = 0; block < first_.size(); ++block) {
      first_[block] = next;
      next += count_bits(block * kBlock, kBlock);
    }
    weights_ = std::make_unique_for_overwrite<float[]>(next);
    by_runs(grid, [&](int i, int j, Index cell) {
      return flow.weights_of_run(i, j, receivers_.data() + cell, weights_.get() + first(cell));
    });
  }

  /// Bit k: neighbour k. After those of all cells a few zeros.
  [[nodiscard]] const std::vector<std::uint8_t>& receivers() const { return receivers_; }
  /// Not normalised, as many as the cell has receivers.
  [[nodiscard]] const float* weights(Index cell) const { return weights_.get() + first(cell); }

 private:
  static constexpr std::size_t kBlock = 16;  // cells whose weights are found from one number
  static_assert(std::endian::native == std::endian::little, "first bytes are a word's lowest");

  template <class Work>
  static void by_runs(const Grid& grid, Work&& work) {
#pragma omp parallel for schedule(dynamic, 16) if (grid.size() > kWorthThreads)
    for (int j = 0; j < grid.ny(); ++j) {
      for (int i = 0; i < grid.nx();) i += work(i, j, grid.cell(i, j));
    }
  }
  /// Receivers of `cells` of a block, up to 16 of them from its first on.
  [[nodiscard]] std::size_t count_bits(std::size_t from, std::size_t cells) const {
    std::array<std::uint64_t, 2> words{};
    std::memcpy(words.data(), receivers_.data() + from, sizeof words);
    const auto of_first = [](std::uint64_t word, std::size_t bytes) {
      return bytes < 8 ? word & ((std::uint64_t{1} << 8 * bytes) - 1) : word;
    };
    const std::size_t second = cells > 8 ? cells - 8 : 0;
    return std::popcount(of_first(words[0], cells)) + std::popcount(of_first(words[1], second));
  }
  [[nodiscard]] std::size_t first(Index cell) const {
    const auto at = static_cast<std::size_t>(cell), block = at / kBlock;
    return first_[block] + count_bits(block * kBlock, at % kBlock);
  }

  std::vector<std::uint8_t> receivers_;
  std::vector<std::size_t> first_;  ///< weight of each block of cells
  std::unique_ptr<float[]> weights_;
};

// Number of neighbours that give to each cell. Every direction is counted at its target's end, so
// rows can be counted at once.
std::vector<std::uint8_t> count_donors(const Grid& grid, const FlowWeights& weights,
                                       const std::vector<std::uint8_t>& receivers) {
  std::vector<std::uint8_t> donors(grid.size());
  const std::array<Index, kDirections> offset = grid.offsets();
#pragma omp parallel for schedule(static) if (grid.size() > kWorthThreads)
  for (int j = 0; j < grid.ny(); ++j) {
    std::array<int, kDirections> back{};
    for (int k = 0; k < kDirections; ++k) back[k] = grid.back_direction(j, k);
    std::uint8_t* const row = donors.data() + grid.cell(0, j);
    const auto count_at = [&](int i) {
      const Neighbours cells = weights.neighbours(i, j);
      for (int k = 0; k < kDirections; ++k) {
        if (cells[k] != kNoCell) row[i] += receivers[cells[k]] >> back[k] & 1;
      }
    };
    int begin = 0, end = grid.nx();
    while (begin < end && !grid.is_interior(begin, j)) count_at(begin++);
    while (end > begin && !grid.is_interior(end - 1, j)) count_at(--end);
    if (begin == end) continue;
    for (int k = 0; k < kDirections; ++k) {
      const std::uint8_t* const beside = receivers.data() + grid.cell(0, j) + offset[k];
      for (int i = begin; i < end; ++i) row[i] += beside[i] >> back[k] & 1;
    }
  }
  return donors;
}

/// Gives all that cells hold to those below, each when its last donor has given. One thread's work:
/// sums are the same whatever the threads.
void walk_down(const Grid& grid, const FlowWeights& weights, const Shares& shares,
               std::vector<std::uint8_t>& waiting, std::span<double> values) {
  const std::vector<std::uint8_t>& receivers = shares.receivers();
  constexpr std::uint8_t kDone = 255;
  std::vector<Index> ready;
  const auto give = [&](Index next, double value) {
    values[next] += value;
    if (--waiting[next] == 0 && receivers[next] != 0) ready.push_back(next);
  };
  Index visited = 0;
  for (Index source = 0; source < grid.size(); ++source) {
    if (receivers[source] == 0) {  // a root keeps what it gets
      ++visited;
      continue;
    }
    if (waiting[source] != 0) continue;
    ready.push_back(source);
    while (!ready.empty()) {
      const Index cell = ready.back();
      ready.pop_back();
      waiting[cell] = kDone;
      ++visited;
      const std::uint8_t to = receivers[cell];
      const int row = grid.row(cell);
      const Neighbours cells = weights.neighbours(cell - row * grid.nx(), row);
      if (std::has_single_bit(to)) {
        give(cells[std::countr_zero(to)], values[cell]);
        continue;
      }
      const float* weight = shares.weights(cell);
      double sum = 0.0;
      for (int k = 0; k < std::popcount(to); ++k) sum += weight[k];
      const double per_weight = values[cell] / sum;
      for (unsigned rest = to; rest != 0; rest &= rest - 1) {
        give(cells[std::countr_zero(rest)], per_weight * *weight++);
      }
    }
  }
  if (visited != grid.size()) throw Bug("multiple flow has a cycle: a receiver climbs the surface");
}

/// Runs two pieces of work at once, on two threads if there are as many; what either throws is
/// thrown when both are done.
template <class First, class Second>
void run_side_by_side(First&& first, Second&& second) {
  std::array<ParallelErrors, 2> errors;
#pragma omp parallel sections
  {
#pragma omp section
    errors[0].guard(first);
#pragma omp section
    errors[1].guard(second);
  }
  for (const ParallelErrors& thrown : errors) thrown.rethrow();
}

}  // namespace

void accumulate_flow(const Grid& grid, std::span<const float> surface_m,
                     std::span<const Index> receiver, const FlowPartition& partition,
                     std::span<double> values, const std::function<void()>& meanwhile) {
  check(grid, surface_m.size(), receiver.size(), values.size(), partition);
  const FlowWeights weights(grid, surface_m, receiver, partition);
  const Shares shares(grid, weights);
  std::vector<std::uint8_t> waiting = count_donors(grid, weights, shares.receivers());
  const auto walk = [&] { walk_down(grid, weights, shares, waiting, values); };
  if (meanwhile) return run_side_by_side(walk, meanwhile);
  walk();
}

void specific_catchment_area(const Grid& grid, std::span<const float> surface_m,
                             std::span<const Index> receiver, const FlowPartition& partition,
                             std::span<const double> drainage_area_m2, std::span<float> area_m) {
  check(grid, surface_m.size(), receiver.size(), drainage_area_m2.size(), partition);
  check(grid, area_m.size(), receiver.size(), drainage_area_m2.size(), partition);
  const FlowWeights weights(grid, surface_m, receiver, partition);
#pragma omp parallel for schedule(static) if (grid.size() > kWorthThreads)
  for (int j = 0; j < grid.ny(); ++j) {
    const auto& distance = grid.distances_m(j);
    for (int i = 0; i < grid.nx(); ++i) {
      const Index cell = grid.cell(i, j);
      const std::uint8_t to = weights.receivers(i, j);
      area_m[cell] = 0.0F;
      if (to == 0) continue;
      const Neighbours cells = weights.neighbours(i, j);
      const Weights weight = weights.weights(j, cell, cells, to);
      double east = 0.0, north = 0.0, sum = 0.0;
      for (int k = 0; k < kDirections; ++k) {
        sum += weight[k];
        east += weight[k] * kColumnStep[k] * distance[kEast];
        north += weight[k] * kRowStep[k] * distance[kRowStep[k] < 0 ? kSouth : kNorth];
      }
      // Central difference; one-sided at an edge.
      const auto fall = [&](int k, int opposite) {
        const bool ahead = cells[k] != kNoCell, behind = cells[opposite] != kNoCell;
        const double from = surface_m[behind ? cells[opposite] : cell];
        const double onto = surface_m[ahead ? cells[k] : cell];
        return (from - onto) / ((ahead ? distance[k] : 0.0) + (behind ? distance[opposite] : 0.0));
      };
      const double fall_east = fall(kEast, kWest), fall_north = fall(kNorth, kSouth);
      const double slope = std::hypot(fall_east, fall_north);
      const double displacement =
          slope > 0.0 ? (east * fall_east + north * fall_north) / slope : std::hypot(east, north);
      area_m[cell] = static_cast<float>(drainage_area_m2[cell] * std::max(displacement, 0.0) /
                                        (sum * grid.area_m2(j)));
    }
  }
}

}  // namespace geo
