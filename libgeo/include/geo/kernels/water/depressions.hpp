#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/kernels/water/flow_graph.hpp"

namespace geo {

/// Number of the sea in place of a depression.
inline constexpr std::int32_t kSea = -1;

/// One depression of the hierarchy: what stands below its sill. Leaves hold one pit each; every
/// other one is the union of two that meet at a sill.
struct Depression {
  Index pit = kNoCell;           ///< its lowest cell
  Index sill_inside = kNoCell;   ///< cell on its own side of the sill
  Index sill_outside = kNoCell;  ///< the neighbour beyond
  float sill_m = 0.0F;           ///< elevation at which it spills (the higher of the two cells)
  std::int32_t parent = kSea;    ///< union that it joins when full; kSea where it spills seaward
  std::int32_t children[2] = {kSea, kSea};  ///< for unions
  std::int32_t spills_into = kSea;          ///< leaf (or kSea) whose catchment lies beyond the sill
  double area_m2 = 0.0;                     ///< flooded when full
  double volume_m3 = 0.0;                   ///< held when full, those of its children included
};

/// Depression hierarchy (Barnes, Callaghan & Wickert 2020): which pits exist, over which sill each
/// spills, into what, and how much it holds.
struct DepressionHierarchy {
  std::vector<Depression> depressions;  ///< leaves first; children stand before parents
  std::int32_t leaves = 0;
  std::vector<std::int32_t> leaf_of_cell;  ///< leaf whose pit the cell drains to; kSea
};

/// Depressions of a surface routed by `receiver` (steepest_receivers). Pits are roots that are no
/// outlets. Method: the minimum spanning tree of the graph of catchments (Cordonnier, Bovy & Braun
/// 2019) by Kruskal's algorithm, whose order of passes is that in which depressions join. Cost:
/// linear but for a radix sort of the passes.
/// Arrays have one value per cell (`check_sizes`); Bug otherwise.
DepressionHierarchy build_depression_hierarchy(const Grid& grid, std::span<const float> elevation_m,
                                               std::span<const std::uint8_t> outlets,
                                               std::span<const Index> receiver);

/// Water routed to outlets over the spill points of all depressions.
struct Routing {
  FlowGraph graph;
  std::vector<float> filled_m;  ///< elevation, raised to the spill level in depressions
};

/// Steepest descent, and out of each pit over its lowest pass, so that every cell reaches an
/// outlet: the path from pass to pit is reversed (Cordonnier et al. 2019, "carving"). Receivers
/// stay neighbours, and no step climbs the filled surface. Filled elevations only if asked for.
/// Cost: linear, but for a radix sort of the passes.
/// Arrays have one value per cell (`check_sizes`); Bug otherwise.
Routing route_water(const Grid& grid, std::span<const float> elevation_m,
                    std::span<const std::uint8_t> outlets, bool want_filled = false);
/// The same receivers, and filled elevations, with the order left to be made
/// (FlowGraph::put_in_order).
Routing route_unordered(const Grid& grid, std::span<const float> elevation_m,
                        std::span<const std::uint8_t> outlets, bool want_filled = true);

/// Raises every cell to the level at which its water can reach an outlet (Barnes et al. 2014).
/// Arrays have one value per cell (`check_sizes`); Bug otherwise.
void fill_depressions(const Grid& grid, std::span<const float> elevation_m,
                      std::span<const std::uint8_t> outlets, std::span<float> filled_m);

}  // namespace geo
