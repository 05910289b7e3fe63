#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// A drained planet, one value per cell.
struct DrainedPlanet {
  std::span<const float> elevation_m;      ///< sea below zero
  std::span<const std::int32_t> receiver;  ///< itself at the end of the way
  std::span<const double> area_m2;         ///< upstream, the cell included
};

/// Flow length, m: that of the longest flow path to each cell from upstream, centre to centre along
/// receivers. Paths end at sea cells. Throws Bug on a cycle. Cost: linear.
std::vector<float> flow_length_m(const Grid& grid, const DrainedPlanet& drainage);

/// Exponent h of L ~ A^h (Hack 1957) over the basins that drain at least `least_area_m2`, each
/// once, at its mouth (the last land cell), by least squares in logarithms. NaN when there are
/// fewer than ten.
double hack_exponent(const Grid& grid, const DrainedPlanet& drainage, double least_area_m2);

/// Ratios (Horton 1945) from one Strahler order to the next.
struct HortonRatios {
  double bifurcation, length, area;
};
/// Numbers, mean lengths and mean areas of streams by order, as straight lines in the logarithm.
/// Streams of the basins that drain at least `least_area_m2` at their mouth, as Horton's laws are
/// those of a basin: brooks along a coast join no other. Orders with fewer than five streams do not
/// count; NaN with fewer than three orders left.
HortonRatios horton_ratios(const Grid& grid, const DrainedPlanet& drainage,
                           std::span<const std::int8_t> stream_order, double least_area_m2);

/// Areas of the basins on land by number (`basin_id`, 1 the first; position 0 unused), and whether
/// each ends on land.
struct Basins {
  std::vector<double> area_m2;
  std::vector<std::uint8_t> is_endorheic;
};
Basins measure_basins(const Grid& grid, const DrainedPlanet& drainage,
                      std::span<const std::int32_t> basin_id);

/// Area-weighted mean of a field over the land of each basin, by number; NaN where it has none.
std::vector<double> basin_means(const Grid& grid, std::span<const float> elevation_m,
                                std::span<const std::int32_t> basin_id,
                                std::span<const float> field);

}  // namespace geo
