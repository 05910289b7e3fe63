#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Local relief, m: the range of heights among a cell and its eight neighbours. The surface of the
/// sea counts as 0, so that the local relief of a coast is that of its land. 0 at sea.
/// `elevation_m` has one value per cell (InputError otherwise). Cost: linear.
std::vector<float> local_relief_m(const Grid& grid, std::span<const float> elevation_m);

/// Share of the coastal sea poleward of a latitude that lies between land: of the sea with land
/// within `reach_m` to the north, east, south or west, that with land there on two opposite sides.
/// NaN without any. `elevation_m` has one value per cell (InputError otherwise) of a grid with
/// latitudes; land is 0 and above. Cost: cells times reach over cell.
double share_of_sounds(const Grid& grid, std::span<const float> elevation_m, double latitude_deg,
                       double reach_m);

/// A part of the sea that no water joins to another: cells below 0, side by side or corner to
/// corner.
struct SeaPart {
  double area_m2 = 0.0;
  double deepest_m = 0.0;  ///< below 0
  Index first = kNoCell;   ///< its lowest cell by number
};

/// All parts of the sea, the largest first; of equals that of the lower cell. `elevation_m` has one
/// value per cell (InputError otherwise). Cost: linear.
std::vector<SeaPart> parts_of_sea(const Grid& grid, std::span<const float> elevation_m);

/// Number of the part of the sea in which each cell lies, 1 the largest; 0 on land.
std::vector<std::int32_t> number_seas(const Grid& grid, std::span<const float> elevation_m);

/// How many parts of the sea beside the ocean, its largest part, are deeper than `depth_m` or
/// larger than `area_m2`.
int count_landlocked(std::span<const SeaPart> parts, double depth_m, double area_m2);

}  // namespace geo
