#pragma once

#include <vector>

#include "dem_axis.hpp"
#include "geo/io/dem.hpp"
#include "netcdf_file.hpp"

namespace geo::io {

/// Reads a variable of `rows` x `columns` (and leading dimensions of size one) in file order,
/// unpacked and in `units`. Throws InputError (without path) for missing cells (where refused),
/// wrong units and damaged data.
std::vector<float> read_values(const nc::File& file, int variable, const DemAxis& rows,
                               const DemAxis& columns, const std::string& units,
                               MissingCells missing);

}  // namespace geo::io
