#pragma once

#include "geo/stages/isostasy/coarse_grid.hpp"
#include "geo/stages/isostasy/crust.hpp"
#include "geo/stages/isostasy/tectonics.hpp"

namespace geo {

/// crust = "given": heights, thickness and density as the plates handed them over, to the last bit.
/// What boundaries do to the crust is worked out beside them and moves nothing. Where no densities
/// came, they follow the continental share.
void take_given_crust(const Crust<float>& crust, const CoarseGrid& coarse,
                      const Tectonics<float>& tectonics);

}  // namespace geo
