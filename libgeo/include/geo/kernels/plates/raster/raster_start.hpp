#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/kernels/plates/raster/raster_plate.hpp"

namespace geo {

/// Fractal noise without a seam: gradient noise (quintic fade) on lattices that fit the world's
/// sides, `cells_across` of them along the first octave's x and as many as give squares along y;
/// twice as many and `gain` times the amplitude each further octave. One value for each cell, in
/// rows, about [-1, 1].
std::vector<float> seamless_noise(const RasterWorld& world, double cells_across, double gain,
                                  int octaves, std::uint64_t seed);

/// The first map (Viitanen 2012, 7.4): fractal terrain of which `sea_share` becomes a flat ocean
/// floor of `ocean_crust`; the rest is land, 1 plus the noise scaled to [0, 1].
std::vector<RasterCrust> start_raster(const RasterWorld& world, double sea_share,
                                      double ocean_crust, double cells_across, std::uint64_t seed);

/// Plates grown at random (Viitanen 2012, 7.4): from `plates` different places at once, each takes
/// in turn the free neighbours of one of its border cells, until all is taken. They grow on a
/// lattice of a fixed size, seen by each cell through a warp that bends outlines at scales below
/// it: plates belong to places, and a finer map has the same. Returns the plate of each cell.
/// `round` tells the cycles of one seed apart.
std::vector<std::int16_t> grow_raster_plates(const RasterWorld& world, int plates,
                                             std::uint64_t seed, std::uint64_t round);

}  // namespace geo
