#include "geo/kernels/water/flow_graph.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"

namespace geo {

namespace {

/// Walks downstream from each source as far as the last donor has been seen, with donors counted in
/// `Count`. False where a cell has more donors than that holds.
template <class Count>
bool order_donors_first(std::span<const Index> receiver, std::vector<Index>& order) {
  const auto size = static_cast<Index>(receiver.size());
  // Donors that have not been seen yet; kDone once the cell itself stands in the order.
  constexpr Count kDone = std::numeric_limits<Count>::max();
  std::vector<Count> waiting(size, 0);
  for (Index cell = 0; cell < size; ++cell) {
    const Index to = receiver[cell];
    if (to != cell && ++waiting[to] == kDone) return false;
  }
  order.resize(size);
  Index* next = order.data();
  for (Index source = 0; source < size; ++source) {
    if (waiting[source] != 0) continue;
    Index cell = source;
    while (true) {
      waiting[cell] = kDone;
      *next++ = cell;
      const Index to = receiver[cell];
      if (to == cell || --waiting[to] != 0) break;
      cell = to;
    }
  }
  if (next != order.data() + size) throw Bug("flow routing has a cycle");
  return true;
}

}  // namespace

std::vector<Index> downstream_order(std::span<const Index> receiver) {
  std::vector<Index> order;
  // A cell of a grid has at most eight donors, a lake that depressions spill into any number.
  if (!order_donors_first<std::uint8_t>(receiver, order)) {
    order_donors_first<std::uint32_t>(receiver, order);
  }
  return order;
}

void FlowGraph::accumulate(std::span<double> values) const {
  check_sizes("accumulate", receiver.size(), {{"order", order.size()}, {"values", values.size()}});
  for (const Index cell : order) {
    const Index to = receiver[cell];
    if (to != cell) values[to] += values[cell];
  }
}

std::vector<std::int32_t> number_basins(const Grid& grid, const FlowGraph& graph,
                                        std::span<const std::uint8_t> sea) {
  check_sizes("number_basins", grid.size(),
              {{"receiver", graph.receiver.size()}, {"sea", sea.size()}});
  std::vector<std::int32_t> basin(grid.size(), 0);
  std::vector<double> area_m2;
  std::vector<Index> root;
  for (auto at = graph.order.rbegin(); at != graph.order.rend(); ++at) {
    const Index cell = *at, to = graph.receiver[cell];
    if (sea[cell] != 0) continue;
    if (to == cell || sea[to] != 0) {
      // A river mouth or an endorheic bottom starts a basin.
      root.push_back(cell);
      area_m2.push_back(0.0);
      basin[cell] = static_cast<std::int32_t>(root.size());
    } else {
      basin[cell] = basin[to];
    }
    area_m2[basin[cell] - 1] += grid.area_m2(grid.row(cell));
  }
  std::vector<std::int32_t> by_area(root.size());
  for (std::size_t b = 0; b < root.size(); ++b) by_area[b] = static_cast<std::int32_t>(b);
  std::sort(by_area.begin(), by_area.end(), [&](std::int32_t a, std::int32_t b) {
    return area_m2[a] != area_m2[b] ? area_m2[a] > area_m2[b] : root[a] < root[b];
  });
  std::vector<std::int32_t> number(root.size() + 1, 0);
  for (std::size_t rank = 0; rank < by_area.size(); ++rank) {
    number[by_area[rank] + 1] = static_cast<std::int32_t>(rank) + 1;
  }
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) basin[cell] = number[basin[cell]];
  return basin;
}

void strahler_order(const FlowGraph& graph, std::span<const std::uint8_t> is_channel,
                    std::span<std::int8_t> order) {
  check_sizes("strahler_order", graph.receiver.size(),
              {{"is_channel", is_channel.size()}, {"order", order.size()}});
  std::fill(order.begin(), order.end(), std::int8_t{0});
  // While a cell waits for its donors: the highest order among them, and whether two have it.
  std::vector<std::uint8_t> twice(order.size(), 0);
  for (const Index cell : graph.order) {
    if (is_channel[cell] == 0) continue;
    order[cell] = static_cast<std::int8_t>(std::max(1, order[cell] + (twice[cell] != 0 ? 1 : 0)));
    const Index to = graph.receiver[cell];
    if (to == cell || is_channel[to] == 0) continue;
    if (order[cell] > order[to]) {
      order[to] = order[cell];
      twice[to] = 0;
    } else if (order[cell] == order[to]) {
      twice[to] = 1;
    }
  }
}

}  // namespace geo
