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

/// Parts of the sea, the largest first, and for each cell the number of its part in the order of
/// their first cells, from 1; 0 on land.
std::vector<SeaPart> find_parts(const Grid& grid, std::span<const float> elevation_m,
                                std::vector<std::int32_t>& number) {
  check_shape(grid, elevation_m);
  std::vector<SeaPart> parts;
  number.assign(elevation_m.size(), 0);
  std::vector<Index> front;
  for (Index start = 0; start < grid.size(); ++start) {
    const auto reach = [&](Index cell) {
      if (cell == kNoCell || number[cell] != 0 || !(elevation_m[cell] < 0.0F)) return;
      number[cell] = static_cast<std::int32_t>(parts.size()) + 1;
      front.push_back(cell);
    };
    reach(start);
    if (front.empty()) continue;
    SeaPart part;
    part.first = start;
    while (!front.empty()) {
      const Index cell = front.back();
      front.pop_back();
      part.area_m2 += grid.area_m2(grid.row(cell));
      part.deepest_m = std::min(part.deepest_m, static_cast<double>(elevation_m[cell]));
      for (int k = 0; k < kDirections; ++k) reach(grid.neighbour(cell, k));
    }
    parts.push_back(part);
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const SeaPart& a, const SeaPart& b) { return a.area_m2 > b.area_m2; });
  return parts;
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

std::vector<SeaPart> parts_of_sea(const Grid& grid, std::span<const float> elevation_m) {
  std::vector<std::int32_t> number;
  return find_parts(grid, elevation_m, number);
}

std::vector<std::int32_t> number_seas(const Grid& grid, std::span<const float> elevation_m) {
  std::vector<std::int32_t> number;
  const auto parts = find_parts(grid, elevation_m, number);
  std::vector<std::int32_t> rank(parts.size() + 1, 0);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    rank[number[parts[k].first]] = static_cast<std::int32_t>(k) + 1;
  }
  for (std::int32_t& part : number) part = rank[part];
  return number;
}

int count_landlocked(std::span<const SeaPart> parts, double depth_m, double area_m2) {
  if (parts.empty()) return 0;
  return static_cast<int>(std::count_if(parts.begin() + 1, parts.end(), [&](const SeaPart& part) {
    return part.deepest_m < -depth_m || part.area_m2 > area_m2;
  }));
}

}  // namespace geo
