#pragma once

#include <filesystem>

#include "geo/core/planet.hpp"
#include "geo/io/input/dem.hpp"
#include "plain_raster.hpp"

namespace geo::io {

/// Reads a GeoTIFF of elevations in metres, north up, of one band, as window (geographic) or plane
/// (projected); cells without a value are NaN. Throws InputError (names the file and what is wrong
/// with it), IoError when it cannot be opened.
Dem read_geotiff(const std::filesystem::path& path, const Planet& planet);

/// The same as it lies in the file, in this process. Throws InputError without the path.
PlainRaster read_geotiff_raster(const std::filesystem::path& path);

}  // namespace geo::io
