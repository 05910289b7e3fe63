#pragma once

#include <filesystem>

namespace geo::io {

/// Writes everything that a NetCDF file of ours says and holds as a store of Zarr 2 in a folder:
/// dimensions as xarray names them, attributes, shuffled and deflated chunks, consolidated
/// metadata. (The netCDF library of Debian 12 writes Zarr too, but without compression and with
/// scalars that xarray refuses.) The folder appears whole or not at all; a store of that name is
/// replaced. Throws ConfigurationError where something else lies there, IoError.
void write_zarr_store(const std::filesystem::path& netcdf, const std::filesystem::path& store);

/// A folder or file that is removed when this object ends, beside a path: hidden, of this process.
class Scratch {
 public:
  Scratch(const std::filesystem::path& beside, const char* what);
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace geo::io
