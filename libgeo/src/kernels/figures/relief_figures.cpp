#include "geo/kernels/figures/relief_figures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "geo/core/error.hpp"

namespace geo {
namespace {

void check_shape(const Grid& grid, std::span<const float> elevation_m) {
  if (elevation_m.size() != static_cast<std::size_t>(grid.size())) {
    throw InputError("local relief: elevation has " + std::to_string(elevation_m.size()) +
                     " values, the grid " + std::to_string(grid.size()) + " cells");
  }
}

}  // namespace

std::vector<float> local_relief_m(const Grid& grid, std::span<const float> elevation_m) {
  check_shape(grid, elevation_m);
  std::vector<float> relief(elevation_m.size(), 0.0F);
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      const Index cell = grid.cell(i, j);
      if (elevation_m[cell] < 0.0F) continue;
      float lowest = elevation_m[cell], highest = lowest;
      for (int k = 0; k < kDirections; ++k) {
        const Index beside = grid.neighbour(i, j, k);
        if (beside == kNoCell) continue;
        lowest = std::min(lowest, std::max(0.0F, elevation_m[beside]));
        highest = std::max(highest, elevation_m[beside]);
      }
      relief[cell] = highest - lowest;
    }
  }
  return relief;
}

double share_of_sounds(const Grid& grid, std::span<const float> elevation_m, double latitude_deg,
                       double reach_m) {
  check_shape(grid, elevation_m);
  const auto meets_land = [&](Index cell, int k) {
    double way_m = 0.0;
    for (Index at = cell;;) {
      way_m += grid.distances_m(grid.row(at))[k];
      at = grid.neighbour(at, k);
      if (at == kNoCell || at == cell || way_m > reach_m) return false;
      if (elevation_m[at] >= 0.0F) return true;
    }
  };
  double coastal = 0.0, between = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    if (std::abs(grid.latitude_deg(j)) < latitude_deg) continue;
    for (Index cell = grid.cell(0, j); cell < grid.cell(0, j) + grid.nx(); ++cell) {
      if (elevation_m[cell] >= 0.0F) continue;
      const bool north = meets_land(cell, kNorth), south = meets_land(cell, kSouth);
      const bool east = meets_land(cell, kEast), west = meets_land(cell, kWest);
      if (north || south || east || west) coastal += grid.area_m2(j);
      if ((north && south) || (east && west)) between += grid.area_m2(j);
    }
  }
  return coastal > 0.0 ? between / coastal : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace geo
