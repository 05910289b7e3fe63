#pragma once

#include "geo/kernels/raster_relief.hpp"
#include "geo/stages/plates.hpp"

namespace geo {

/// Writes a raster world to the fields of a planet.
///
/// The tile is not stretched: a cell has the same size along x and y. Its middle becomes the belt
/// between the polar circles, x along the equator, once round, and y along the meridians; two discs
/// about the edge that the belt leaves free become the polar caps, in an equal-area projection
/// (Lambert). Belt and caps are blended over some degrees along a line that noise bends. So the
/// date line is where the tile's sides meet, and nothing is drawn together at the poles. A tile
/// lower than 0.6 of its width has no room for that: caps then repeat parts of the belt.
///
/// A plate of the belt and one of a cap are different plates. Each gets the rotation about an axis
/// that comes nearest to its velocities (least squares), so that plates of the planet are rigid.
void lay_on_sphere(const PlatesParameters& parameters, const RasterTectonics& model,
                   RasterScale scale, StageIo& io, const Context& context);

}  // namespace geo
