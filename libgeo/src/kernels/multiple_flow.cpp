#include "geo/kernels/multiple_flow.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "flow_weights.hpp"
#include "geo/core/error.hpp"

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

/// How all cells share: to whom, and how much.
struct Shares {
  std::vector<std::uint8_t> receivers;  ///< bit k: neighbour k
  /// Not normalised; only where there are several receivers, so memory that roots and single
  /// flow would take is never touched.
  std::unique_ptr<Weights[]> weights;
};

Shares shares_of_all(const Grid& grid, const FlowWeights& flow) {
  Shares shares{std::vector<std::uint8_t>(grid.size()),
                std::make_unique_for_overwrite<Weights[]>(grid.size())};
#pragma omp parallel for schedule(dynamic, 16) if (grid.size() > kWorthThreads)
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      const Index cell = grid.cell(i, j);
      const std::uint8_t to = flow.receivers(i, j);
      shares.receivers[cell] = to;
      if ((to & (to - 1)) == 0) continue;
      shares.weights[cell] = flow.weights(j, cell, flow.neighbours(i, j), to);
    }
  }
  return shares;
}

// Number of neighbours that give to each cell. Every direction is counted at its target's end, so
// rows can be counted at once.
std::vector<std::uint8_t> count_donors(const Grid& grid, const FlowWeights& weights,
                                       const std::vector<std::uint8_t>& receivers) {
  std::vector<std::uint8_t> donors(grid.size());
#pragma omp parallel for schedule(static) if (grid.size() > kWorthThreads)
  for (int j = 0; j < grid.ny(); ++j) {
    std::array<int, kDirections> back{};
    for (int k = 0; k < kDirections; ++k) back[k] = grid.back_direction(j, k);
    for (int i = 0; i < grid.nx(); ++i) {
      const Neighbours cells = weights.neighbours(i, j);
      int count = 0;
      for (int k = 0; k < kDirections; ++k) {
        if (cells[k] != kNoCell) count += receivers[cells[k]] >> back[k] & 1;
      }
      donors[grid.cell(i, j)] = static_cast<std::uint8_t>(count);
    }
  }
  return donors;
}

}  // namespace

void accumulate_flow(const Grid& grid, std::span<const float> surface_m,
                     std::span<const Index> receiver, const FlowPartition& partition,
                     std::span<double> values) {
  check(grid, surface_m.size(), receiver.size(), values.size(), partition);
  const FlowWeights weights(grid, surface_m, receiver, partition);
  const Shares shares = shares_of_all(grid, weights);
  const std::vector<std::uint8_t>& receivers = shares.receivers;
  std::vector<std::uint8_t> waiting = count_donors(grid, weights, receivers);
  constexpr std::uint8_t kDone = 255;
  std::vector<Index> ready;
  Index visited = 0;
  for (Index source = 0; source < grid.size(); ++source) {
    if (waiting[source] != 0) continue;
    ready.push_back(source);
    while (!ready.empty()) {
      const Index cell = ready.back();
      ready.pop_back();
      waiting[cell] = kDone;
      ++visited;
      const std::uint8_t to = receivers[cell];
      if (to == 0) continue;
      const int row = grid.row(cell);
      const Neighbours cells = weights.neighbours(cell - row * grid.nx(), row);
      if (std::has_single_bit(to)) {
        const Index next = cells[std::countr_zero(to)];
        values[next] += values[cell];
        if (--waiting[next] == 0) ready.push_back(next);
        continue;
      }
      const Weights& weight = shares.weights[cell];
      double sum = 0.0;
      for (const float w : weight) sum += w;
      const double per_weight = values[cell] / sum;
      for (unsigned rest = to; rest != 0; rest &= rest - 1) {
        const int k = std::countr_zero(rest);
        const Index next = cells[k];
        values[next] += per_weight * weight[k];
        if (--waiting[next] == 0) ready.push_back(next);
      }
    }
  }
  if (visited != grid.size()) throw Bug("multiple flow has a cycle: a receiver climbs the surface");
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
