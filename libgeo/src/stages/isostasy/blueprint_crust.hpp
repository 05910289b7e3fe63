#pragma once

#include "geo/stages/isostasy/tectonics.hpp"

namespace geo {

/// crust = "blueprint": 3.1 to 3.6 of the Tectonica blueprint, with lengths in place of passes.
void draw_blueprint_crust(const Crust<float>& crust, const CoarseGrid& coarse,
                          const Tectonics<float>& tectonics);

/// Adds to the elevation what stiffness holds up of a blueprint crust's own weight.
void stiffen_blueprint(const Crust<float>& crust, const CoarseGrid& coarse);

}  // namespace geo
