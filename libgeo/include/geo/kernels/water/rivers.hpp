#pragma once

#include <cstdint>
#include <span>

#include "geo/core/grid.hpp"
#include "geo/kernels/water/flow_graph.hpp"

namespace geo {

/// Steepest descent to any of the eight neighbours by true distance, m/m; 0 in pits and where
/// `sea` is non-zero. A neighbour below sea level counts as the water's surface.
/// Arrays have one value per cell (`check_sizes`); Bug otherwise.
void steepest_slope(const Grid& grid, std::span<const float> elevation_m,
                    std::span<const std::uint8_t> sea, std::span<float> slope);

/// Direction of each receiver as files have it: 0 at roots, else 1..8 clockwise from north.
/// Throws Bug if a receiver is no neighbour.
/// Arrays have one value per cell (`check_sizes`); Bug otherwise.
void flow_directions(const Grid& grid, std::span<const Index> receiver,
                     std::span<std::int8_t> direction);

/// Where a river begins to show, and where it is as large as rivers get.
struct RiverScale {
  double threshold_m3_s = 0.0;
  double reference_m3_s = 1.0;
  double slope_m_km = 3.5;  ///< at which a river is half as vigorous as slopes can make it
};

/// The blueprint's own measure of rivers (6.4, 6.5), by drainage area: they show from a share
/// 0.00018 + 0.00007 `rounds` of all area on (6.4 counts it in cells), are of full size where
/// `area_m2` is largest on land, and the slope is 35 m from cell to cell of 9.77 km. Both areas
/// stand in place of discharges. Arrays have one value per cell (`check_sizes`); Bug otherwise.
RiverScale blueprint_river_scale(const Grid& grid, std::span<const double> area_m2,
                                 std::span<const std::uint8_t> sea, double rounds);

/// Prominence of a river, 0..1:
///   ((Q - Q0) / (Q1 - Q0))^0.45 (0.34 + 0.86 s / (s + s0)),
/// discharge Q from threshold Q0 to reference Q1, slope s in m/km, s0 = 3.5 unless set. After the
/// Tectonica blueprint, with discharge in place of counted cells, and its slope of 35 m from cell
/// to cell of 9.8 km as 3.5 m/km, so that neither depends on the resolution.
float river_prominence(double discharge_m3_s, double slope, RiverScale scale);

/// Depth in metres of the valley that a river has cut in geological time, 16 Q^0.36: 80 times its
/// bankfull depth 0.2 Q^0.36 (Leopold & Maddock 1953; Schumm 1977).
double valley_depth(double discharge_m3_s);

struct CarvingLaw {
  double factor = 1.0;          ///< multiplies the depth of valleys
  double rounds = 1.0;          ///< the cut is made in that many parts
  double threshold_m3_s = 0.0;  ///< rivers that carve
  double side_blend = 0.2;      ///< by how much valley sides follow, share of the way to the mean
  double width_m = 1e9;         ///< of valleys: a larger cell sinks by the share they take of it
};

/// Carves valleys: rivers cut to their `valley_depth`, in each round no more than 23 % of their
/// height; above 1600 m, in bedrock, 42 % of the cut is held back (Whipple 2004). Then the cells
/// beside rivers sink towards the mean of their 3 x 3 neighbourhood. Where a grid's valleys
/// (`valley_width_m`) are wider than these, all that is taken by the share of the widths, so that
/// as much rock goes from a coarse grid as from a fine one. No cell sinks below its receiver or the
/// sea or rises, so every way down stays one, no pit forms, and land stays land. Cost: linear.
/// Arrays have one value per cell (`check_sizes`); Bug otherwise.
void carve_valleys(const Grid& grid, const FlowGraph& graph, std::span<const std::uint8_t> sea,
                   std::span<const double> discharge_m3_s, const CarvingLaw& law,
                   std::span<float> elevation_m);

}  // namespace geo
