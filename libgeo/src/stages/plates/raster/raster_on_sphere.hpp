#pragma once

#include "geo/kernels/plates/raster/raster_elevation.hpp"
#include "geo/kernels/plates/raster/raster_sphere.hpp"
#include "geo/stages/plates/plates.hpp"

namespace geo {

/// Writes plates as height maps on a sphere to the fields of a planet. Heights and ages are read
/// about each place from the samples within two spacings, smoothly; plates are those of the nearest
/// sample and turn as they do in the model.
void lay_on_sphere(const PlatesParameters& parameters, const RasterSphere& model, RasterScale scale,
                   StageIo& io, const Context& context);

}  // namespace geo
