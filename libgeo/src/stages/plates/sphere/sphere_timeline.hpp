#pragma once

#include "geo/core/stage.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"

namespace geo {

/// Does what the events of plates ask for between `from_myr` and `to_myr`, to exclusively, and
/// records it: to plates of the one, to crust and plumes of both models, which may be the same.
/// Warns of events that find no plate or plume.
void strike_plates(const Grid& grid, double from_myr, double to_myr, SphereTectonics& plates,
                   SphereTectonics& crust, Context& context);

/// Warns of events that are to come after the drift has ended.
void warn_of_later_events(double end_myr, Context& context);

}  // namespace geo
