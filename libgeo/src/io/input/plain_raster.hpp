#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo::io {

/// A raster of a file that is no NetCDF: rows from the south, columns from the west.
struct PlainRaster {
  int nx = 0, ny = 0;
  std::vector<float> values;                                   ///< NaN where the file has none
  bool geographic = true;                                      ///< degrees, else m about the middle
  double west = 0.0, south = 0.0, step_x = 0.0, step_y = 0.0;  ///< outer corner, sizes of cells
};

/// What the samples of an image mean where it does not say so itself.
struct ImageMeaning {
  std::optional<std::pair<double, double>> range;  ///< values of its least and greatest sample
  std::optional<Window> window;                    ///< where its edges lie
  /// Taken where nothing else tells: bounds of the quantity; not finite where it has none.
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
};

enum class RasterFormat { netcdf, geotiff, png, ascii };
/// By the first bytes of a file; what is none of the others is left to the netCDF library.
RasterFormat format_of(const std::filesystem::path& path);

/// Grey PNG of 8 or 16 bits. Range and place are what is given, else what a JSON of `terrane
/// export` beside it says, else the bounds of the quantity and the whole planet. Throws InputError
/// (without path) for what is damaged, not grey, or without a range; IoError.
PlainRaster read_png_raster(const std::filesystem::path& path, const ImageMeaning& meaning);

/// ESRI ASCII grid: `ncols`, `nrows`, a corner or the centre of its cell, `cellsize`,
/// `nodata_value`. Degrees where all fits the planet, else m. Throws InputError (without path).
PlainRaster read_ascii_raster(const std::filesystem::path& path);

/// "-11000,9000", two different numbers. ConfigurationError that says whose option it is.
std::pair<double, double> parse_range(std::string_view what, std::string_view text);

}  // namespace geo::io
