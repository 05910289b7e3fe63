#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include "geo/core/state.hpp"

namespace geo::io {

/// Rows and columns of a chunk of a stage file.
struct ChunkShape {
  std::size_t rows, columns;
};

/// Fills rasters of a NetCDF-4 file whose metadata the netCDF library wrote before. It shuffles
/// and compresses chunks with libdeflate, whose streams any zlib reads, and hands them to HDF5
/// whole: four times as fast as the library's own filters. Rasters must be chunked as told, with
/// the filters shuffle and deflate. Levels are zlib's, 0 stores. Throws nc::Failure.
class ChunkWriter {
 public:
  ChunkWriter(const std::filesystem::path& path, int level);
  ~ChunkWriter();
  ChunkWriter(const ChunkWriter&) = delete;
  ChunkWriter& operator=(const ChunkWriter&) = delete;

  /// `slice`: which raster of a variable that has a leading dimension.
  void write(std::string_view variable, const Values& values, int ny, int nx, ChunkShape chunk,
             int slice = 0) const;
  /// The same of a raster whose rows have one value each.
  void write_rows(std::string_view variable, std::span<const double> value_of_row, int nx,
                  ChunkShape chunk) const;
  /// Reports what only closing reveals.
  void close();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace geo::io
