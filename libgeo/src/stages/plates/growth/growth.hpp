#pragma once

#include "geo/stages/plates/plates.hpp"

namespace geo {

/// plates.model = "growth": irregular growth, rigid motion, boundaries from relative velocities
/// (Tectonica blueprint, section 2), on a mesh without poles that is then seen through the grid.
void grow(const PlatesParameters& parameters, StageIo& io, Context& context);

}  // namespace geo
