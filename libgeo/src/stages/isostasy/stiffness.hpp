#pragma once

#include <vector>

#include "coarse_grid.hpp"
#include "crust.hpp"
#include "tectonics.hpp"

namespace geo {

/// What the plate's stiffness changes under a margins crust (Turcotte et al. 1981), m: w - F w for
/// the deflection w of local balance under belts and arcs. Margins were cut and filled while the
/// plate was warm and weak: they stay in local balance.
std::vector<float> flexure_of_belts_m(const Crust& crust, const Grid& coarse,
                                      const Tectonics& tectonics);

/// Adds to the elevation what stiffness holds up of a blueprint crust's own weight.
void stiffen_blueprint(const Crust& crust, const CoarseGrid& coarse);

}  // namespace geo
