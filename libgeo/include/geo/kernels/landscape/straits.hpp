#pragma once

#include <span>

#include "geo/core/grid.hpp"

namespace geo {

/// Which seas are joined to the ocean, and by what straits.
struct StraitLaw {
  double sill_m = 300.0;   ///< highest land on the way
  double drawdown = 0.0;   ///< or this share of the depth of the sea, where that is more
  double land_m = 3e6;     ///< longest way over land
  double depth_m = 60.0;   ///< of the strait
  double width_m = 80e3;   ///< of the strait, from shore to shore
  double least_m2 = 5e10;  ///< area of the smallest sea that is joined
};

/// Joins seas that land cuts off to the ocean, the largest part of the sea: at high stands the sea
/// flows over low sills, and the flow, either way, cuts a strait, as at Gibraltar. A deep sea that
/// is cut off dries up or falls, and rivers that fall into the hollow cut back through higher land,
/// the deeper the hollow [loget2006]. From each part of at least `least_m2`, the largest first, the
/// cheapest way (length times height above the sea, and a little for the length itself, times the
/// resistance of the rock, a noise of the place) leads over land no higher than `sill_m` to the
/// ocean or what has been joined to it; other seas on the way join as well. The land along it sinks
/// below the sea, to `depth_m` on the way itself and by a bell of `width_m` beside it. Seas without
/// such a way stay as they are. Returns the number of ways.
///
/// `elevation_m`: one value per cell, in and out; land is 0 and above. Cost: linear in the cells,
/// and a search over those within reach of each such sea. One thread; the same bits always.
/// `elevation_m`: one value per cell, in and out; Bug otherwise.
int open_straits(const Grid& grid, const StraitLaw& law, std::span<float> elevation_m);

}  // namespace geo
