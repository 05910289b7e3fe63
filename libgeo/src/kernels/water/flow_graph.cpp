#include "geo/kernels/water/flow_graph.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>

#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"

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

namespace {

/// An order in parts of consecutive cells. Donors are counted in bytes: false where one does not
/// hold those of a cell.
class OrderInParts {
 public:
  OrderInParts(std::span<const Index> receiver, int parts, std::vector<Index>& order)
      : receiver_(receiver),
        order_(order),
        parts_(parts),
        waiting_(receiver.size(), 0),
        crossings_(parts),
        placed_(parts, 0) {}

  /// Where parts begin, and the last one ends; empty where bytes do not hold the donors.
  std::vector<Index> run() {
    order_.resize(receiver_.size());
    ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
    for (int part = 0; part < parts_; ++part) errors.guard([&] { count_donors(part); });
    errors.rethrow();
    for (const auto& cells : crossings_) {
      for (const Index cell : cells) count(receiver_[cell]);
    }
    if (has_too_many_) return {};
#pragma omp parallel for schedule(dynamic, 1)
    for (int part = 0; part < parts_; ++part) order_part(part);
    std::vector<Index> begins = close_ranks();
    order_rest(begins.back());
    return begins;
  }

 private:
  static constexpr std::uint8_t kDone = std::numeric_limits<std::uint8_t>::max();

  [[nodiscard]] Index begin(int part) const {
    return static_cast<Index>(static_cast<std::int64_t>(receiver_.size()) * part / parts_);
  }
  void count(Index to) {
    if (++waiting_[to] == kDone) has_too_many_ = true;
  }
  void count_donors(int part) {
    const Index first = begin(part), end = begin(part + 1);
    for (Index cell = first; cell < end; ++cell) {
      const Index to = receiver_[cell];
      if (to == cell) continue;
      if (to < first || to >= end) {
        crossings_[part].push_back(cell);
      } else if (++waiting_[to] == kDone) {
        has_too_many_ = true;
      }
    }
  }
  /// Walks downstream from each source of a part as far as the last donor has been seen, and as the
  /// part goes. Cells that leave it wait for the rest.
  void order_part(int part) {
    const Index first = begin(part), end = begin(part + 1);
    Index next = first;
    for (Index source = first; source < end; ++source) {
      for (Index cell = source; waiting_[cell] == 0;) {
        const Index to = receiver_[cell];
        if (to < first || to >= end) break;
        waiting_[cell] = kDone;
        order_[next++] = cell;
        if (to == cell || --waiting_[to] != 0) break;
        cell = to;
      }
    }
    placed_[part] = next - first;
  }
  std::vector<Index> close_ranks() {
    std::vector<Index> begins{0};
    for (int part = 0; part < parts_; ++part) {
      const auto from = order_.begin() + begin(part);
      std::move(from, from + placed_[part], order_.begin() + begins.back());
      begins.push_back(begins.back() + placed_[part]);
    }
    return begins;
  }
  void order_rest(Index next) {
    for (const auto& cells : crossings_) {
      for (const Index source : cells) {
        for (Index cell = source; waiting_[cell] == 0;) {
          waiting_[cell] = kDone;
          order_[next++] = cell;
          const Index to = receiver_[cell];
          if (to == cell || --waiting_[to] != 0) break;
          cell = to;
        }
      }
    }
    if (next != static_cast<Index>(receiver_.size())) throw Bug("flow routing has a cycle");
  }

  std::span<const Index> receiver_;
  std::vector<Index>& order_;
  int parts_;
  std::vector<std::uint8_t> waiting_;  ///< donors that have not been seen yet, or kDone
  std::vector<std::vector<Index>> crossings_;
  std::vector<Index> placed_;
  std::atomic<bool> has_too_many_ = false;
};

}  // namespace

void FlowGraph::put_in_order() {
  constexpr std::size_t kLeast = std::size_t{1} << 17, kMost = 32;
  const auto parts = static_cast<int>(std::min(kMost, receiver.size() / kLeast));
  part_begins.clear();
  if (parts > 1) part_begins = OrderInParts(receiver, parts, order).run();
  if (part_begins.empty()) order = downstream_order(receiver);
}

void FlowGraph::accumulate(std::span<double> values) const {
  check_sizes("accumulate", receiver.size(), {{"order", order.size()}, {"values", values.size()}});
  walk_downstream(*this, [&](Index cell) {
    const Index to = receiver[cell];
    if (to != cell) values[to] += values[cell];
  });
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
