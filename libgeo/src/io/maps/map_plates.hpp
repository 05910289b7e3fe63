#pragma once

#include "geo/core/state.hpp"
#include "io/drawing/map_canvas.hpp"
#include "io/drawing/map_raster.hpp"
#include "map_relief.hpp"

namespace geo::io {

/// Draws plates in muted colours over shaded relief, no two neighbours alike, their boundaries
/// coloured by what happens there, and arrows of their velocity, with a legend below. Needs
/// `plate_id`; boundary types and velocities are drawn where they are known.
void draw_plates(MapCanvas& canvas, const MapFrame& frame, const State& state, const MapBase& base);

}  // namespace geo::io
