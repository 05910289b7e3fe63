#pragma once

#include <span>

#include "geo/core/grid.hpp"

namespace geo {

/// A distribution by its quantiles: `fraction` strictly ascending from 0 to 1, `value` ascending,
/// linear between the entries.
struct TargetDistribution {
  std::span<const double> fraction;
  std::span<const double> value;
};

/// Gives the field the target's distribution over the area and keeps the order of its cells:
///   z' = F_target^-1(r(z)),  r(z) = area below z + half the area at z, as a share of the grid.
/// One float per cell. Equal values stay equal, so that the result depends on no cell's index.
/// Cost: one radix sort, 16 bytes per cell while it lasts. Throws InputError for a field that
/// does not fit the grid or holds NaN, and for a target that is no distribution.
void map_quantiles(const Grid& grid, const TargetDistribution& target, std::span<float> field);

}  // namespace geo
