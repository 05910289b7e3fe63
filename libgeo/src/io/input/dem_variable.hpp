#pragma once

#include <string>

#include "io/netcdf/netcdf_file.hpp"

namespace geo::io {

/// The variable of that name, or for an empty name the one that looks like elevation: by standard
/// name, by name, or because it is the only raster of the file. Its last two dimensions are a row
/// and a column axis, all before them have size one. Throws InputError (without path).
int choose_variable(const nc::File& file, const std::string& name);

/// Whether a variable is a raster over horizontal axes; if not, `why` says what it lacks.
bool is_raster(const nc::File& file, int variable, std::string* why = nullptr);

}  // namespace geo::io
