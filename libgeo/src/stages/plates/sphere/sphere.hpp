#pragma once

#include "geo/stages/plates/plates.hpp"

namespace geo {

/// plates.model = "sphere": plates that drift, subduct, collide and rift through time (Cortial et
/// al. 2019) on a Fibonacci sphere that is then seen through the grid.
/// With `plates.sphere.frames_myr` it hands frames to the context; with a checkpoint it goes on
/// from there.
void drift(const PlatesParameters& parameters, const StageInfo& info, StageIo& io,
           Context& context);

}  // namespace geo
