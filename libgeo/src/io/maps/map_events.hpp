#pragma once

#include <span>

#include "geo/io/maps/maps.hpp"
#include "io/drawing/map_canvas.hpp"

namespace geo::io {

/// Draws the rims of craters, or a sign where they are too small to see, the lines of rifts, and
/// the names of both onto the map of a grid that has latitudes and longitudes.
void draw_events(MapCanvas& canvas, const MapFrame& frame, std::span<const EventMark> marks);

}  // namespace geo::io
