#pragma once

namespace geo::io {

/// Before memory is asked for: throws InputError (without path) when `values` of a raster, each of
/// `bytes_each` in memory, are more than a file of `file_bytes` can hold or than memory can. Files
/// up to 4096 values a byte are sound: deflate packs a constant 1032 times, and parts that were
/// never written take no room. Small rasters always are.
void check_packed_size(double values, double bytes_each, double file_bytes);

}  // namespace geo::io
