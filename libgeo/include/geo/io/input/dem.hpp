#pragma once

#include <string>
#include <vector>

#include "geo/core/field.hpp"
#include "geo/core/grid.hpp"
#include "geo/core/planet.hpp"
#include "geo/kernels/remapping/resample.hpp"

namespace geo::io {

/// A DEM as a file holds it, put in order: rows from south to north, columns from west to east.
struct Dem {
  std::vector<float> elevation_m;  ///< on `grid`
  Grid grid;  ///< cells of the source's size: sphere for global files, window or plane else
  std::string source;  ///< path and variable, for the history
  std::string variable;
  /// The file's own cells and values where no Grid has them (nodes at the poles or on the 180th
  /// meridian); else empty. `resample` starts from these.
  Raster raster;
  std::vector<float> raster_m;
};

/// What the samples of an image mean that does not say so, as options have it; empty: not told.
struct ImageWords {
  std::string range;   ///< "MIN,MAX", values of the least and the greatest sample
  std::string window;  ///< "W,S,E,N", degrees; else the whole planet
};

/// Reads `FILE[:VARIABLE]`, any NetCDF with a two-dimensional elevation over latitude and longitude
/// (or projected x and y in metres). Node- and cell-registered, latitudes up or down, longitudes
/// 0..360 or -180..180, packed integers, repeated end column, any unit of length (none: metres).
/// Without VARIABLE the one two-dimensional variable that looks like an elevation, else an error
/// that lists the candidates. Throws InputError for unusable data (missing or NaN cells with their
/// index, wrong units, truncated file, irregular axes), IoError when it cannot be opened.
///
/// By their first bytes other files are told from NetCDF: GeoTIFF (one band, north up, geographic
/// or projected), grey PNG of 8 or 16 bits (its meaning from `image`, else from the JSON that
/// `terrane export` writes beside it), ESRI ASCII grids. ConfigurationError where `image` makes no
/// sense.
Dem read_dem(const std::string& file_and_variable, const Planet& planet,
             const ImageWords& image = {});
/// The same where cells may be missing: they are NaN.
Dem read_dem_with_gaps(const std::string& file_and_variable, const Planet& planet);
/// The same for any other field that is given as a raster (`elevation_m` then holds its values in
/// the units of the vocabulary, or of the file where those are empty). Without VARIABLE the one
/// named as the field, else the only raster. An image of which neither `image` nor a JSON tells has
/// the bounds of the quantity, from 0 to 1 where an order without a unit has none.
Dem read_field(const std::string& file_and_variable, const FieldSpec& spec, const Planet& planet,
               const ImageWords& image = {});

/// The same where cells may be missing: they are NaN.
Dem read_field_with_gaps(const std::string& file_and_variable, const FieldSpec& spec,
                         const Planet& planet, const ImageWords& image = {});

/// Area-weighted mean of a DEM on another grid (conservative where coarser, bilinear where
/// finer). On a sphere with a turn the DEM is laid out with that turn, by way of cells half as
/// wide. Both must cover the same region, or `target` lie within. Throws InputError otherwise.
std::vector<float> resample(const Dem& dem, const Grid& target);

}  // namespace geo::io
