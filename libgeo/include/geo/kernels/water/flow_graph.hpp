#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Cells where water leaves the land: 1 where elevation < sea_level_m and at the edge of an open
/// plane. On a closed world with neither, the lowest cell (the first of several) is the outlet,
/// so that every routing has an end. Shape: one byte per cell.
std::vector<std::uint8_t> find_outlets(const Grid& grid, std::span<const float> elevation_m,
                                       float sea_level_m = 0.0F);

/// D8 receivers (O'Callaghan & Mark 1984): the neighbour of steepest descent by true distance,
/// (h_i - h_j) / d_ij over the eight neighbours, poles crossed and edges wrapped. A cell without a
/// lower neighbour, and every outlet, is its own receiver. Of equal slopes the first direction
/// clockwise from north wins. Shapes: one value per cell. Cost: linear, threaded over rows.
void steepest_receivers(const Grid& grid, std::span<const float> elevation_m,
                        std::span<const std::uint8_t> outlets, std::span<Index> receiver);

/// A single-flow routing: a forest whose roots are outlets and the bottoms of endorheic basins.
struct FlowGraph {
  std::vector<Index> receiver;  ///< itself at a root
  std::vector<Index> order;     ///< every cell stands after all its donors
  /// Where the parts of the order begin that threads may walk side by side, and where the last of
  /// them ends: no cell of one drains into another. What the order has behind them drains several.
  /// Empty: no parts.
  std::vector<Index> part_begins;

  /// Makes the order, in parts. They are runs of cells by number, bands of a grid: a cell is in its
  /// band's part if nothing that it drains has crossed an edge between bands, and its receiver lies
  /// in the band too (after Barnes 2017, whose tiles likewise leave to one thread what crosses
  /// their edges). Their number depends on that of the cells alone, and so does the order. Cost as
  /// for `downstream_order`, threaded over parts. Throws Bug on a cycle.
  void put_in_order();

  /// Adds to each cell what its donors hold: afterwards values[i] is the sum over the upstream
  /// area of i, itself included. Drainage area when `values` held cell areas.
  /// One value per node; Bug otherwise.
  void accumulate(std::span<double> values) const;
};

/// Calls `visit(cell)` for all cells, donors before receivers. Parts are visited by several threads
/// at once: a visit may change what belongs to the cell and to its receiver, and read what belongs
/// to these and to nobody's part. It must not throw.
template <class Visit>
void walk_downstream(const FlowGraph& graph, const Visit& visit) {
  const auto& begins = graph.part_begins;
  const auto parts = static_cast<int>(begins.size()) - 1;
#pragma omp parallel for schedule(dynamic, 1) if (parts > 0)
  for (int part = 0; part < parts; ++part) {
    for (Index at = begins[part]; at < begins[part + 1]; ++at) visit(graph.order[at]);
  }
  const auto size = static_cast<Index>(graph.order.size());
  for (Index at = parts > 0 ? begins[parts] : 0; at < size; ++at) visit(graph.order[at]);
}

/// The same, receivers before donors.
template <class Visit>
void walk_upstream(const FlowGraph& graph, const Visit& visit) {
  const auto& begins = graph.part_begins;
  const auto parts = static_cast<int>(begins.size()) - 1;
  const Index end = parts > 0 ? begins[parts] : 0;
  for (auto at = static_cast<Index>(graph.order.size()); at-- > end;) visit(graph.order[at]);
#pragma omp parallel for schedule(dynamic, 1) if (parts > 0)
  for (int part = 0; part < parts; ++part) {
    for (Index at = begins[part + 1]; at-- > begins[part];) visit(graph.order[at]);
  }
}

/// Orders a receiver forest so that donors come before receivers: of the cells of a grid, or of any
/// graph in which a node has one receiver and as many donors as it likes. Cost: linear, no sort:
/// walks downstream from each source as far as the last donor has been seen; one byte per node
/// beside the order (four where a node has more than 254 donors). Throws Bug on a cycle.
std::vector<Index> downstream_order(std::span<const Index> receiver);

/// Number of the root that each cell drains to: basins are numbered 1.. by falling area, ties by
/// root index; cells that are outlets in the sea get 0. Shape: one per cell.
/// `sea`: one byte per cell, Bug otherwise.
std::vector<std::int32_t> number_basins(const Grid& grid, const FlowGraph& graph,
                                        std::span<const std::uint8_t> sea);

/// Strahler order of the network of cells whose `is_channel` is non-zero: 1 at its heads, one more
/// where two of equal order meet, 0 outside.
/// Both arrays have one value per node of the graph; Bug otherwise.
void strahler_order(const FlowGraph& graph, std::span<const std::uint8_t> is_channel,
                    std::span<std::int8_t> order);

}  // namespace geo
