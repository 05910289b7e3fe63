#pragma once

#include "coarse_grid.hpp"
#include "crust.hpp"
#include "tectonics.hpp"

namespace geo {

/// crust = "margins": thickness, density and height of every column of the full grid, from the
/// cross sections of margins and belts and the age of the floor.
void draw_margins_crust(const Crust& crust, const CoarseGrid& coarse, const Tectonics& tectonics);

}  // namespace geo
