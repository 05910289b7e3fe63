#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// A part of the sea that no water joins to another: cells below 0, side by side or corner to
/// corner, over the seam and the poles.
struct SeaPart {
  double area_m2 = 0.0;
  double deepest_m = 0.0;  ///< below 0
  Index first = kNoCell;   ///< its lowest cell by number
};

/// All parts of the sea, the largest first; of equals that of the lower cell. `elevation_m` has one
/// value per cell (InputError otherwise). Method: the runs of sea of each row are the nodes of a
/// union-find (Rosenfeld & Pfaltz 1966; He et al. 2008). Cost: linear, threaded over rows but for
/// the runs, of which there are few.
std::vector<SeaPart> parts_of_sea(const Grid& grid, std::span<const float> elevation_m);

/// The same, and the place of each cell's part among them, from 0; -1 on land.
struct NumberedSeas {
  std::vector<SeaPart> parts;
  std::vector<std::int32_t> part_of_cell;
};
NumberedSeas number_seas(const Grid& grid, std::span<const float> elevation_m);

/// How many parts of the sea beside the ocean, its largest part, are deeper than `depth_m` or
/// larger than `area_m2`.
int count_landlocked(std::span<const SeaPart> parts, double depth_m, double area_m2);

}  // namespace geo
