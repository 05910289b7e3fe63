#pragma once

#include "geo/stages/isostasy/coarse_grid.hpp"
#include "geo/stages/isostasy/crust.hpp"

namespace geo {

/// What spreading engraves in the floor (Cortial et al. 2019, section 5): fracture zones, which run
/// across the ridge from the transform faults that offset it, and abyssal hills, which run along
/// it. Both are oriented noise, strongest where the floor is new, and die away with its age as
/// sediment covers them; shelves and what is near the surface stay as they are, and no sea becomes
/// land. The ridge's direction is that which the plates gave; without one, that of lines of equal
/// age. Heights are those above the sea.
void engrave_sea_floor(const Crust<float>& crust, const CoarseGrid& coarse,
                       std::span<const float> ridge_east, std::span<const float> ridge_north);

}  // namespace geo
