#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "geo/core/state.hpp"
#include "io/drawing/map_canvas.hpp"
#include "io/drawing/map_raster.hpp"
#include "map_base.hpp"
#include "map_outlines.hpp"

namespace geo::io {

/// Muted colours by the plates' numbers, no two neighbours alike. Needs `plate_id`.
std::map<int, Rgb> plate_colours(const MapFrame& frame, const State& state);

/// A line between two plates, and what happens along its pieces.
struct BoundaryLine {
  struct Piece {
    std::size_t begin, end;  ///< points, both of them its own
    int type;                ///< BoundaryType; interior where it is not known
  };
  Outline points;
  std::vector<Piece> pieces;
};
/// All boundaries of plates, without the steps of cells. Needs `plate_id`.
std::vector<BoundaryLine> boundary_lines(const MapFrame& frame, const State& state);

/// Draws plates in muted colours over shaded relief, no two neighbours alike, their boundaries
/// coloured by what happens there, and arrows of their velocity, with a legend below. Needs
/// `plate_id`; boundary types and velocities are drawn where they are known.
void draw_plates(MapCanvas& canvas, const MapFrame& frame, const State& state, const MapBase& base);

}  // namespace geo::io
