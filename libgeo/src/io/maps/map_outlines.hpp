#pragma once

#include <vector>

#include "io/drawing/map_raster.hpp"

namespace geo::io {

/// A point of an outline, pixels from the map's upper left corner.
struct OutlinePoint {
  double x, y;
};
using Outline = std::vector<OutlinePoint>;

/// Lines between pixels of different value (NaN is none), each from one junction (or edge of the
/// map) to the next, or closed. The steps of the pixels are smoothed away over about
/// `smoothing_px`; junctions stay where they are.
std::vector<Outline> trace_outlines(const Raster& areas, double smoothing_px);

}  // namespace geo::io
