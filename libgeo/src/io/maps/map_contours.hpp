#pragma once

#include <span>

#include "io/drawing/map_canvas.hpp"
#include "io/drawing/map_raster.hpp"

namespace geo::io {

/// Draws the contours of the land of a relief (m, a value for each cell): every fifth line heavier,
/// with its height where it runs straight for a while.
void draw_contours(MapCanvas& canvas, const MapFrame& frame, std::span<const float> elevation_m);

}  // namespace geo::io
