#pragma once

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

}  // namespace geo
