#pragma once

#include "geo/core/state.hpp"
#include "io/drawing/map_canvas.hpp"
#include "io/drawing/map_raster.hpp"

namespace geo::io {

/// Winds on the pixels of a map.
struct WindRasters {
  Raster right, down, speed;  ///< m/s along the page, NaN beyond its edge
};
WindRasters sample_wind(const MapFrame& frame, const State& state);

/// Draws evenly spaced arrows that bend with the wind, longer where it is faster.
void draw_wind_arrows(MapCanvas& canvas, const WindRasters& wind, bool wraps_east);

}  // namespace geo::io
