#include "geo/kernels/water/breaching.hpp"

#include <algorithm>
#include <functional>
#include <vector>

#include "geo/core/array_sizes.hpp"

namespace geo {
namespace {

// A centimetre in a kilometre: as gentle as large rivers get.
constexpr double kBedSlope = 1e-5;

struct Node {
  Index cell;
  std::int32_t from;  ///< node that led here
  double cost_m2;     ///< section area of the cut so far
  double cut_m;       ///< length above the pit
  double way_m;       ///< whole length
};

struct Entry {
  double cost_m2;
  std::int32_t node;
  bool operator>(const Entry& other) const {
    return cost_m2 != other.cost_m2 ? cost_m2 > other.cost_m2 : node > other.node;
  }
};

/// One search after another over the same arrays.
class Search {
 public:
  Search(const Grid& grid, std::span<const std::uint8_t> outlets, const BreachLimits& limits,
         std::span<float> z, std::span<const float> toughness)
      : grid_(grid),
        outlets_(outlets),
        limits_(limits),
        z_(z),
        toughness_(toughness),
        best_(grid.size(), kUnseen) {}

  /// Lowers the way out of `pit`, if there is one.
  bool cut(Index pit) {
    const std::int32_t end = find_lower(pit);
    if (end >= 0) lower(end);
    for (const Node& node : nodes_) best_[node.cell] = kUnseen;
    return end >= 0;
  }

 private:
  static constexpr std::int32_t kUnseen = -1;

  std::int32_t find_lower(Index pit) {
    nodes_.clear();
    heap_.clear();
    const float bottom = z_[pit];
    add({pit, -1, 0.0, 0.0, 0.0});
    while (!heap_.empty()) {
      std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
      const std::int32_t at = heap_.back().node;
      heap_.pop_back();
      const Node node = nodes_[at];
      if (best_[node.cell] != at) continue;  // a cheaper way came later
      if (z_[node.cell] < bottom || outlets_[node.cell] != 0) return at;
      const int i = grid_.column(node.cell), j = grid_.row(node.cell);
      for (int k = 0; k < kDirections; ++k) {
        const Index to = grid_.neighbour(i, j, k);
        if (to == kNoCell) continue;
        const double depth = std::max(z_[to] - bottom, 0.0F);
        const double step = grid_.distances_m(j)[k];
        const double cut = node.cut_m + (depth > limits_.shallow_m ? step : 0.0);
        if (depth > limits_.depth_m || cut > limits_.length_m) continue;
        const double tough = toughness_.empty() ? 1.0 : toughness_[to];
        const double cost = node.cost_m2 + tough * depth * step;
        if (best_[to] != kUnseen && nodes_[best_[to]].cost_m2 <= cost) continue;
        add({to, at, cost, cut, node.way_m + step});
      }
    }
    return -1;
  }
  void add(const Node& node) {
    const auto number = static_cast<std::int32_t>(nodes_.size());
    nodes_.push_back(node);
    best_[node.cell] = number;
    heap_.push_back({node.cost_m2, number});
    std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
  }
  void lower(std::int32_t end) {
    const Node last = nodes_[end];
    const double pit = z_[nodes_[0].cell];
    const double drop = std::min(pit - std::max(z_[last.cell], 0.0F), kBedSlope * last.way_m);
    for (std::int32_t at = last.from; at > 0; at = nodes_[at].from) {
      const Node& node = nodes_[at];
      const auto bed = static_cast<float>(pit - drop * node.way_m / last.way_m);
      if (bed < z_[node.cell]) z_[node.cell] = bed;
    }
  }

  const Grid& grid_;
  std::span<const std::uint8_t> outlets_;
  BreachLimits limits_;
  std::span<float> z_;
  std::span<const float> toughness_;
  std::vector<std::int32_t> best_;  // node by which a cell is best reached
  std::vector<Node> nodes_;
  std::vector<Entry> heap_;
};

}  // namespace

int breach_depressions(const Grid& grid, std::span<const std::uint8_t> outlets,
                       const BreachLimits& limits, std::span<float> elevation_m,
                       std::span<const float> toughness) {
  check_sizes("breach_depressions", grid.size(),
              {{"outlets", outlets.size()},
               {"elevation_m", elevation_m.size()},
               {"toughness", toughness.size(), ArraySize::May::be_empty}});
  if (!(limits.depth_m > 0) || !(limits.length_m > 0)) return 0;
  std::vector<Index> receiver(grid.size()), pits;
  steepest_receivers(grid, elevation_m, outlets, receiver);
  for (Index cell = 0; cell < grid.size(); ++cell) {
    if (receiver[cell] == cell && outlets[cell] == 0) pits.push_back(cell);
  }
  std::stable_sort(pits.begin(), pits.end(),
                   [&](Index a, Index b) { return elevation_m[a] > elevation_m[b]; });
  Search search(grid, outlets, limits, elevation_m, toughness);
  int cuts = 0;
  for (const Index pit : pits) cuts += search.cut(pit);
  return cuts;
}

}  // namespace geo
