#pragma once

#include "geo/stages/plates.hpp"

namespace geo {

/// plates.model = "sphere": plates that drift, subduct, collide and rift through time (Cortial et
/// al. 2019) on a Fibonacci sphere that is then seen through the grid.
void drift(const PlatesParameters& parameters, StageIo& io, Context& context);

}  // namespace geo
