#pragma once

#include <cstdint>
#include <vector>

#include "dem_axis.hpp"
#include "io/netcdf/netcdf_file.hpp"

namespace geo::io {

/// What becomes of missing cells.
enum class Gaps : std::uint8_t { refused, nan };

/// Reads a variable of `rows` x `columns` (and leading dimensions of size one) in file order,
/// unpacked and in `units`. Throws InputError (without path) for missing cells where they are
/// refused, wrong units and damaged data.
std::vector<float> read_values(const nc::File& file, int variable, const DemAxis& rows,
                               const DemAxis& columns, const std::string& units, Gaps gaps);

}  // namespace geo::io
