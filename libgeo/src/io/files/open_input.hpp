#pragma once

#include <filesystem>

#include "io/netcdf/netcdf_file.hpp"

namespace geo::io {

/// Opens a NetCDF file for reading. IoError when the system refuses, InputError when it is not one.
nc::File open_input(const std::filesystem::path& path);

}  // namespace geo::io
