#pragma once

#include "coarse_grid.hpp"
#include "crust.hpp"
#include "tectonics.hpp"

namespace geo {

/// crust = "blueprint": 3.1 to 3.6 of the Tectonica blueprint, with lengths in place of passes.
void draw_blueprint_crust(const Crust& crust, const CoarseGrid& coarse, const Tectonics& tectonics);

}  // namespace geo
