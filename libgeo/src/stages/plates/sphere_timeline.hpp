#pragma once

#include "geo/core/stage.hpp"
#include "geo/kernels/sphere_tectonics.hpp"

namespace geo {

/// Does what the events of plates ask for between `from_myr` and `to_myr`, to exclusively, and
/// records it. `turn` is that of the grid: places are given in the frame of its axis.
void strike_plates(const Grid& grid, double from_myr, double to_myr, SphereTectonics& model,
                   Context& context);

}  // namespace geo
