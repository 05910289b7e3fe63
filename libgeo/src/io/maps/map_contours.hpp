#pragma once

#include <span>
#include <string>
#include <vector>

#include "io/drawing/map_canvas.hpp"
#include "io/drawing/map_raster.hpp"

namespace geo::io {

/// The height of a contour where it runs straight for a while, pixels of the map.
struct ContourLabel {
  PagePoint middle;
  double angle;  ///< clockwise from the right
  std::string text;
};

/// Draws contours of the elevation of land (m, a value for each cell), every fifth line heavier.
/// Returns the heights that belong on these, to be drawn once all other lines are.
std::vector<ContourLabel> draw_contours(MapCanvas& canvas, const MapFrame& frame,
                                        std::span<const float> elevation_m);
void draw_contour_labels(MapCanvas& canvas, std::span<const ContourLabel> labels);

}  // namespace geo::io
