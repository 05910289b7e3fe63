#pragma once

#include "geo/kernels/plates/raster/raster_elevation.hpp"
#include "geo/stages/plates/plates.hpp"

namespace geo {

/// Writes a raster world to the fields of a torus, a seamless tile: the map's sides are the grid's.
/// East is along x.
void lay_on_torus(const PlatesParameters& parameters, const RasterTectonics& model,
                  RasterScale scale, StageIo& io, const Context& context);

}  // namespace geo
