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

  /// Adds to each cell what its donors hold: afterwards values[i] is the sum over the upstream
  /// area of i, itself included. Drainage area when `values` held cell areas.
  /// One value per node; Bug otherwise.
  void accumulate(std::span<double> values) const;
};

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
