#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "geo/core/state.hpp"

namespace geo::io {

/// Reads rasters of a NetCDF-4 file as ChunkWriter writes them: chunks, shuffled and deflated. It
/// takes them from HDF5 as they lie and unpacks them with libdeflate on all threads: several times
/// as fast as the library's own filters.
class ChunkReader {
 public:
  explicit ChunkReader(const std::filesystem::path& path);
  ~ChunkReader();
  ChunkReader(const ChunkReader&) = delete;
  ChunkReader& operator=(const ChunkReader&) = delete;

  /// Fills `values`, ny rows of nx. False, with values undefined, where the raster is stored in any
  /// other way or damaged: then the netCDF library reads it, or says what is wrong.
  [[nodiscard]] bool read(std::string_view variable, Values& values, int ny, int nx) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace geo::io
