#pragma once

#include <vector>

#include "dem_axis.hpp"
#include "netcdf_file.hpp"

namespace geo::io {

/// Reads a variable of `rows` x `columns` (and leading dimensions of size one) in file order,
/// unpacked and in metres. Throws InputError (without path) for missing cells, wrong units and
/// damaged data.
std::vector<float> read_elevation(const nc::File& file, int variable, const DemAxis& rows,
                                  const DemAxis& columns);

}  // namespace geo::io
